"""One session, from opening to its bundle: how long it lasts, and who may end it."""

import os
from pathlib import Path

import msgspec
import pytest

from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.session import lifecycle
from simconsole.session.lifecycle import DriveResult, drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.errors import DeviceNotFound
from simconsole.values.host.jit import plain
from simconsole.values.state_vector import Snapshot


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


def test_who_is_only_shown_a_drive_does_not_make_it_tick_by_tick(resolved: ResolvedSession, tmp_path: Path) -> None:
    shown: list[int] = []
    watched = drive(resolved, tmp_path / "watched", lambda found: False)
    result = drive(resolved, tmp_path / "shown", show=lambda found: shown.append(found.tick))
    assert result.digest == watched.digest
    assert shown == sorted(shown)
    assert shown[-1] > 0.8 * result.ticks
    assert len(shown) < 0.2 * result.ticks


def test_what_workers_wrote_beside_the_log_is_listed_once_they_have_ended(
    resolved: ResolvedSession, tmp_path: Path
) -> None:
    def watch(found: Snapshot) -> bool:
        if found.tick == 3:
            (tmp_path / "b" / "topics.mcap").write_bytes(b"as a worker would")
        return found.tick == 10

    drive(resolved, tmp_path / "b", watch)
    assert open_bundle(tmp_path / "b").manifest.files["topics.mcap"].export
    assert verify(tmp_path / "b") == []


def test_a_missing_wheel_is_told_before_anything_is_compiled(
    resolved: ResolvedSession, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("SDL_VIDEODRIVER", raising=False)
    monkeypatch.setattr(lifecycle, "assemble", lambda *_: pytest.fail("compiled"))
    cockpit = load("devices", "t500rs_th8rs", CockpitProfile)
    seated = msgspec.structs.replace(
        resolved, cockpit=cockpit, session=override(resolved.session, devices={"driver": "sdl"})
    )
    with pytest.raises(DeviceNotFound, match="role wheel"):
        drive(seated, tmp_path / "bundle")
    assert not (tmp_path / "bundle").exists()
    assert "SDL_VIDEODRIVER" not in os.environ, "the window that is opened later must be seen"


def test_what_makes_many_ticks_is_ready_before_a_controller_is_waited_for(resolved: ResolvedSession) -> None:
    console, state = assemble(resolved, plain)
    made: list[int] = []
    watched = console._replace(block=lambda previous, rows, *settings: made.append(len(rows)))
    lifecycle.warm_up(watched, state)
    assert made == [], "nobody waits: it is compiled once it is needed"
    lifecycle.warm_up(watched, state, awaited=True)
    assert made == [1]
