"""The loop while simulated time stands, and a drive that begins anew: recorded, and replayed bit for bit."""

from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.profiles.files.loader import parse
from simconsole.profiles.parts.script import ScriptProfile
from simconsole.profiles.session import SessionProfile
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.resolution import resolve
from simconsole.tick.advance import Console, advance_vector
from simconsole.tick.assembly import assemble
from simconsole.tick.loop import Components, run
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import Row
from simconsole.values.platform import Step
from simconsole.values.protocols import NobodySeated
from simconsole.values.signals import (
    NO_COMMAND,
    DeviceSample,
    Event,
    EventInput,
    Mode,
    Notice,
    Reason,
    RemoteCommand,
    RemoteKind,
)
from simconsole.values.state_vector import INPUT_WIDTH, Snapshot

HZ = 250
SESSION = "schema: 1\nscenario: {vehicle: hatchback}\ndevices: {driver: none}\n"
REST = "{time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}"


class Operator:
    """A controller that always asks for 1 m/s2, and an operator with a plan: (tick, looks at that tick) -> event."""

    def __init__(self, plan: dict[tuple[int, int], Event]) -> None:
        self.plan = plan
        self.looks: dict[int, int] = {}

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        look = self.looks[tick] = self.looks.get(tick, 0) + 1
        command = NO_COMMAND._replace(kind=float(RemoteKind.ACCELERATION), sequence=float(tick), accel_mps2=1.0)
        return command._replace(age_ticks=0.0), EventInput(float(self.plan.get((tick, look), 0)))


class Driven:
    def __init__(self, console: Console, recorder: MemoryRecorder, first: np.ndarray, looks: dict[int, int]) -> None:
        self.console, self.vectors, self.first, self.looks = console, recorder.vectors[: recorder.ticks], first, looks

    def at(self, tick: int) -> Snapshot:
        return Snapshot(tick, HZ, self.vectors[tick - 1])

    def column(self, name: str) -> np.ndarray:
        return self.vectors[:, self.console.columns.index(name)]

    def replayed(self) -> bool:
        """Whether a replay from the recorded inputs gives the same bytes."""
        row = self.first
        for recorded in self.vectors:
            row = advance_vector(row, recorded[:INPUT_WIDTH], self.console)
            if row.tobytes() != recorded.tobytes():
                return False
        return True


@pytest.fixture(scope="module")
def go() -> Callable[..., Driven]:
    resolved = resolve(parse(SESSION, SessionProfile, "session"))
    assembled, state = assemble(resolved, compiled)

    def drive(
        plan: dict[tuple[int, int], Event],
        points: str = "",
        seconds: float = 8.0,
        on_request: bool = False,
        step: Step | None = None,
    ) -> Driven:
        console = assembled if step is None else assembled._replace(step=step)
        script = parse(f"points:\n  - {REST}\n{points}", ScriptProfile, "script")
        devices = ScriptSource(script, cockpit_settings(resolved.cockpit, HZ), tick_hz=HZ)
        recorder, operator = MemoryRecorder(round(seconds * HZ), console.width), Operator(plan)
        stood: list[Snapshot] = []
        components = Components(devices, operator, recorder, (), UnpacedPacer(), standby=(stood.append,))
        run(console, state, components, round(seconds * HZ), lambda snapshot: len(stood) > 1000, on_request)
        return Driven(console, recorder, state.vector, operator.looks)

    return drive


ENGAGE = {(250, 1): Event.REQUEST_AUTONOMOUS}


def test_paused_time_stands_and_nothing_grows_old(go: Callable[..., Driven]) -> None:
    plain = go(ENGAGE)
    paused = go({**ENGAGE, (1000, 1): Event.PAUSE, (1001, 500): Event.START})
    assert paused.looks[1001] == 501, "looked 500 times while it stood, once for its tick"
    assert paused.at(1000).events.events == Event.PAUSE
    assert paused.at(1001).events.events == Event.START
    assert paused.at(1001).vehicle.vx_mps - paused.at(1000).vehicle.vx_mps < 0.01
    rest = [name for name in plain.console.columns if not name.startswith(("events.", "torque.", "motor."))]
    unlike = [name for name in rest if not np.array_equal(paused.column(name), plain.column(name))]
    assert not unlike, "as if there had been no pause"
    assert paused.replayed()


def test_the_vehicle_is_stepped_once_a_tick_however_long_time_stands(go: Callable[..., Driven]) -> None:
    """One with a state that it does not show, an FMU, would have to begin anew for each look."""
    own, stepped = go({}, seconds=0.1).console.step, []

    def step(previous: Row, row: Row, parameters: Row, ground: Row, substeps: int) -> None:
        stepped.append(substeps)
        own(previous, row, parameters, ground, substeps)

    paused = go({(5, 1): Event.PAUSE, (6, 400): Event.START}, seconds=0.2, step=step)
    assert paused.looks[6] == 401
    assert len(stepped) == len(paused.vectors) == 50
    assert paused.replayed()


def test_a_pause_without_a_start_ends_with_the_drive(go: Callable[..., Driven]) -> None:
    paused = go({(100, 1): Event.PAUSE})
    assert len(paused.vectors) == 100


def test_what_is_asked_for_while_time_stands_acts_in_the_next_tick(go: Callable[..., Driven]) -> None:
    plan = {**ENGAGE, (1000, 1): Event.PAUSE, (1001, 5): Event.EMERGENCY_STOP, (1001, 9): Event.START}
    driven = go(plan)
    assert driven.at(1001).arbitration.mode == Mode.EMERGENCY_STOP
    assert driven.at(1001).events.events == Event.START | Event.EMERGENCY_STOP


def test_a_drive_can_wait_for_its_start(go: Callable[..., Driven]) -> None:
    driven = go({(2, 30): Event.START}, on_request=True)
    assert driven.at(1).events.events == Event.PAUSE
    assert driven.at(2).events.events == Event.START
    assert driven.looks[2] == 31


def test_the_wheels_button_pauses_and_starts(go: Callable[..., Driven]) -> None:
    driven = go({(1002, 7): Event.START}, "  - {time_s: 4.0, press: [pause]}\n")
    assert driven.at(1001).events.events == Event.PAUSE, "the tick after the press is the last one"
    assert driven.at(1002).events.events == Event.START


def test_back_to_the_start_from_speed_and_on_again(go: Callable[..., Driven]) -> None:
    driven = go({**ENGAGE, (1000, 1): Event.RESTART, (1300, 1): Event.REQUEST_AUTONOMOUS})
    before, after = driven.at(999), driven.at(1000)
    assert before.vehicle.vx_mps > 0.5
    assert after.arbitration.restarted == 1.0
    assert (after.vehicle.x_m, after.vehicle.vx_mps, after.vehicle.distance_m) == (0.0, 0.0, 0.0)
    assert after.arbitration.mode in (Mode.PARKED, Mode.MANUAL)
    assert (after.command.throttle, driven.at(1001).arbitration.restarted) == (0.0, 0.0)
    assert driven.at(1300).arbitration.mode == Mode.AUTONOMOUS
    assert driven.at(2000).vehicle.x_m > 0.5
    assert driven.replayed()


@pytest.mark.parametrize(
    ("points", "plan", "reason"),
    [
        ("  - {time_s: 2.0, hand_wheel_deg: 0}\n  - {time_s: 3.0, hand_wheel_deg: 6}\n", {}, "WHEEL_NOT_CENTRED"),
        ("  - {time_s: 2.0, brake: 0}\n  - {time_s: 3.0, brake: 0.1}\n", {}, "PEDAL_PRESSED"),
        ("  - {time_s: 2.0, throttle: 0}\n  - {time_s: 3.0, throttle: 0.1}\n", {}, "PEDAL_PRESSED"),
        ("  - {time_s: 2.0, clutch: 0}\n  - {time_s: 3.0, clutch: 0.1}\n", {}, "PEDAL_PRESSED"),
        ("", {(900, 1): Event.EMERGENCY_STOP}, "EMERGENCY"),
    ],
)
def test_the_wheel_is_centred_and_the_pedals_are_released_first(
    go: Callable[..., Driven], points: str, plan: dict[tuple[int, int], Event], reason: str
) -> None:
    driven = go({(1000, 1): Event.RESTART, **plan}, points, seconds=14.5)
    end = 1000 if plan else 1000 + 10 * HZ
    assert driven.column("arbitration.restarted").sum() == 0.0
    assert (driven.column("arbitration.notice")[999 : end - 1] > 0.0).all(), "waited for"
    after = driven.at(end)
    assert (Reason(int(after.arbitration.refusal)), after.arbitration.notice) == (Reason[f"REFUSED_{reason}"], 0.0)
    assert driven.at(end + 10).arbitration.refusal == after.arbitration.refusal, "shown for a while"
    assert driven.replayed()


def test_a_restart_waits_for_the_pedals_and_is_replayed(go: Callable[..., Driven]) -> None:
    points = "  - {time_s: 3.0, brake: 0}\n  - {time_s: 3.5, brake: 0.5}\n"
    points += "  - {time_s: 5.0, brake: 0.5}\n  - {time_s: 5.5, brake: 0}\n"
    driven = go({(1000, 1): Event.RESTART}, points)
    (at,) = np.flatnonzero(driven.column("arbitration.restarted"))
    assert 5.0 * HZ < at < 5.6 * HZ
    assert (driven.column("arbitration.notice")[999:at] == Notice.RELEASE_PEDALS).all()
    assert driven.replayed()


def test_devices_read_while_time_stands_are_no_ticks(go: Callable[..., Driven]) -> None:
    driven = go({(100, 1): Event.PAUSE, (101, 50): Event.START}, seconds=1.0)
    assert len(driven.vectors) == HZ
    assert isinstance(driven.at(101).sample, DeviceSample)


class FailingRecorder(MemoryRecorder):
    """A recorder whose disk fails at one tick."""

    def __init__(self, ticks: int, width: int, fails_at: int) -> None:
        super().__init__(ticks, width)
        self._fails_at = fails_at

    def write(self, snapshot: Snapshot) -> int:
        super().write(snapshot)
        return int(Event.RECORDING_FAILED) if snapshot.tick >= self._fails_at else 0


def test_a_failed_recording_is_an_event_of_every_tick_after_it_and_changes_nothing_else() -> None:
    resolved = resolve(parse(SESSION, SessionProfile, "session"))
    console, state = assemble(resolved, compiled)
    rows = []
    for fails_at in (100, 10_000):
        recorder = FailingRecorder(300, console.width, fails_at)
        shown: list[Snapshot] = []
        output = SimpleNamespace(publish=shown.append)
        components = Components(NobodySeated(), Operator({(200, 1): Event.MARK}), recorder, (output,), UnpacedPacer())
        run(console, state, components, 300)
        rows.append(recorder.vectors)
        if fails_at == 100:
            assert [snapshot.tick for snapshot in shown if snapshot.recording_failed] == list(range(101, 301))
            assert [shown[at].notice for at in (99, 100)] == [Notice.NOT_ENGAGED, Notice.RECORDING_FAILED]
            assert shown[199].events.events == Event.RECORDING_FAILED | Event.MARK
    told = console.columns.index("events.events")
    assert np.array_equal(np.delete(rows[0], told, 1), np.delete(rows[1], told, 1), equal_nan=True)
