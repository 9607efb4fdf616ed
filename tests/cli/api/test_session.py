"""A session from Python: values, own code, how a run ends; what it drives is what the command line drives."""

import threading
from pathlib import Path

import numpy as np
import pytest

import simconsole
from simconsole import Command, OwnSignals, Session, Snapshot, hold_speed
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.values.errors import ProfileError, SimConsoleError
from tests.drives.console import within as command_line


@pytest.fixture(scope="module")
def ball() -> Session:
    """The ball, at 100 ticks a second: the quickest of our vehicles."""
    return simconsole.load("roll_a_ball")


def test_values_change_session_and_vehicle_and_leave_the_original(ball: Session) -> None:
    changed = ball.with_values({"scenario.duration_s": 3.0, "mode.tick_hz": 50}).with_values({"mode.tick_hz": 250})
    assert (changed.profile.scenario.duration_s, changed.profile.mode.tick_hz) == (3.0, 250)
    assert (ball.profile.scenario.duration_s, ball.profile.mode.tick_hz) == (20, 100)
    car = simconsole.load("bridge").with_values({"body.mass_kg": 1600, "vehicle.body.height_m": 1.6})
    body = getattr(car.resolved.vehicle, "body")  # noqa: B009  of a car, which this is
    assert (body.mass_kg, body.height_m) == (1600.0, 1.6)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"body.mass_kg": 9e9}, r"vehicle: body\.mass_kg: value 9000000000\.0: a number from 300 to 5000"),
        ({"bdy.mass_kg": 1.0}, r"bdy: .*unknown key, did you mean body"),
        ({"environment.friction": "wet"}, r"environment\.friction: value .wet.: a number"),
        ({"environment.friction.x": 1.0}, r"friction has no keys of its own"),
        ({"world.nothing": 1.0}, r"nothing: .*unknown key"),
    ],
)
def test_a_wrong_value_is_told_with_key_and_range(values: dict[str, object], said: str) -> None:
    with pytest.raises(ProfileError, match=said):
        simconsole.load("bridge").with_values(values)


def test_a_session_without_world_has_no_route(ball: Session) -> None:
    with pytest.raises(ProfileError, match=r"environment\.world"):
        _ = ball.route
    with pytest.raises(ProfileError, match="world: the session has none"):
        ball.with_values({"world.title": "x"})


def test_an_own_controller_drives_and_its_signals_stand_beside_ours(tmp_path: Path) -> None:
    signals = OwnSignals("wanted_mps")

    def controller(seen: Snapshot) -> Command:
        wanted_mps = 2.0 + 0.1 * seen.tick
        signals.set(wanted_mps=wanted_mps)
        return hold_speed(min(wanted_mps, 6.0))

    drive = simconsole.load("bridge").run(controller, signals=signals, duration_s=8.0, out=tmp_path / "bundle")
    assert drive.column("vehicle.vx_mps")[-1] == pytest.approx(6.0, abs=0.5)
    wanted = drive.column("own.wanted_mps")
    period = 5
    assert np.isnan(wanted[: period - 1]).all()
    assert wanted[period - 1 : -1 : period] == pytest.approx(2.0 + 0.1 * np.arange(period, drive.ticks, period))
    assert drive.replay().hashes_equal
    notes = open_bundle(drive.folder).manifest.provenance.notes
    assert [note for note in notes if "controller" in note] == [
        "own controller tests.cli.api.test_session.test_an_own_controller_drives_and_its_signals_stand_beside_ours"
        ".<locals>.controller"
    ]
    assert command_line("verify", drive.folder).returncode == 0
    assert command_line("replay", drive.folder).returncode == 0
    out = tmp_path / "drive.csv"
    done = command_line("export", drive.folder, "--to", "csv", "--columns", "own.*", "vehicle.x_m", "--out", out)
    assert done.returncode == 0, done.stderr
    assert out.read_text().splitlines()[0].replace('"', "") == "tick,time_s,vehicle.x_m,own.wanted_mps"


def test_equal_runs_are_equal_whether_signals_are_recorded_or_not() -> None:
    session = simconsole.load("bridge").with_values({"scenario.duration_s": 2.0})
    signals = OwnSignals("tick")

    def watched(seen: Snapshot) -> Command:
        signals.set(tick=seen.tick)
        return hold_speed(5.0)

    plain = session.run(lambda seen: hold_speed(5.0))
    assert session.run(watched, signals=signals).digest == plain.digest
    assert session.run(watched, signals=signals).digest == plain.digest


def test_link_and_watchdog_treat_it_like_any_other(tmp_path: Path) -> None:
    """Its commands arrive as late as the session's link says, and one that falls silent is stopped for."""
    session = simconsole.load("bridge").with_values({"outputs.bridge.link.delay_ms": 100.0})
    silent_from = 500

    def controller(seen: Snapshot) -> Command | None:
        return hold_speed(5.0) if seen.tick < silent_from else None

    drive = session.run(controller, duration_s=6.0)
    sequence = drive.column("ros.sequence")
    assert np.flatnonzero(sequence)[0] + 1 == 5 + 25  # asked at tick 5, and 100 ms are 25 ticks
    modes = [event.detail for event in drive.events if event.name == "mode"]
    assert any("SAFE STOP" in mode for mode in modes), modes


def test_a_session_runs_as_the_command_line_drives_it(short: Path, script: Path) -> None:
    session = simconsole.load("seated").with_values({"devices.driver": f"script:{script}"})
    drive = session.run(duration_s=3.0)
    assert drive.digest == open_bundle(short).manifest.digest


def test_without_a_controller_whoever_connects_over_the_bridge_commands() -> None:
    drive = simconsole.load("demo").run(duration_s=2.0)  # in lockstep: its autopilot is a program of its own
    answered = np.flatnonzero(np.diff(drive.column("ros.sequence")))
    assert len(answered) > 80  # of 100 control periods, less the link's delay at the beginning
    assert drive.replay().hashes_equal


def test_an_observer_sees_each_control_period_and_commands_nothing(script: Path) -> None:
    session = simconsole.load("seated").with_values({"devices.driver": f"script:{script}"})
    seen: list[int] = []
    watched = session.run(observer=lambda snapshot: seen.append(snapshot.tick), duration_s=1.0)
    assert seen == list(range(5, 251, 5))
    assert watched.digest == session.run(duration_s=1.0).digest


def test_a_drive_ends_when_it_shall(ball: Session) -> None:
    assert ball.run(lambda seen: None, until=lambda seen: seen.tick >= 40, duration_s=5.0).ticks == 40


def test_what_own_code_raises_comes_out_of_the_run_and_the_bundle_is_whole(ball: Session, tmp_path: Path) -> None:
    def controller(seen: Snapshot) -> Command:
        if seen.tick >= 20:
            raise LookupError("no gain for this speed")
        return simconsole.go_to(1.0, 0.0)

    with pytest.raises(LookupError, match="no gain") as raised:
        ball.run(controller, out=tmp_path / "bundle")
    assert any("raised after tick 20" in note for note in raised.value.__notes__)
    assert open_bundle(tmp_path / "bundle").manifest.finished
    assert command_line("verify", tmp_path / "bundle").returncode == 0


def test_signals_end_a_drive_only_in_the_main_thread(ball: Session) -> None:
    told: list[BaseException] = []

    def elsewhere() -> None:
        try:
            ball.run(lambda seen: None)
        except SimConsoleError as error:
            told.append(error)

    thread = threading.Thread(target=elsewhere)
    thread.start()
    thread.join()
    assert "main thread" in str(told[0])


def test_a_temporary_bundle_goes_with_its_drive(ball: Session) -> None:
    drive = ball.run(lambda seen: None, duration_s=0.5)
    folder = drive.folder
    assert folder.is_dir()
    del drive
    assert not folder.exists()


def test_a_scenario_is_checked_as_the_command_line_checks_it() -> None:
    verdict = simconsole.check("launch_and_stop")
    assert (verdict.scenario, verdict.passed, verdict.problems) == ("launch_and_stop", True, [])
