import hashlib
import json
import struct
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any
from zlib import crc32

import msgspec
import numpy as np
import pytest

from simconsole.recording.bundles.bundle import BundleWriter
from simconsole.recording.bundles.log import LogReader
from simconsole.recording.bundles.provenance import Provenance
from simconsole.recording.framing import START_OF_CHAIN, seal, seal_message
from simconsole.recording.log_header import MAGIC, LogHeader, encode_header, message_stream, vector_stream
from tests.manifests import forge

TEXTS = {"session.yaml": "schema: 1\n", "vehicle.yaml": "mass_kg: 1500\n"}
COLUMNS = ("sample.brake_axis", "sample.throttle_axis", "driver.brake", "vehicle.vx_mps")


@pytest.fixture
def header() -> LogHeader:
    return LogHeader(
        tick_hz=250,
        streams=(vector_stream(COLUMNS, 2),),
        console_version="0",
        source_sha256="aa",
        session_sha256="bb",
    )


def with_messages(header: LogHeader) -> LogHeader:
    return msgspec.structs.replace(
        header, streams=(*header.streams, message_stream("acts"), message_stream("scans", ""))
    )


def change_header(log: Path, **changes: object) -> None:
    """Write another header, its checksum right, before the same ticks."""
    content = log.read_bytes()
    start = len(MAGIC)
    size, _ = struct.unpack_from("<II", content, start)
    header = json.loads(content[start + 8 : start + 8 + size])
    text = json.dumps({**header, **changes}).encode()
    log.write_bytes(MAGIC + struct.pack("<II", len(text), crc32(text)) + text + content[start + 8 + size :])


def advance(tick: int, previous: np.ndarray, inputs: np.ndarray) -> np.ndarray:
    """A toy console: the brake slows the vehicle, the throttle moves it."""
    brake = inputs[0] * 0.5
    return np.array([*inputs, brake, previous[3] * 0.99 - brake * 0.01 + inputs[1] * 0.02 + tick * 1e-6])


@pytest.fixture
def toy_advance() -> Callable[[int, np.ndarray, np.ndarray], np.ndarray]:
    return advance


@pytest.fixture
def rows() -> list[np.ndarray]:
    inputs = np.random.default_rng(7).uniform(-1.0, 1.0, (40, 2))
    row, made = np.zeros(4), []
    for tick, values in enumerate(inputs, start=1):
        row = advance(tick, row, values)
        made.append(row)
    return made


@pytest.fixture
def log_bytes(header: LogHeader, rows: list[np.ndarray]) -> bytes:
    parts, digest = [encode_header(header)], START_OF_CHAIN
    for tick, row in enumerate(rows, start=1):
        frame, digest = seal(digest, tick, row.tobytes())
        parts.append(frame)
    return b"".join(parts)


@pytest.fixture
def acts() -> dict[int, tuple[bytes, ...]]:
    """What an operator has written, by tick."""
    return {
        3: (b'{"note":"first"}',),
        4: (b"", b"x" * 300),
        20: (bytes(64),),
        39: (b"last but one",),
        40: (b"end", b""),
    }


@pytest.fixture
def log_with_acts(header: LogHeader, rows: list[np.ndarray], acts: dict[int, tuple[bytes, ...]]) -> bytes:
    parts, digest, last = [encode_header(with_messages(header))], START_OF_CHAIN, START_OF_CHAIN
    for tick, row in enumerate(rows, start=1):
        sealed = b""
        for content in acts.get(tick, ()):
            part, last = seal_message(last, tick, 1, content)
            sealed += part
        frame, digest = seal(digest, tick, row.tobytes(), sealed)
        parts.append(frame)
    return b"".join(parts)


@pytest.fixture
def rewrite_log() -> Callable[..., None]:
    """Change one value of a log and make every CRC and chained hash in it right again, as a forger would.

    Record by record: the whole log of a demo is more than a process of the tests should hold.
    """

    def rewrite(path: Path, tick: int, column: str, value: float) -> None:
        reader, digest, forged = LogReader(path), START_OF_CHAIN, path.with_suffix(".forged")
        with forged.open("wb") as file:
            file.write(encode_header(reader.header))
            for record in reader:
                row = record.vector.copy()
                if record.tick == tick:
                    row[reader.header.columns.index(column)] = value
                frame, digest = seal(digest, record.tick, row.tobytes())
                file.write(frame)
        forged.replace(path)

    return rewrite


@pytest.fixture
def rewrite_checksums() -> Callable[[Path], None]:
    """Make a manifest agree with the files of its bundle again."""

    def rewrite(folder: Path) -> None:
        def change(manifest: dict[str, Any]) -> None:
            for name, entry in manifest["files"].items():
                with (folder / name).open("rb") as file:
                    sha256 = hashlib.file_digest(file, "sha256").hexdigest()
                entry.update(size_bytes=(folder / name).stat().st_size, sha256=sha256)
            (last,) = deque(LogReader(folder / "drive.log"), maxlen=1)
            manifest["digest"] = last.digest.hex()

        forge(folder, change)

    return rewrite


@pytest.fixture
def rewrite_session(rewrite_checksums: Callable[[Path], None]) -> Callable[..., None]:
    """Write another session.json into a bundle; a forger makes the log's header and the manifest agree with it."""

    def rewrite(folder: Path, session: object, forged: bool = True) -> None:
        text = json.dumps(session)
        (folder / "session.json").write_text(text)
        if forged:
            change_header(folder / "drive.log", session_sha256=hashlib.sha256(text.encode()).hexdigest())
        rewrite_checksums(folder)

    return rewrite


@pytest.fixture
def bundle(tmp_path: Path, header: LogHeader, rows: list[np.ndarray]) -> Path:
    folder = tmp_path / "drive"
    with BundleWriter(folder, header, TEXTS, {"simconsole": "0"}, Provenance(participant="P07")) as writer:
        for tick, row in enumerate(rows, start=1):
            writer.log.append(tick, row)
        writer.finish({"late_p99_us": 12.5})
    return folder
