import errno
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.log import LogReader, LogWriter
from simconsole.recording.framing import Message, frame_size
from simconsole.recording.log_header import LogHeader, encode_header
from simconsole.values.errors import RecordingError
from tests.patience import wait_until
from tests.recording.conftest import with_messages

FILL_THE_DISK = """
import json, resource, sys
import numpy as np
from pathlib import Path
from simconsole.recording.log_header import LogHeader, vector_stream
from simconsole.recording.bundles.log import LogWriter
header = LogHeader(tick_hz=250, streams=(vector_stream(("a", "b"), 1),),
                   console_version="0", source_sha256="", session_sha256="")
log = LogWriter(Path(sys.argv[1]), header)
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
for tick in range(1, 2000):
    log.append(tick, np.full(2, float(tick)))
recorded = log.ticks
log.close()
print(json.dumps([recorded, log.failure]))
"""


def test_ticks_appended_are_ticks_read(tmp_path: Path, header: LogHeader, rows: list[np.ndarray]) -> None:
    with LogWriter(tmp_path / "drive.log", header) as log:
        for tick, row in enumerate(rows, start=1):
            log.append(tick, row)
    reader = LogReader(tmp_path / "drive.log")
    records = list(reader)
    assert reader.header == header
    assert reader.breaks == ()
    assert [record.vector.tobytes() for record in records] == [row.tobytes() for row in rows]
    assert records[-1].digest == log.digest
    assert log.size_bytes == (tmp_path / "drive.log").stat().st_size
    assert [record.tick for record in reader] == list(range(1, 41))  # a second pass reads the same


def test_each_tick_is_in_the_file_when_append_returns(tmp_path: Path, header: LogHeader) -> None:
    with LogWriter(tmp_path / "drive.log", header) as log:
        for tick in range(1, 5):
            log.append(tick, np.zeros(4))
            assert sum(1 for _ in LogReader(tmp_path / "drive.log")) == tick


def test_messages_lie_in_the_tick_in_which_they_were_appended(
    tmp_path: Path, header: LogHeader, rows: list[np.ndarray], acts: dict[int, tuple[bytes, ...]], log_with_acts: bytes
) -> None:
    with LogWriter(tmp_path / "drive.log", with_messages(header)) as log:
        for tick, row in enumerate(rows, start=1):
            log.append(tick, row, [("acts", content) for content in acts.get(tick, ())])
    assert (tmp_path / "drive.log").read_bytes() == log_with_acts
    reader = LogReader(tmp_path / "drive.log")
    found = list(reader.messages("acts"))
    assert found == [Message(tick, content) for tick, parts in acts.items() for content in parts]
    assert list(reader.messages("scans")) == []
    with pytest.raises(RecordingError, match="no stream 'notes'"):
        list(reader.messages("notes"))


def test_a_tick_with_messages_is_one_write(tmp_path: Path, header: LogHeader, monkeypatch: pytest.MonkeyPatch) -> None:
    write, sizes = os.write, []

    def counted(fd: int, frame: bytes) -> int:
        sizes.append(len(frame))
        return write(fd, frame)

    with LogWriter(tmp_path / "drive.log", with_messages(header)) as log:
        monkeypatch.setattr(os, "write", counted)
        log.append(1, np.zeros(4), [("acts", b"12345"), ("scans", b"")])
        log.append(2, np.zeros(4))
    assert sizes == [frame_size(4) + 2 * 14 + 5, frame_size(4)]


@pytest.mark.parametrize(
    ("stream", "size", "words"), [("notes", 1, "'notes'"), ("state", 1, "'state'"), ("acts", 1 << 22, "bytes in one")]
)
def test_a_message_that_no_reader_could_take_is_a_bug(
    tmp_path: Path, header: LogHeader, stream: str, size: int, words: str
) -> None:
    with LogWriter(tmp_path / "drive.log", with_messages(header)) as log:
        with pytest.raises(ValueError, match=words):
            log.append(1, np.zeros(4), [(stream, bytes(size))])
        log.append(1, np.zeros(4), [("acts", b"")])
    assert [message.tick for message in LogReader(tmp_path / "drive.log").messages("acts")] == [1]


def test_equal_drives_make_equal_files(tmp_path: Path, header: LogHeader, rows: list[np.ndarray]) -> None:
    for name in ("first", "second"):
        with LogWriter(tmp_path / name, header) as log:
            for tick, row in enumerate(rows, start=1):
                log.append(tick, row)
    assert (tmp_path / "first").read_bytes() == (tmp_path / "second").read_bytes()


def test_ticks_written_at_once_are_one_write_and_the_same_file(
    tmp_path: Path, header: LogHeader, monkeypatch: pytest.MonkeyPatch
) -> None:
    vectors, write, writes = np.random.default_rng(1).normal(size=(50, 4)), os.write, list[int]()

    def counted(fd: int, data: bytes) -> int:
        writes.append(len(data))
        return write(fd, data)

    with LogWriter(tmp_path / "one by one", header) as log:
        for tick, vector in enumerate(vectors, start=1):
            log.append(tick, vector)
        expected = log.digest
    with LogWriter(tmp_path / "at once", header) as log:
        monkeypatch.setattr(os, "write", counted)
        log.append(1, vectors[0])
        assert log.append_block(2, vectors[1:40]) == 39
        log.append_block(41, vectors[40:])
        assert (log.ticks, log.digest) == (50, expected)
    assert writes == [frame_size(4), 39 * frame_size(4), 10 * frame_size(4)]
    assert (tmp_path / "at once").read_bytes() == (tmp_path / "one by one").read_bytes()
    assert [record.tick for record in LogReader(tmp_path / "at once")] == list(range(1, 51))


@pytest.mark.parametrize("count", [1, 2, 9])
def test_messages_of_the_first_tick_of_a_block_lie_in_the_same_write(
    tmp_path: Path, header: LogHeader, monkeypatch: pytest.MonkeyPatch, count: int
) -> None:
    vectors, write, writes = np.random.default_rng(1).normal(size=(count, 4)), os.write, list[int]()

    def counted(fd: int, data: bytes) -> int:
        writes.append(len(data))
        return write(fd, data)

    messages = [("acts", b"one"), ("scans", b"two")]
    with LogWriter(tmp_path / "one by one", with_messages(header)) as log:
        for tick, vector in enumerate([*vectors, *vectors], start=1):
            log.append(tick, vector, messages if tick in (1, count + 1) else ())
    with LogWriter(tmp_path / "at once", with_messages(header)) as log:
        monkeypatch.setattr(os, "write", counted)
        for first in (1, count + 1):
            assert log.append_block(first, vectors, messages) == count
    assert len(writes) == 2
    assert (tmp_path / "at once").read_bytes() == (tmp_path / "one by one").read_bytes()


@pytest.mark.fault("P01")
@pytest.mark.parametrize("cut_fails", [False, True])
def test_p01_a_block_that_does_not_fit_is_kept_up_to_the_tick_that_does_not(
    tmp_path: Path, header: LogHeader, monkeypatch: pytest.MonkeyPatch, cut_fails: bool
) -> None:
    write, path = os.write, tmp_path / "drive.log"

    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    with LogWriter(path, header) as log:
        log.append(1, np.zeros(4))
        room = os.fstat(log._fd).st_size + 7 * frame_size(4) + 11

        def limited(fd: int, data: bytes) -> int:
            free = room - os.fstat(fd).st_size
            return write(fd, data[:free]) if free else full()

        with monkeypatch.context() as patch:
            patch.setattr(os, "write", limited)
            if cut_fails:
                patch.setattr(os, "ftruncate", full)
            kept = log.append_block(2, np.zeros((20, 4)))
        assert log.failure is not None
        assert log.failure.endswith(f"recording stopped at tick {2 if cut_fails else 9}: No space left on device")
        assert kept == (1 if cut_fails else 8)
        log.append_block(2 + kept, np.zeros((20, 4)))
    ticks = [record.tick for record in LogReader(path)]
    assert ticks == list(range(1, 9)), "each once, and none after the failure"


def test_the_table_is_the_log_in_columns(tmp_path: Path, header: LogHeader, log_bytes: bytes) -> None:
    (tmp_path / "drive.log").write_bytes(log_bytes[:-3])
    table = LogReader(tmp_path / "drive.log").table()
    assert table.tick_hz == 250
    assert table.ticks.tolist() == list(range(1, 40))
    assert table.vectors.shape == (39, 4)
    assert table.column("driver.brake").tolist() == (table.column("sample.brake_axis") * 0.5).tolist()
    with pytest.raises(RecordingError, match=r"no column 'driver\.break'"):
        table.column("driver.break")


def test_an_existing_recording_is_never_overwritten(tmp_path: Path, header: LogHeader) -> None:
    (tmp_path / "drive.log").write_bytes(b"a drive")
    with pytest.raises(RecordingError, match="cannot be recorded to"):
        LogWriter(tmp_path / "drive.log", header)
    assert (tmp_path / "drive.log").read_bytes() == b"a drive"


def test_a_missing_log_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"drive\.log: cannot be read: No such file"):
        LogReader(tmp_path / "drive.log")


def test_a_row_of_another_width_is_a_bug(tmp_path: Path, header: LogHeader) -> None:
    with LogWriter(tmp_path / "drive.log", header) as log, pytest.raises(ValueError, match="24 bytes in a log of 32"):
        log.append(1, np.zeros(3))


@pytest.mark.fault("P01")
def test_p01_a_full_disk_stops_recording_not_driving(tmp_path: Path) -> None:
    path = tmp_path / "drive.log"
    done = subprocess.run([sys.executable, "-c", FILL_THE_DISK, str(path)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    ticks, failure = json.loads(done.stdout)
    assert failure == f"{path}: recording stopped at tick {ticks + 1}: {failure.rsplit(': ', 1)[1]}"
    reader = LogReader(path)
    assert [record.tick for record in reader] == list(range(1, ticks + 1))
    assert reader.breaks == ()  # the part of a tick that still fitted was taken back
    assert ticks == (10_000 - len(encode_header(reader.header))) // frame_size(2)


@pytest.mark.fault("P01")
def test_p01_the_last_ticks_go_into_the_room_that_was_kept_for_them(
    tmp_path: Path, header: LogHeader, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The tick that did not fit, and the one after it: it holds the alarm. Nothing after that, whatever comes free."""
    write = os.write
    freed: list[bool] = []

    def full(fd: int, frame: bytes) -> int:
        if not freed:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(fd, frame)

    with LogWriter(tmp_path / "drive.log", header, free_room=lambda: freed.append(True)) as log:
        log.append(1, np.zeros(4))
        monkeypatch.setattr(os, "write", full)
        for tick in range(2, 6):
            log.append(tick, np.zeros(4))
        assert log.failure is not None
        assert log.failure.endswith("recording stopped at tick 2: No space left on device")
    assert [record.tick for record in LogReader(tmp_path / "drive.log")] == [1, 2, 3]
    assert len(freed) == 1


@pytest.mark.fault("P01")
def test_p01_a_log_that_was_removed_is_a_failure(tmp_path: Path, header: LogHeader) -> None:
    with LogWriter(tmp_path / "drive.log", header) as log:
        log.append(1, np.zeros(4))
        (tmp_path / "drive.log").unlink()
        log.append(2, np.zeros(4))
        assert log.failure == f"{tmp_path / 'drive.log'}: recording stopped at tick 2: the file was removed"
        log.append(3, np.zeros(4))
        assert log.ticks == 1


@pytest.mark.fault("P01")
@pytest.mark.parametrize("cut_fails", [False, True])
def test_p01_no_space_at_all(
    tmp_path: Path, header: LogHeader, monkeypatch: pytest.MonkeyPatch, cut_fails: bool
) -> None:
    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    with LogWriter(tmp_path / "drive.log", header) as log:
        log.append(1, np.zeros(4))
        with monkeypatch.context() as patch:
            patch.setattr(os, "write", full)
            if cut_fails:
                patch.setattr(os, "ftruncate", full)
            log.append(2, np.zeros(4))
        log.append(3, np.zeros(4))
        assert log.failure is not None
        assert log.failure.endswith("recording stopped at tick 2: No space left on device")
    assert [record.tick for record in LogReader(tmp_path / "drive.log")] == [1]


@pytest.mark.fault("P01")
def test_p01_a_sync_that_fails_is_flagged(tmp_path: Path, header: LogHeader, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_: int) -> None:
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr("simconsole.recording.bundles.log._synchronise", broken)
    with LogWriter(tmp_path / "drive.log", header, sync_interval_s=0.001) as log:
        wait_until(lambda: log.failure, "the alarm")
    assert str(log.failure).endswith("sync: Input/output error")


def test_closing_twice_is_fine(tmp_path: Path, header: LogHeader) -> None:
    log = LogWriter(tmp_path / "drive.log", header)
    log.close()
    log.close()
    assert list(LogReader(tmp_path / "drive.log")) == []
