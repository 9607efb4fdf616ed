"""P02 to P04 of the fault catalogue: what is left of a drive after kills, power cuts and damage."""

import io
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from simconsole.recording.bundles import log
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.log import SYNC_INTERVAL_S, LogReader
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.recording.framing import frame_size
from simconsole.recording.scan import Scan
from simconsole.session.lifecycle import drive
from simconsole.values.errors import RecordingError
from simconsole.values.state_vector import Snapshot
from tests.drives.console import results, within
from tests.faults.recorded import HZ, session, unfinish
from tests.patience import PATIENCE_S, wait_until
from tests.samples import Measured, Sample

KILLED = """
import mmap, os, sys, time
from pathlib import Path
from simconsole.recording.bundles.provenance import Given
from simconsole.session import headless
from simconsole.session.lifecycle import drive
from tests.faults.recorded import session
folder = Path(sys.argv[1])
resolved = session(Path(sys.argv[2]), 3600.0)
begun = memoryview(mmap.mmap(os.open(folder / "begun", os.O_RDWR), 8)).cast("q")
recorder = headless.LogRecorder
def said():  # by an operator, in each third tick; the tick in work is the one after the last that began
    tick = begun[0] + 1
    return [b'{"tick":%d,"act":"mark","participant":"P07"}' % tick] if tick % 3 == 0 else []
headless.LogRecorder = lambda log, take_acts, *sources: recorder(log, said, *sources)
drive(resolved, folder / "warm", lambda snapshot: snapshot.tick >= 10)  # compiled and loaded, once for all
def watch(snapshot):
    begun[0] = snapshot.tick  # shared memory: survives the kill, like nothing inside the process
    time.sleep(0.0001)
    return False
for name in sys.stdin:
    begun[0] = 0
    child = os.fork()
    if child == 0:
        drive(resolved, folder / name.strip(), watch, given=Given(participant=f"P{name.strip()}", notes=("tired",)))
        os._exit(1)
    print(child, flush=True)
    os.waitpid(child, 0)
    print("dead", flush=True)
"""


@pytest.mark.fault("P02")
def test_p02_kill_9_of_a_drive_loses_at_most_the_tick_in_work(
    script: Path, tmp_path: Path, sample: Sample, measured: Measured
) -> None:
    """At random ticks: the log opens without repair, replays, and lacks nothing that was done."""
    generator = random.Random(sample.seed)
    (tmp_path / "begun").write_bytes(bytes(8))
    lost, kills = 0, sample.of(8, 50)
    words = [sys.executable, "-c", KILLED, str(tmp_path), str(script)]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as drives:
        assert drives.stdin is not None
        assert drives.stdout is not None

        def begun() -> int:
            return int.from_bytes((tmp_path / "begun").read_bytes(), sys.byteorder)

        for turn in range(kills):
            kill_at = generator.randrange(1, 1000)
            drives.stdin.write(f"{turn}\n")
            drives.stdin.flush()
            child = int(drives.stdout.readline())
            wait_until(lambda tick=kill_at: begun() >= tick, f"tick {kill_at}")  # type: ignore[misc]
            os.kill(child, signal.SIGKILL)
            assert drives.stdout.readline() == "dead\n"
            bundle = open_bundle(tmp_path / str(turn))
            assert not bundle.manifest.finished
            told = bundle.manifest.provenance
            assert (told.participant, told.notes) == (f"P{turn}", ("tired",))
            assert told.machine is not None
            ticks = [record.tick for record in bundle.log]
            assert ticks == list(range(1, len(ticks) + 1))
            assert begun() - 1 <= len(ticks) <= begun() + 1
            lost = max(lost, begun() - len(ticks))
            acts = [(message.tick, json.loads(message.content)) for message in bundle.log.messages("acts")]
            said = {"act": "mark", "participant": "P07"}
            assert acts == [(tick, {"tick": tick, **said}) for tick in ticks if tick % 3 == 0]
            replayed = replay_bundle(bundle.folder)
            assert replayed.good, replayed
            assert replayed.ticks == len(ticks)
            shutil.rmtree(bundle.folder)
        drives.stdin.close()
        assert drives.wait(PATIENCE_S) == 0
    measured("P02", f"ticks lost at most, {kills} kills of a drive", str(lost), "1")


class SyncedLog:
    """A drive whose log is synced by simulated time: a second of ticks, then one sync, and no other."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.synced_bytes = 0
        self._due, self._done = threading.Semaphore(0), threading.Semaphore(0)
        owner = self

        class Closing(threading.Event):
            def wait(self, timeout: float | None = None) -> bool:
                if timeout is None:
                    return super().wait()
                assert timeout == SYNC_INTERVAL_S
                owner._done.release()
                owner._due.acquire()
                return self.is_set()

            def set(self) -> None:
                super().set()
                owner._due.release()

        def synchronise(fd: int) -> None:
            os.fsync(fd)
            self.synced_bytes = os.fstat(fd).st_size

        monkeypatch.setattr(log, "Event", Closing)
        monkeypatch.setattr(log, "_synchronise", synchronise)

    def second(self) -> None:
        """Let a second pass: the thread wakes, syncs, and waits for the next."""
        self._done.acquire()
        self._due.release()
        self._done.acquire()
        self._done.release()


@pytest.mark.fault("P03")
def test_p03_a_power_cut_takes_at_most_a_second(
    script: Path, tmp_path: Path, sample: Sample, measured: Measured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever was not synced is gone: what was, from the profiles to the last second's begin, opens and replays."""
    synced = SyncedLog(monkeypatch)
    generator = random.Random(sample.seed)
    cuts = sorted(generator.sample(range(HZ, 4 * HZ), sample.of(20, 200)))
    survivors: list[tuple[int, int]] = []
    folder = tmp_path / "bundle"

    def watch(snapshot: Snapshot) -> bool:
        if snapshot.tick and snapshot.tick % round(SYNC_INTERVAL_S * HZ) == 0:
            synced.second()
        if snapshot.tick in cuts:
            survivors.append((snapshot.tick, synced.synced_bytes))
        return False

    drive(session(script, 4.0), folder, watch)
    assert [tick for tick, _ in survivors] == cuts
    most = 0
    for tick, size in survivors:
        cut = tmp_path / "cut"
        shutil.copytree(folder, cut)
        unfinish(cut)
        with (cut / "drive.log").open("r+b") as file:
            file.truncate(size)
        replayed = replay_bundle(cut)
        assert (replayed.good, replayed.remarks) == (True, (f"{cut / 'manifest.json'}: the drive was not finished",))
        most = max(most, tick - replayed.ticks)
        shutil.rmtree(cut)
    assert most <= round(SYNC_INTERVAL_S * HZ)
    measured("P03", f"lost at most, {len(cuts)} power cuts", f"{most / HZ:.3f} s of the drive", "1 s")


@pytest.fixture(scope="module")
def unfinished(script: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A bundle of six ticks that was never finished. Put back what a test changes."""
    folder = tmp_path_factory.mktemp("unfinished") / "bundle"
    drive(session(script, 6 / HZ), folder)
    unfinish(folder)
    return folder


@pytest.mark.fault("P04")
def test_p04_a_log_cut_at_every_byte_replays_as_far_as_it_is_whole(
    unfinished: Path, sample: Sample, measured: Measured
) -> None:
    """Read at every byte, or in the sample at every third; replayed at some. Both on both sides of every tick's end."""
    path = unfinished / "drive.log"
    content = path.read_bytes()
    width = len(LogReader(path).header.columns)
    frame = frame_size(width)
    start = len(content) - 6 * frame
    generator = random.Random(sample.seed)
    ends = [start + tick * frame for tick in range(7)]
    chosen = {min(end + beside, len(content)) for end in ends for beside in (-1, 0, 1)}
    chosen |= set(generator.sample(range(len(content)), sample.of(12, 300)))
    read = sorted({*range(0, len(content), sample.of(3, 1)), *(size for size in chosen if size < len(content))})
    try:
        for size in read:
            if size < start:
                with pytest.raises(RecordingError):
                    Scan(io.BytesIO(content[:size]).read, "cut")
                continue
            scan = Scan(io.BytesIO(content[:size]).read, "cut")
            whole, rest = divmod(size - start, frame)
            assert [record.tick for record in scan] == list(range(1, whole + 1))
            assert [(part.size_bytes, part.torn) for part in scan.breaks] == ([(rest, True)] if rest else [])
        for size in sorted(chosen):
            path.write_bytes(content[:size])
            if size < start:
                with pytest.raises(RecordingError):
                    replay_bundle(unfinished)
                continue
            whole, rest = divmod(size - start, frame)
            replayed = replay_bundle(unfinished)
            assert (replayed.good, replayed.ticks, len(replayed.remarks)) == (True, whole, 2 if rest else 1)
            assert not rest or f"{path}: {rest} bytes from byte {size - rest}: torn" in replayed.remarks[1]
    finally:
        path.write_bytes(content)
    measured("P04", "cut at every byte: read, replayed", f"{len(read)}, {len(chosen)}", "all whole ticks, no error")


@pytest.mark.fault("P04")
def test_p04_every_flipped_bit_is_named_and_no_success(unfinished: Path, sample: Sample, measured: Measured) -> None:
    """In the last tick as in any other: damage is no torn tail."""
    path = unfinished / "drive.log"
    content = path.read_bytes()
    frame = frame_size(len(LogReader(path).header.columns))
    start = len(content) - 6 * frame
    generator = random.Random(sample.seed)
    flips = sample.of(120, 2_000)
    successes = 0
    try:
        for turn in range(flips):
            first = len(content) - frame if turn % 2 else 0  # every other one in the last tick
            at, bit = generator.randrange(first, len(content)), generator.randrange(8)
            damaged = bytearray(content)
            damaged[at] ^= 1 << bit
            path.write_bytes(damaged)
            try:
                replayed = replay_bundle(unfinished)
            except RecordingError:  # a whole tick behind the damage shows that one is missing
                assert at < len(content) - frame
                continue
            successes += replayed.good
            assert at >= start
            assert (replayed.equal, replayed.ticks) == (True, 5)
            (problem,) = replayed.problems
            assert problem.startswith(f"{path}: {frame} bytes from byte {len(content) - frame}: damaged")
            assert problem in verify(unfinished)
    finally:
        path.write_bytes(content)
    assert successes == 0
    measured("P04", f"{flips} flipped bits that passed as a success", str(successes), "0")


@pytest.mark.fault("P04")
def test_p04_from_the_command_line_damage_fails_and_a_torn_tail_is_named(unfinished: Path) -> None:
    path = unfinished / "drive.log"
    content = path.read_bytes()
    try:
        path.write_bytes(content[:-9])
        torn = within("replay", unfinished, "--json")
        assert torn.returncode == 0
        remark = results(torn)["remarks"][1]
        assert remark.endswith("as a drive that was killed leaves it")
        assert remark in torn.stderr.splitlines()
        path.write_bytes(content[:-9] + bytes([content[-9] ^ 1]) + content[-8:])
        for command, *more in (["replay"], ["compare", unfinished]):
            damaged = within(command, unfinished, *more, "--json")
            assert damaged.returncode == 1
            assert all("damaged, wrong checksum" in problem for problem in results(damaged)["problems"])
            assert results(damaged)["problems"][0] in damaged.stderr.splitlines()
    finally:
        path.write_bytes(content)
