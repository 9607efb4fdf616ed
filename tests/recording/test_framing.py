import io
import struct
import sys
from zlib import crc32

import msgspec
import numpy as np
import pytest

from simconsole.recording.framing import (
    MAGIC,
    SCHEMA,
    START_OF_CHAIN,
    LogHeader,
    Record,
    Scan,
    chain,
    encode_header,
    frame_size,
    seal,
)
from simconsole.values.errors import RecordingError


def scan(content: bytes) -> tuple[list[Record], Scan]:
    pass_ = Scan(io.BytesIO(content).read, "drive.log")
    return list(pass_), pass_


def with_header(content: bytes, **changes: object) -> bytes:
    size = struct.unpack_from("<I", content, len(MAGIC))[0]
    raw = {**msgspec.json.decode(content[16 : 16 + size]), **changes}
    text = msgspec.json.encode(raw)
    return MAGIC + struct.pack("<II", len(text), crc32(text)) + text + content[16 + size :]


def test_a_whole_log_reads_back_bit_for_bit(header: LogHeader, rows: list[np.ndarray], log_bytes: bytes) -> None:
    records, pass_ = scan(log_bytes)
    assert pass_.header == header
    assert pass_.breaks == []
    assert [record.tick for record in records] == list(range(1, 41))
    assert all(record.vector.tobytes() == row.tobytes() for record, row in zip(records, rows, strict=True))


def test_the_hash_chains_over_every_row_before(rows: list[np.ndarray], log_bytes: bytes) -> None:
    digest = START_OF_CHAIN
    for record in scan(log_bytes)[0]:
        digest = chain(digest, record.tick, record.vector.tobytes())
        assert digest == record.digest
    assert chain(START_OF_CHAIN, 1, rows[0].tobytes()) != chain(START_OF_CHAIN, 2, rows[0].tobytes())
    assert seal(START_OF_CHAIN, 1, rows[0].tobytes())[1] == chain(START_OF_CHAIN, 1, rows[0].tobytes())


def test_nan_and_negative_zero_survive(header: LogHeader) -> None:
    row = np.array([np.nan, -0.0, np.inf, 5e-324])
    records, _ = scan(encode_header(header) + seal(START_OF_CHAIN, 9, row.tobytes())[0])
    assert records[0].vector.tobytes() == row.tobytes()


@pytest.mark.fault("P03")
@pytest.mark.fault("P04")
def test_truncation_at_every_byte_keeps_all_whole_ticks(header: LogHeader, log_bytes: bytes) -> None:
    start, size = len(encode_header(header)), frame_size(4)
    for length in range(len(log_bytes)):
        if length < start:
            with pytest.raises(RecordingError, match=r"^drive\.log: "):
                scan(log_bytes[:length])
            continue
        records, pass_ = scan(log_bytes[:length])
        whole, rest = divmod(length - start, size)
        assert [record.tick for record in records] == list(range(1, whole + 1))
        if rest == 0:
            assert pass_.breaks == []
        else:
            assert pass_.breaks[0].offset == start + whole * size
            assert str(pass_.breaks[0]).endswith(f"torn, {rest} of {size} bytes")


@pytest.mark.fault("P04")
def test_a_flipped_bit_loses_at_most_its_own_tick(header: LogHeader, log_bytes: bytes) -> None:
    start, size = len(encode_header(header)), frame_size(4)
    content = log_bytes[: start + 5 * size]
    for bit in range(8 * len(content)):
        damaged = bytearray(content)
        damaged[bit // 8] ^= 1 << bit % 8
        if bit // 8 < start:
            with pytest.raises(RecordingError, match=r"^drive\.log: "):
                scan(bytes(damaged))
            continue
        records, pass_ = scan(bytes(damaged))
        frame = (bit // 8 - start) // size
        assert [record.tick for record in records] == [tick for tick in range(1, 6) if tick != frame + 1]
        assert [part.offset for part in pass_.breaks] == [start + frame * size]


def test_garbage_between_two_ticks_is_one_break(header: LogHeader, log_bytes: bytes) -> None:
    start, size = len(encode_header(header)), frame_size(4)
    damaged = bytearray(log_bytes)
    damaged[start + 3 * size : start + 7 * size] = bytes(4 * size)
    records, pass_ = scan(bytes(damaged))
    assert len(records) == 36
    assert [(part.offset, part.size_bytes) for part in pass_.breaks] == [(start + 3 * size, 4 * size)]


def test_a_whole_tick_in_a_wrong_place_is_named(header: LogHeader, log_bytes: bytes) -> None:
    start, size = len(encode_header(header)), frame_size(4)
    records, pass_ = scan(log_bytes[: start + size] + log_bytes[start + 2 * size : start + 3 * size])
    assert [record.tick for record in records] == [1]
    assert pass_.breaks[0].reason == "tick 3 where tick 2 belongs"


@pytest.mark.fault("F05")
def test_f05_newer_schema_is_refused(log_bytes: bytes) -> None:
    newer = with_header(log_bytes, schema=SCHEMA + 1, a_key_of_tomorrow=1)
    with pytest.raises(RecordingError, match=rf"^drive\.log: schema: {SCHEMA + 1} .* reads 1 to {SCHEMA}$"):
        scan(newer)


@pytest.mark.fault("F05")
def test_f05_another_byte_order_is_refused(log_bytes: bytes) -> None:
    other = "big" if sys.byteorder == "little" else "little"
    with pytest.raises(RecordingError, match=f"byte_order: '{other}' cannot be read here"):
        scan(with_header(log_bytes, byte_order=other))


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"schema": "1"}, "schema"),
        ({"schema": 0}, "schema"),
        ({"tick_hz": 0}, "tick_hz"),
        ({"tick_hz": 1001}, "tick_hz"),
        ({"tick_hz": "250"}, "tick_hz"),
        ({"columns": None}, "columns"),
        ({"input_columns": 5}, "input_columns"),
        ({"input_columns": -1}, "input_columns"),
        ({"values": "float32"}, "values"),
        ({"unheard_of": 1}, "unheard_of"),
    ],
)
def test_a_bad_header_names_file_and_key(log_bytes: bytes, changes: dict[str, object], named: str) -> None:
    with pytest.raises(RecordingError, match=named) as caught:
        scan(with_header(log_bytes, **changes))
    assert str(caught.value).startswith("drive.log: ")
    assert "\n" not in str(caught.value)
    assert caught.value.exit_code == 2


@pytest.mark.parametrize("text", [b"[]", b"{", b"\xff\xfe", b'{"schema": true}', b"[" * 100_000])
def test_a_header_that_is_not_ours_is_refused(text: bytes) -> None:
    with pytest.raises(RecordingError, match=r"^drive\.log: "):
        scan(MAGIC + struct.pack("<II", len(text), crc32(text)) + text)


def test_a_header_of_two_gigabytes_is_not_read() -> None:
    with pytest.raises(RecordingError, match="allowed up to"):
        scan(MAGIC + struct.pack("<II", 1 << 31, 0))


def test_random_bytes_never_raise_anything_else(header: LogHeader, log_bytes: bytes) -> None:
    seed = 20261120
    print("seed", seed)
    generator = np.random.default_rng(seed)
    start = len(encode_header(header))
    for _ in range(300):
        damaged = bytearray(log_bytes)
        for at in generator.integers(start, len(damaged), generator.integers(1, 40)):
            damaged[at] = generator.integers(256)
        cut = int(generator.integers(start, len(damaged) + 1))
        records, _ = scan(bytes(damaged[:cut]))
        ticks = [record.tick for record in records]
        assert ticks == sorted(set(ticks))
