"""The packed log reads like the log: the same records, columns and messages, and damage is told in one line."""

import random
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from simconsole.recording.bundles.log import LogReader, LogWriter
from simconsole.recording.bundles.packed_log import PackedLog
from simconsole.recording.bundles.packed_writer import METADATA_KEY, PackedLogWriter
from simconsole.recording.framing import Message
from simconsole.recording.log_header import LogHeader, vector_stream
from simconsole.recording.packing import Coded, Plain, Rule
from simconsole.recording.packing_rules import RuleFinder
from simconsole.recording.reading import Recording
from simconsole.values.errors import RecordingError
from tests.bits import difference
from tests.paths import ROOT
from tests.recording.conftest import COLUMNS, with_messages
from tests.samples import Sample

GROUP_TICKS = 16
MESSAGES = {3: [("acts", b'{"note":1}')], 20: [("scans", b""), ("acts", b"\xff\x00"), ("scans", b"x" * 5000)]}


def packed(log: LogReader, path: Path, rules: dict[str, Rule] | None = None) -> PackedLog:
    """Pack a log in row groups of GROUP_TICKS."""
    records = list(log)
    parts = [records[start : start + GROUP_TICKS] for start in range(0, len(records), GROUP_TICKS)]
    finder = RuleFinder(log.header.columns)
    for part in parts:
        finder.add(np.array([record.vector for record in part]))
    with PackedLogWriter(path, log.header, log.start, finder.rules() if rules is None else rules) as writer:
        for part in parts:
            writer.append(part)
    return PackedLog(path)


@pytest.fixture
def log(tmp_path: Path, header: LogHeader, rows: list[np.ndarray]) -> LogReader:
    with LogWriter(tmp_path / "drive.log", with_messages(header)) as writer:
        for tick, row in enumerate(rows, start=1):
            writer.append(tick, row, MESSAGES.get(tick, ()))
    return LogReader(tmp_path / "drive.log")


@pytest.fixture
def pair(log: LogReader, tmp_path: Path) -> tuple[LogReader, PackedLog]:
    return log, packed(log, tmp_path / "drive.parquet")


def seen(recording: Recording, columns: Sequence[str] | None) -> tuple[object, ...]:
    table = recording.table(columns)
    return table.columns, table.tick_hz, table.ticks.tolist(), table.vectors.tobytes()


def test_both_forms_give_the_same_records(pair: tuple[LogReader, PackedLog]) -> None:
    log, small = pair
    assert [(r.tick, r.vector.tobytes(), r.digest, r.messages) for r in small] == [
        (r.tick, r.vector.tobytes(), r.digest, r.messages) for r in log
    ]
    assert (small.header, small.breaks) == (log.header, ())
    assert small.last is not None
    assert small.last.tick == 40
    assert [record.tick for record in small] == list(range(1, 41))  # a second pass reads the same


@pytest.mark.parametrize("columns", [None, ("vehicle.vx_mps",), ("driver.brake", "sample.brake_axis")])
def test_both_forms_give_the_same_columns(pair: tuple[LogReader, PackedLog], columns: Sequence[str] | None) -> None:
    assert seen(pair[1], columns) == seen(pair[0], columns)


@pytest.mark.parametrize("stream", ["acts", "scans"])
def test_both_forms_give_the_same_messages(pair: tuple[LogReader, PackedLog], stream: str) -> None:
    wanted = [Message(tick, part) for tick, parts in MESSAGES.items() for name, part in parts if name == stream]
    for recording in pair:
        assert list(recording.messages(stream)) == wanted
        with pytest.raises(RecordingError, match="no stream 'notes'"):
            list(recording.messages("notes"))


def test_the_log_comes_back_byte_for_byte(pair: tuple[LogReader, PackedLog]) -> None:
    assert b"".join(pair[1].log_bytes()) == pair[0].path.read_bytes()


@given(
    arrays(np.int64, (50, 4), elements=st.integers(-(1 << 63), (1 << 63) - 1)),
    st.sampled_from([Plain(), Coded(0), Coded(3), Coded(7)]),
)
def test_every_bit_pattern_comes_back(tmp_path_factory: pytest.TempPathFactory, bits: np.ndarray, rule: Rule) -> None:
    folder = tmp_path_factory.mktemp("patterns")
    header = LogHeader(
        tick_hz=250, streams=(vector_stream(COLUMNS, 2),), console_version="0", source_sha256="", session_sha256=""
    )
    with LogWriter(folder / "drive.log", header) as writer:
        for tick, row in enumerate(bits.view(np.float64), start=-3):
            writer.append(tick, row)
    rules = {**dict.fromkeys(COLUMNS, rule), COLUMNS[1]: Coded(1, COLUMNS[0], 1)}
    small = packed(LogReader(folder / "drive.log"), folder / "drive.parquet", rules)
    assert b"".join(small.log_bytes()) == (folder / "drive.log").read_bytes()


def test_the_lines_of_the_documentation_decode_a_column(log: LogReader, tmp_path: Path) -> None:
    (lines,) = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "recording.md").read_text("utf-8"), re.DOTALL)
    path = packed(log, tmp_path / "drive.parquet", dict.fromkeys(COLUMNS, Coded(3))).path
    known = {"np": np, "order": 3, "numbers": pq.ParquetFile(path).read_row_group(0).column("driver.brake").to_numpy()}
    exec(lines, known)
    assert not difference(known["values"], log.table(("driver.brake",)).vectors[:GROUP_TICKS, 0])


def test_a_column_that_is_not_there_is_named(pair: tuple[LogReader, PackedLog]) -> None:
    with pytest.raises(RecordingError, match=r"no column 'driver\.break'"):
        pair[1].table(("driver.break",))


def test_only_the_columns_that_are_needed_are_read(
    pair: tuple[LogReader, PackedLog], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[list[str]] = []
    read = pq.ParquetFile.read_row_group

    def noted(file: object, index: int, columns: list[str], **options: object) -> object:
        asked.append(columns)
        return read(file, index, columns=columns, **options)

    monkeypatch.setattr(pq.ParquetFile, "read_row_group", noted)
    pair[1].table(("vehicle.vx_mps",))
    assert asked == [["tick", "vehicle.vx_mps"]] * 3


def test_a_log_without_ticks_is_packed_too(tmp_path: Path, header: LogHeader) -> None:
    LogWriter(tmp_path / "drive.log", header).close()
    small = packed(LogReader(tmp_path / "drive.log"), tmp_path / "drive.parquet")
    assert list(small) == []
    assert small.table().vectors.shape == (0, 4)
    assert b"".join(small.log_bytes()) == (tmp_path / "drive.log").read_bytes()


def test_a_changed_value_is_found_by_the_hash_of_its_row_group(pair: tuple[LogReader, PackedLog]) -> None:
    """A forger writes the whole file anew, all checksums right; row group 1 holds ticks 17 to 32."""
    path = pair[1].path
    file = pq.ParquetFile(path)
    metadata = file.metadata.metadata[METADATA_KEY]
    groups = [file.read_row_group(index) for index in range(3)]
    at = groups[1].schema.get_field_index("vehicle.vx_mps")
    values = groups[1].column(at).to_pylist()
    groups[1] = groups[1].set_column(at, groups[1].schema.field(at), pa.array([values[0] + 1e-9, *values[1:]]))
    with pq.ParquetWriter(path, file.schema_arrow) as writer:
        for group in groups:
            writer.write_table(group)
        writer.add_key_value_metadata({METADATA_KEY: metadata})
    forged = PackedLog(path)
    assert [record.tick for record in forged] == [*range(1, 17), *range(33, 41)]
    (found,) = forged.breaks
    assert found.reason == "row group 1: it does not give its hashes"


def test_damage_is_one_line_wherever_it_is(log: LogReader, tmp_path: Path, sample: Sample) -> None:
    """One byte of the file changed: nothing is read that was not recorded, and no other error comes out."""
    path = packed(log, tmp_path / "drive.parquet").path
    whole = path.read_bytes()
    wanted = {record.tick: (record.vector.tobytes(), record.messages) for record in log}
    generator = random.Random(sample.seed)
    told: list[str] = []
    unnoticed, changes = 0, sample.of(300, 5000)
    for _ in range(changes):
        content = bytearray(whole)
        content[generator.randrange(len(whole))] ^= generator.randrange(1, 256)
        path.write_bytes(content)
        try:
            small = PackedLog(path)
            records = list(small)
        except RecordingError as error:
            told.append(str(error))
            continue
        assert all(wanted[record.tick] == (record.vector.tobytes(), record.messages) for record in records)
        assert len(records) == 40 or small.breaks
        unnoticed += not small.breaks
    assert all(line.startswith(f"{path}: ") and "\n" not in line for line in told)
    assert unnoticed < 0.2 * changes  # in names and counts that nobody reads; the manifest's sha256 finds those too


@pytest.mark.parametrize("content", [b"", b"PAR1", b"PAR1" * 100, b"\x89SIMLOG\n" * 10])
def test_a_file_that_is_no_packed_log_is_one_line(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "drive.parquet"
    with pytest.raises(RecordingError, match=r"drive\.parquet: cannot be read: No such file or directory"):
        PackedLog(path)
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=r"drive\.parquet: cannot be read: "):
        PackedLog(path)
    pq.write_table(pa.table({"tick": [1, 2]}), path)
    with pytest.raises(RecordingError, match="not a packed log"):
        PackedLog(path)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ((b'"schema":1', b'"schema":9'), "schema: 9 cannot be read"),
        ((b'"rule":"plain"', b'"rule":"magic"'), "magic"),
        ((b'"rule":"plain"', b'"rule":"copy","of":"it"'), "which is not stored"),
        ((b'"digests":[', b'"digests":[["zz"],'), "cannot be read: non-hexadecimal"),
        ((b'"digests":[', b'"digests":[["00"],'), "row groups are not those that it states"),
    ],
)
def test_metadata_that_cannot_be_followed_are_one_line(
    log: LogReader, tmp_path: Path, change: tuple[bytes, bytes], told: str
) -> None:
    path = packed(log, tmp_path / "drive.parquet").path
    file = pq.ParquetFile(path)
    text = file.metadata.metadata[METADATA_KEY]
    assert change[0] in text
    table = file.read()
    with pq.ParquetWriter(path, file.schema_arrow) as writer:
        writer.write_table(table)
        writer.add_key_value_metadata({METADATA_KEY: text.replace(*change)})
    with pytest.raises(RecordingError) as caught:
        PackedLog(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert told in str(caught.value)
