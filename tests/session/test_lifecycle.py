"""One session, from opening to its bundle: what the recorder tells the drive, and who may end it."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.session.lifecycle import DriveResult, LogRecorder, drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.signals import Event
from simconsole.values.state_vector import Snapshot

FAILED = int(Event.RECORDING_FAILED)


class Log:
    """A log whose disk fails as it is told to."""

    def __init__(self, error: Exception | None = None) -> None:
        self.failure: str | None = None
        self.error = error
        self.ticks: list[int] = []

    def append(self, tick: int, vector: np.ndarray) -> None:
        if self.error is not None:
            raise self.error
        self.ticks.append(tick)


def snapshot(tick: int) -> Snapshot:
    return Snapshot(tick, 250, np.zeros(1))


def test_a_log_that_stopped_is_an_alarm_in_every_tick_after() -> None:
    log = Log()
    recorder = LogRecorder(log)  # type: ignore[arg-type]  # as far as a recorder needs it
    assert [recorder.write(snapshot(tick)) for tick in (1, 2)] == [0, 0]
    log.failure = "no space left"
    assert [recorder.write(snapshot(tick)) for tick in (3, 4)] == [FAILED, FAILED]
    assert log.ticks == [1, 2, 3, 4]


def test_what_raises_is_kept_as_the_first_reason_and_raised_on() -> None:
    log = Log(ValueError("width"))
    recorder = LogRecorder(log)  # type: ignore[arg-type]
    for _ in range(2):
        with pytest.raises(ValueError, match="width"):
            recorder.write(snapshot(1))
        log.error = ValueError("width, another time")
    assert log.failure == "ValueError: width"


@pytest.fixture
def resolved() -> ResolvedSession:
    """The ball, with nobody to command it, for two seconds."""
    session = override(
        load_session("roll_a_ball"),
        scenario={"duration_s": 2.0},
        features={"autopilot": None},
        outputs={"bridge": None, "hud": None, "scene": None, "report": False},
        mode={"pacing": "free"},
    )
    return resolve(session)


def test_a_drive_lasts_as_long_as_its_scenario_and_is_in_its_bundle(resolved: ResolvedSession, tmp_path: Path) -> None:
    seen: list[int] = []

    def watch(found: Snapshot) -> bool:
        seen.append(found.tick)
        return False

    result = drive(resolved, tmp_path / "bundle", watch)
    ticks = 2 * resolved.session.mode.tick_hz
    assert result.ticks == ticks == len(seen)
    assert (result.interrupted, result.recording_failure) == (False, None)
    manifest = open_bundle(result.folder).manifest
    assert (manifest.finished, manifest.ticks, manifest.digest) == (True, ticks, result.digest)


def test_who_watches_may_end_it_and_equal_ticks_are_equal(resolved: ResolvedSession, tmp_path: Path) -> None:
    def driven(name: str) -> DriveResult:
        return drive(resolved, tmp_path / name, lambda found: found.tick == 30)

    first, second = driven("first"), driven("second")
    assert first.ticks == second.ticks
    assert 30 <= first.ticks <= 31
    assert first.digest == second.digest
    assert not first.interrupted
