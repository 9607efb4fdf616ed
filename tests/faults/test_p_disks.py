"""P01 of the fault catalogue: a disk that fails under a drive. Of the log alone see tests/recording."""

import errno
import random
from pathlib import Path

import pytest

from simconsole.cli.driven import finish
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.session.lifecycle import drive
from simconsole.values.errors import RecordingError
from simconsole.values.signals import Event
from simconsole.values.state_vector import Snapshot
from tests.drives.console import results, within
from tests.faults.disks import DISKS, SIZE_BYTES, Disk, memory
from tests.faults.recorded import TICKS, session, unfinish
from tests.patience import pause
from tests.samples import Measured, Sample


class Watcher:
    """Lets the disk fail at one tick, and notes the first tick that tells."""

    def __init__(self, disk: Disk, folder: Path, at: int) -> None:
        self._disk, self._folder, self._at = disk, folder, at
        self.last = 0
        self.told: list[int] = []

    def watch(self, snapshot: Snapshot) -> bool:
        self.last = snapshot.tick
        if snapshot.recording_failed:
            self.told.append(snapshot.tick)
        if snapshot.tick == self._at:
            self._disk.fail(self._folder)
        return False


@pytest.mark.fault("P01")
@pytest.mark.parametrize("disk", DISKS, ids=lambda disk: disk.name)
def test_p01_a_disk_that_fails_at_any_moment(
    disk: Disk, script: Path, tmp_path: Path, sample: Sample, measured: Measured
) -> None:
    """The drive goes on to its end, everybody is told in the next tick, what was recorded stays readable."""
    generator = random.Random(sample.seed)
    resolved = session(script)
    latest = 0
    for moment in range(sample.of(3, 10)):
        at = generator.randrange(80, TICKS - 10)
        place = tmp_path / f"disk{moment}"
        with disk.mounted(place):
            folder = place / "bundle"
            watcher = Watcher(disk, folder, at)
            result = drive(resolved, folder, watcher.watch)
            assert watcher.last == TICKS - 1, "the drive went on (its last tick ends it unseen)"
            assert result.recording_failure is not None
            assert f"{folder / 'drive.log'}: recording stopped at tick " in result.recording_failure
            failed = int(result.recording_failure.split("at tick ")[1].split(":")[0])
            assert at < failed <= at + 2, "a row is half a block: one more may fit"
            assert watcher.told == list(range(failed + 1, TICKS)), "from the next tick to the end"
            latest = max(latest, watcher.told[0] - failed)
            outcome = finish(result, report=False, scene=False)
            assert outcome.code == 1
            assert outcome.results["recording_failure"] == result.recording_failure
            assert ["RECORDING", "FAILED", result.recording_failure] in [
                line.split(maxsplit=2) for line in outcome.text.splitlines()
            ]
            _readable_to_the_last_record(folder, failed)
    measured("P01", f"{disk.name}: alarm after the tick whose write failed", f"{latest} tick", "1 tick")


def _readable_to_the_last_record(folder: Path, failed: int) -> None:
    bundle = open_bundle(folder)
    ticks = [record.tick for record in bundle.log]
    assert ticks == list(range(1, len(ticks) + 1))
    assert len(ticks) in (failed - 1, failed + 1), "all before it; with room for the last ticks the alarm too"
    assert bundle.log.breaks == ()
    events = bundle.log.table().column("events.events").astype(int) & Event.RECORDING_FAILED
    assert events.nonzero()[0].tolist() == ([] if len(ticks) < failed else [failed])
    replayed = replay_bundle(folder)
    assert (replayed.equal, replayed.ticks) == (True, len(ticks))
    if bundle.manifest.finished:
        assert not replayed.good
        assert [path.name for path in folder.iterdir() if path.suffix == ".new"] == []
        assert verify(folder) == [bundle.manifest.recording_failure]


@pytest.mark.fault("P01")
def test_p01_a_full_disk_keeps_the_alarm_and_the_reason(script: Path, tmp_path: Path) -> None:
    """Their room was taken at the start: the log's last row holds the alarm, the manifest says why it is the last."""
    with memory(tmp_path / "disk"):
        folder = tmp_path / "disk" / "bundle"
        watcher = Watcher(DISKS[0], folder, 100)
        drive(session(script, 1.0), folder, watcher.watch)
        bundle = open_bundle(folder)
        assert bundle.manifest.finished
        assert "No space left on device" in str(bundle.manifest.recording_failure)
        assert bundle.manifest.summary["lateness"]
        assert bundle.log.table().column("events.events").tolist()[-2:] == [0.0, float(Event.RECORDING_FAILED)]
        assert sorted(path.name for path in folder.iterdir()) == ["drive.log", "manifest.json", "session.json"]


@pytest.mark.fault("P01")
def test_p01_a_drive_that_is_killed_after_its_recording_failed_is_no_success(script: Path, tmp_path: Path) -> None:
    """Nobody wrote the reason into the manifest, but the log's last row holds the alarm."""
    with memory(tmp_path / "disk"):
        folder = tmp_path / "disk" / "bundle"
        drive(session(script, 1.0), folder, Watcher(DISKS[0], folder, 100).watch)
        failed = open_bundle(folder).manifest.ticks - 1
        unfinish(folder, recording_failure=None)
        told = f"{folder / 'drive.log'}: recording stopped at tick {failed}"
        assert replay_bundle(folder).problems == (told,)
        assert told in verify(folder)


@pytest.mark.fault("P01")
def test_p01_a_disk_that_only_fails_to_sync_raises_the_same_alarm(
    script: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(fd: int) -> None:
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr("simconsole.recording.bundles.log._synchronise", broken)
    told: list[int] = []

    def watch(snapshot: Snapshot) -> bool:
        pause(0.001)
        if snapshot.recording_failed:
            told.append(snapshot.tick)
        return len(told) > 5

    result = drive(session(script, 3600.0), tmp_path / "bundle", watch)
    assert told == list(range(told[0], told[0] + 6))
    assert str(result.recording_failure).endswith("sync: Input/output error")
    assert finish(result).code == 1
    assert told[0] - 1 <= result.ticks - 1 <= told[0], "the alarm is in the log"


@pytest.mark.fault("P01")
def test_p01_from_the_command_line_every_command_tells_it(script: Path, tmp_path: Path) -> None:
    """A drive that outgrows its disk: 1, and 1 again from whatever looks at what it left."""
    place = tmp_path / "disk"
    with memory(place):
        (place / "filler").write_bytes(bytes(SIZE_BYTES - (1 << 20)))
        bundle = place / "bundle"
        words = ("--headless", "--driver", f"script:{script}", "--for", 5, "--out", bundle, "--json")
        done = within("drive", *words)
        told = results(done)
        assert done.returncode == 1, done.stdout + done.stderr
        assert "Traceback" not in done.stderr
        assert "No space left on device" in told["recording_failure"]
        assert "RECORDING FAILED" in done.stderr
        assert told["exports_failure"] == "not tried, for the recording failed"
        assert not list(bundle.glob("*.new"))
        (place / "filler").unlink()
        for command, *more in (["replay"], ["verify"], ["report"], ["view", "--no-open"], ["compare", bundle]):
            looked = within(command, bundle, *more, "--json")
            assert looked.returncode == 1, (command, looked.stdout, looked.stderr)
            assert told["recording_failure"] in results(looked)["problems"], command
            assert told["recording_failure"] in looked.stderr.splitlines(), command


@pytest.mark.fault("P01")
def test_p01_a_disk_that_is_full_at_the_start_is_one_line(script: Path, tmp_path: Path) -> None:
    place = tmp_path / "disk"
    with memory(place):
        (place / "filler").write_bytes(bytes(SIZE_BYTES - (1 << 15)))
        with pytest.raises(RecordingError, match=r"bundle: cannot be recorded to: No space left on device"):
            drive(session(script), place / "bundle")
        assert [path.name for path in place.iterdir()] == ["filler"]
