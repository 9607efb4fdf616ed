import errno
import os
import signal
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from simconsole.processes import shared_memory
from simconsole.processes.shared_memory import EventCounters, Ring, TextQueue, make_run_folder, remove_run_folder, sweep
from simconsole.values.errors import WorkerError
from simconsole.values.signals import Event
from tests.bits import difference

Wait = Callable[[Callable[[], object]], None]

HAMMER = """
import sys
import numpy as np
from pathlib import Path
from simconsole.processes.shared_memory import Ring
ring = Ring.open(Path(sys.argv[1]), writable=True)
while True:
    number = ring.newest + 1
    ring.write(np.full(ring.width, float(number)), number, -number)
"""

MAKE_AND_STAY = """
import sys
from pathlib import Path
from simconsole.processes import shared_memory
shared_memory._base = lambda: Path(sys.argv[1])
print(shared_memory.make_run_folder(), flush=True)
sys.stdin.read()
"""


def test_a_ring_returns_what_was_written(tmp_path: Path) -> None:
    writer = Ring.create(tmp_path / "ring", 3, 8)
    reader = Ring.open(tmp_path / "ring")
    assert (reader.width, reader.capacity, reader.newest) == (3, 8, 0)
    assert reader.latest() is None
    assert reader.since(0) == []
    writer.write(np.array([1.0, np.nan, -0.0]), 41, -7)
    record = reader.latest()
    assert record is not None
    assert (record.number, record.stamp, record.second_stamp) == (1, 41, -7)
    assert not difference(record.values, np.array([1.0, np.nan, -0.0]))


def test_a_record_is_a_copy(tmp_path: Path) -> None:
    writer = Ring.create(tmp_path / "ring", 1, 2)
    writer.write(np.array([1.0]))
    first = Ring.open(tmp_path / "ring").latest()
    for value in range(2, 9):
        writer.write(np.array([float(value)]))
    assert first is not None
    assert first.values.tolist() == [1.0]


def test_since_returns_each_record_once_and_in_order(tmp_path: Path) -> None:
    writer, seen = Ring.create(tmp_path / "ring", 1, 16), []
    reader, last = Ring.open(tmp_path / "ring"), 0
    for burst in (1, 3, 0, 14, 7):
        for _ in range(burst):
            writer.write(np.array([0.0]), writer.newest + 1)
        records = reader.since(last)
        last = records[-1].number if records else last
        seen += [record.stamp for record in records]
    assert seen == list(range(1, 26))


def test_a_reader_that_sleeps_gets_the_newest_and_can_count_what_it_missed(tmp_path: Path) -> None:
    writer = Ring.create(tmp_path / "ring", 1, 16)
    for number in range(1, 101):
        writer.write(np.array([float(number)]), number)
    records = Ring.open(tmp_path / "ring").since(10)
    assert [record.number for record in records] == list(range(86, 101))


def test_readers_cannot_write(tmp_path: Path) -> None:
    Ring.create(tmp_path / "ring", 1, 2)
    reader = Ring.open(tmp_path / "ring")
    with pytest.raises(ValueError, match="read-only"):
        reader.write(np.array([1.0]))
    assert reader.newest == 0


def test_only_this_user_may_open_the_file(tmp_path: Path) -> None:
    Ring.create(tmp_path / "ring", 1, 2)
    assert stat.S_IMODE((tmp_path / "ring").stat().st_mode) == 0o600


def test_a_writer_killed_inside_a_record_leaves_the_one_before(tmp_path: Path) -> None:
    writer = Ring.create(tmp_path / "slot", 2, 4)
    reader = Ring.open(tmp_path / "slot")
    for number in range(1, 7):
        writer.write(np.full(2, float(number)), number)
    torn = writer._words[6 % 4]
    torn[0], torn[1] = 7, 7  # the first half of record 7
    record = reader.latest()
    assert record is not None
    assert record.number == 6
    again = Ring.open(tmp_path / "slot", writable=True)  # the restarted worker
    again.write(np.full(2, 70.0), 70)
    record = reader.latest()
    assert record is not None
    assert (record.number, record.stamp, record.values.tolist()) == (7, 70, [70.0, 70.0])


def test_a_record_being_overwritten_is_not_returned(tmp_path: Path) -> None:
    writer = Ring.create(tmp_path / "ring", 1, 4)
    for number in range(1, 5):
        writer.write(np.array([float(number)]))
    writer._words[0][0] = 5  # the writer has begun record 5 where record 1 stands
    assert Ring.open(tmp_path / "ring")._read(1) is None


def test_a_reader_lapped_again_and_again_gives_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    Ring.create(tmp_path / "ring", 1, 2).write(np.array([1.0]))
    reader = Ring.open(tmp_path / "ring")
    tries: list[int] = []
    monkeypatch.setattr(reader, "_read", tries.append)
    assert reader.latest() is None
    assert len(tries) == shared_memory.READ_TRIES


@pytest.mark.parametrize("capacity", [2, 4, 64])
def test_no_torn_read_under_a_writer_that_never_rests(tmp_path: Path, capacity: int, wait_until: Wait) -> None:
    reader = Ring.create(tmp_path / "ring", 140, capacity)
    process = subprocess.Popen([sys.executable, "-c", HAMMER, str(tmp_path / "ring")])
    try:
        wait_until(lambda: reader.newest > 0)
        begun, reads, last = reader.newest, 0, 0
        while reads < 30_000:
            record = reader.latest()
            for found in reader.since(reader.newest - 2) if record is None else [record]:
                assert (found.values == float(found.number)).all()
                assert (found.stamp, found.second_stamp) == (found.number, -found.number)
                assert found.number >= last
                last = found.number
                reads += 1
        assert process.poll() is None
        assert reader.newest > begun
    finally:
        process.send_signal(signal.SIGKILL)
        process.wait()


def test_a_flood_leaves_the_newest_command_with_its_own_receipt(tmp_path: Path) -> None:
    slot = Ring.create(tmp_path / "slot", 2, 4)
    for number in range(10_000):
        slot.write(np.array([float(number), 0.0]), 1_000_000 * number)
    record = Ring.open(tmp_path / "slot").latest()
    assert record is not None
    now_ns = 10_020 * 1_000_000
    assert now_ns - record.stamp == 21_000_000  # age runs from receipt, not from when it is read


@pytest.mark.parametrize("content", [b"", b"\0" * 64, b"x" * 200])
def test_what_is_no_ring_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "ring").write_bytes(content)
    with pytest.raises(WorkerError, match="not a ring of this version"):
        Ring.open(tmp_path / "ring")


@pytest.mark.parametrize(("width", "capacity"), [(0, 4), (-1, 4), (4, 0), (4, -9), (1 << 40, 4), (4, 1000)])
def test_a_ring_whose_header_lies_is_refused(tmp_path: Path, width: int, capacity: int) -> None:
    ring = Ring.create(tmp_path / "ring", 4, 4)
    ring._head[1], ring._head[2] = width, capacity
    with pytest.raises(WorkerError, match="ring: "):
        Ring.open(tmp_path / "ring")


def test_opening_and_making_fail_in_one_line(tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match="cannot be opened: No such file"):
        Ring.open(tmp_path / "ring")
    Ring.create(tmp_path / "ring", 1, 1)
    with pytest.raises(WorkerError, match="cannot be made: File exists"):
        Ring.create(tmp_path / "ring", 1, 1)


def test_full_shared_memory_is_an_error_not_a_bus_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(descriptor: int, offset: int, size: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "posix_fallocate", full)
    with pytest.raises(WorkerError, match="cannot be made: No space left on device"):
        Ring.create(tmp_path / "ring", 140, 1024)


def test_a_rings_pages_exist_before_the_drive(tmp_path: Path) -> None:
    Ring.create(tmp_path / "ring", 140, 1024)
    found = (tmp_path / "ring").stat()
    assert found.st_blocks * 512 >= found.st_size


def test_every_edge_is_seen_once(tmp_path: Path) -> None:
    reader = EventCounters.create(tmp_path / "events")
    writer = EventCounters.open(tmp_path / "events", writable=True)
    assert reader.take() == 0
    writer.raise_events(Event.RESET | Event.MARK)
    writer.raise_events(Event.MARK)
    assert reader.take() == Event.RESET | Event.MARK
    assert reader.take() == 0


@pytest.mark.parametrize("event", list(Event))
def test_every_event_passes(tmp_path: Path, event: Event) -> None:
    reader = EventCounters.create(tmp_path / "events")
    EventCounters.open(tmp_path / "events", writable=True).raise_events(event)
    assert reader.take() == event


def test_an_emergency_stop_is_never_dropped(tmp_path: Path) -> None:
    reader = EventCounters.create(tmp_path / "events")
    writer = EventCounters.open(tmp_path / "events", writable=True)
    writer.raise_events(Event.EMERGENCY_STOP)
    for _ in range(1000):
        writer.raise_events(Event.MARK | Event.RESET)
    assert reader.take() & Event.EMERGENCY_STOP


def test_edges_outlive_their_writer(tmp_path: Path) -> None:
    reader = EventCounters.create(tmp_path / "events")
    EventCounters.open(tmp_path / "events", writable=True).raise_events(Event.EMERGENCY_STOP)
    again = EventCounters.open(tmp_path / "events", writable=True)  # the restarted worker
    again.raise_events(Event.MARK)
    assert reader.take() == Event.EMERGENCY_STOP | Event.MARK


def test_unknown_bits_are_no_events(tmp_path: Path) -> None:
    reader = EventCounters.create(tmp_path / "events")
    EventCounters.open(tmp_path / "events", writable=True).raise_events(1 << 40)
    assert reader.take() == 0


def test_texts_arrive_once_each_in_order(tmp_path: Path) -> None:
    reader = TextQueue.create(tmp_path / "texts", 64, 4)
    assert reader.take() == []
    writer = TextQueue.open(tmp_path / "texts", writable=True)
    texts = [b"", b"a note", bytes(range(64)), b"\xff" * 64]
    assert [writer.put(text) for text in texts] == [True] * 4
    assert reader.take() == texts
    assert reader.take() == []
    for turn in range(11):
        assert writer.put(b"%d" % turn)
        assert reader.take() == [b"%d" % turn]


def test_a_full_queue_takes_none_until_it_is_read(tmp_path: Path) -> None:
    reader = TextQueue.create(tmp_path / "texts", 64, 4)
    writer = TextQueue.open(tmp_path / "texts", writable=True)
    assert [writer.put(b"%d" % turn) for turn in range(6)] == [True] * 4 + [False] * 2
    assert not writer.put(bytes(65)), "longer than any"
    assert reader.take() == [b"0", b"1", b"2", b"3"]
    assert writer.put(b"again")
    assert reader.take() == [b"again"]


def test_a_writer_that_was_started_again_goes_on_behind_the_other(tmp_path: Path) -> None:
    reader = TextQueue.create(tmp_path / "texts", 64, 4)
    TextQueue.open(tmp_path / "texts", writable=True).put(b"first")
    TextQueue.open(tmp_path / "texts", writable=True).put(b"second")
    assert reader.take() == [b"first", b"second"]


def test_the_run_folder_is_this_users_alone(run_base: Path) -> None:
    folder = make_run_folder()
    assert folder.parent == run_base
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    (folder / "ring").write_bytes(b"")
    remove_run_folder(folder)
    assert list(run_base.iterdir()) == []
    remove_run_folder(folder)


def test_somebody_who_still_writes_does_not_keep_the_folder(run_base: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder, unlink = make_run_folder(), os.unlink

    def unlink_while_another_writes(*arguments: object, **words: object) -> None:
        unlink(*arguments, **words)  # type: ignore[arg-type]  # passed on as they are
        try:
            (folder / "late").write_text("")
        except FileNotFoundError:
            return

    (folder / "file").write_text("")
    monkeypatch.setattr(os, "unlink", unlink_while_another_writes)
    remove_run_folder(folder)
    assert list(run_base.iterdir()) == []


def test_the_folder_of_a_dead_owner_is_swept_and_no_other(run_base: Path) -> None:
    words = [sys.executable, "-c", MAKE_AND_STAY, str(run_base)]
    process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdin is not None
    assert process.stdout is not None
    theirs = Path(process.stdout.readline().strip())
    (theirs / "ring").write_bytes(b"1")
    others = run_base / "simconsole-notes"
    others.mkdir()
    ours = make_run_folder()  # sweeps
    assert theirs.is_dir()
    process.kill()
    process.wait()
    process.stdin.close()
    process.stdout.close()
    assert sweep(run_base) == [theirs]
    assert sorted(run_base.iterdir()) == sorted([others, ours])
    remove_run_folder(ours)


def test_an_owner_that_only_its_lock_shows_is_left_alone(run_base: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = make_run_folder()
    monkeypatch.setattr(shared_memory, "_alive", lambda process_id: False)  # as from another container
    assert sweep(run_base) == []
    remove_run_folder(folder)


def test_a_link_is_not_followed(run_base: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    victim = tmp_path / "victim"
    victim.mkdir()
    (victim / "file").write_text("precious")
    (run_base / "simconsole-999999999-a").symlink_to(victim)
    (run_base / "simconsole-999999998-a").symlink_to(tmp_path / "nowhere")
    monkeypatch.setattr(shared_memory, "_alive", lambda process_id: False)
    assert sweep(run_base) == []
    assert (victim / "file").exists()
