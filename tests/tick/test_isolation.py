"""A part of a drive that raises falls silent; the others go on, and it is told once."""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

import numpy as np
import pytest

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.profiles.files.loader import parse
from simconsole.profiles.parts.script import ScriptProfile
from simconsole.profiles.session import SessionProfile
from simconsole.recording.bundles.log import LogWriter
from simconsole.recording.bundles.verification import verify
from simconsole.session.lifecycle import drive
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.resolution import override, resolve
from simconsole.tick.advance import ConsoleState
from simconsole.tick.assembly import assemble
from simconsole.tick.isolation import isolated
from simconsole.tick.loop import Components, come_to_rest, run
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import Row
from simconsole.values.signals import NO_COMMAND, NO_SAMPLE, Event, EventInput, Mode, Reason, RemoteCommand
from simconsole.values.state_vector import Snapshot


class Broken:
    def __init__(self) -> None:
        self.calls = 0

    def _fail(self) -> NoReturn:
        self.calls += 1
        raise RuntimeError("broken")

    def poll(self, tick: int) -> NoReturn:
        self._fail()

    def take(self, tick: int) -> NoReturn:
        self._fail()

    def publish(self, snapshot: Snapshot) -> NoReturn:
        self._fail()

    def write(self, snapshot: Snapshot) -> int:
        return 0

    def close(self) -> None:
        self.calls = -1


@pytest.mark.fault("P12")
def test_each_part_is_kept_from_the_others(capsys: pytest.CaptureFixture[str]) -> None:
    devices, ros, can, output = Broken(), Broken(), Broken(), Broken()
    components = isolated(Components(devices, ros, Broken(), [output], UnpacedPacer(), ecu=can), UnpacedPacer)
    taken = []
    for tick in (1, 2, 3):
        assert components.devices.poll(tick) == NO_SAMPLE
        taken.append((components.commands.take(tick), components.ecu.take(tick)))
        components.outputs[0].publish(Snapshot(tick, 250, NO_SAMPLE))  # type: ignore[arg-type]  # nobody looks at it
    assert [command for pair in taken for command, _ in pair] == [NO_COMMAND] * 6
    assert [events.events for pair in taken for _, events in pair] == [float(Event.COMMANDER_LOST)] * 2 + [0.0] * 4
    assert (devices.calls, ros.calls, can.calls, output.calls) == (3, 1, 1, 1), "devices may come back"
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 4
    assert told[0] == "simconsole: the cockpit failed: RuntimeError: broken"
    components.devices.close()
    assert devices.calls == -1


def test_an_interrupt_is_no_failure() -> None:
    class Interrupted(Broken):
        def take(self, tick: int) -> NoReturn:
            raise KeyboardInterrupt

    components = isolated(Components(Broken(), Interrupted(), Broken(), [], UnpacedPacer()), UnpacedPacer)
    with pytest.raises(KeyboardInterrupt):
        components.commands.take(1)


def test_what_nobody_reads_is_no_failure_of_the_drive(monkeypatch: pytest.MonkeyPatch) -> None:
    class Closed(io.StringIO):
        def write(self, text: str) -> NoReturn:
            raise BrokenPipeError

    monkeypatch.setattr("sys.stderr", Closed())
    assert (
        isolated(Components(Broken(), Broken(), Broken(), [], UnpacedPacer()), UnpacedPacer).devices.poll(1)
        == NO_SAMPLE
    )


HZ = 250
SESSION = "schema: 1\nscenario: {vehicle: hatchback}\ndevices: {driver: none}\n"
LAUNCH = """points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 0.3, clutch: 1, gear: 1}
  - {time_s: 0.8, clutch: 1, throttle: 0.35}
  - {time_s: 3.0, clutch: 0, throttle: 0.35}
"""
FAILS_AT = 5 * HZ
SECONDS = 12.0


class Failing:
    """A part that works until FAILS_AT and raises in each call from then on."""

    def __init__(self, recorder: MemoryRecorder | None = None) -> None:
        self.calls = self.raised = 0
        self._recorder = recorder

    def _call(self, due: bool) -> None:
        self.calls += 1
        if due:
            self.raised += 1
            raise RuntimeError("broken")

    def act(self, before: Snapshot) -> None:
        self._call(before.tick + 1 >= FAILS_AT)

    def wait(self) -> int:
        self._call(self.calls + 1 >= FAILS_AT)
        return 0

    def write(self, snapshot: Snapshot) -> int:
        self._call(snapshot.tick >= FAILS_AT)
        assert self._recorder is not None
        return self._recorder.write(snapshot)


class Person:
    """Drives off by a script."""

    def __init__(self) -> None:
        resolved = resolve(parse(SESSION, SessionProfile, "session"))
        self.console, self.state = assemble(resolved, compiled)
        script = parse(LAUNCH, ScriptProfile, "script")
        self.devices = ScriptSource(script, cockpit_settings(resolved.cockpit, HZ), tick_hz=HZ)
        self.recorder = MemoryRecorder(round(2 * SECONDS * HZ), self.console.width)
        self.stood: list[Snapshot] = []

    def components(self) -> Components:
        return Components(self.devices, Silent(), self.recorder, (), UnpacedPacer())

    def drive(self, components: Components, seconds: float = SECONDS) -> ConsoleState:
        components = isolated(components, UnpacedPacer)
        return run(self.console, self.state, components, round(seconds * HZ), lambda snapshot: len(self.stood) > 100)

    def column(self, name: str) -> np.ndarray:
        return self.recorder.vectors[: self.recorder.ticks, self.console.columns.index(name)]


class Silent:
    """Nobody on the ROS side; an operator pauses."""

    def __init__(self, pause_at: int = -1) -> None:
        self._pause_at = pause_at

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        return NO_COMMAND, EventInput(float(Event.PAUSE) if tick == self._pause_at else 0.0)


def told_once(capsys: pytest.CaptureFixture[str], part: str) -> None:
    told = [line for line in capsys.readouterr().err.splitlines() if "failed" in line]
    assert told == [f"simconsole: {part} failed: RuntimeError: broken"]


@pytest.mark.fault("P12")
def test_a_seat_that_raises_is_a_person_who_is_gone(capsys: pytest.CaptureFixture[str]) -> None:
    person, seat = Person(), Failing()
    person.drive(person.components()._replace(seat=seat))
    modes, speed = person.column("arbitration.mode"), person.column("vehicle.vx_mps")
    assert modes[FAILS_AT - 2] == Mode.MANUAL
    assert speed[FAILS_AT - 2] > 2.0, "the accelerator is down, and the script would keep it there"
    left = int(np.flatnonzero(modes[FAILS_AT - 1 :] != Mode.MANUAL)[0])
    assert left <= 0.1 * HZ + 1, "as with devices that are gone"
    assert modes[FAILS_AT - 1 + left] == Mode.MINIMAL_RISK
    assert person.column("arbitration.reason")[FAILS_AT - 1 + left] == Reason.DEVICE_LOST
    assert modes[-1] == Mode.STOPPED
    assert seat.raised == 1
    told_once(capsys, "the person in the seat")


@pytest.mark.fault("P12")
def test_a_pace_that_raises_is_a_loop_that_stood_still_and_another_goes_on(capsys: pytest.CaptureFixture[str]) -> None:
    person, pace = Person(), Failing()
    state = person.drive(person.components()._replace(pace=pace))
    assert state.tick == round(SECONDS * HZ)
    modes = person.column("arbitration.mode")
    assert modes[FAILS_AT - 2] == Mode.MANUAL
    assert modes[FAILS_AT - 1] == Mode.MINIMAL_RISK, "in the very tick"
    assert person.column("arbitration.reason")[FAILS_AT - 1] == Reason.LOOP_STALL
    assert modes[-1] in (Mode.STOPPED, Mode.MINIMAL_RISK)
    assert pace.raised == 1
    told_once(capsys, "the pace")


@pytest.mark.fault("P12")
def test_a_recorder_that_raises_ends_the_log_and_not_the_drive(capsys: pytest.CaptureFixture[str]) -> None:
    person = Person()
    recorder, seen, alarms = Failing(person.recorder), list[int](), list[int]()

    class Watcher:
        def publish(self, snapshot: Snapshot) -> None:
            seen.append(snapshot.tick)
            if int(snapshot.events.events) & Event.RECORDING_FAILED:
                alarms.append(snapshot.tick)

    state = person.drive(person.components()._replace(recorder=recorder, outputs=(Watcher(),)))
    assert state.tick == round(SECONDS * HZ) == seen[-1]
    assert person.recorder.ticks == FAILS_AT - 1, "a log with a hole would be worse"
    assert alarms == list(range(FAILS_AT + 1, state.tick + 1)), "from the next tick on"
    assert (recorder.raised, recorder.calls) == (1, FAILS_AT)
    told_once(capsys, "the recorder")


@pytest.mark.fault("P12")
def test_one_of_standby_that_raises_keeps_nobody_else_from_being_served(capsys: pytest.CaptureFixture[str]) -> None:
    person = Person()
    calls = []

    def broken(snapshot: Snapshot) -> NoReturn:
        calls.append(snapshot.tick)
        raise RuntimeError("broken")

    components = person.components()._replace(commands=Silent(pause_at=4 * HZ), standby=(broken, person.stood.append))
    person.drive(components)
    assert calls == [4 * HZ]
    assert len(person.stood) == 101
    told_once(capsys, broken.__qualname__)


@pytest.mark.fault("P11")
@pytest.mark.parametrize("seconds", [0.1, 5.0])
def test_a_drive_that_is_ended_comes_to_rest_in_the_log(seconds: float) -> None:
    person = Person()
    state = person.drive(person.components(), seconds)
    driven = state.tick
    state = come_to_rest(person.console, state, person.recorder)
    events = person.column("events.events").astype(int)
    assert np.flatnonzero(events & int(Event.END)).tolist() == [driven], "the tick after the last one driven"
    assert abs(person.column("vehicle.vx_mps")[-1]) <= 0.05
    assert bool(events[driven] & int(Event.EMERGENCY_STOP)) == (seconds > 1.0), "no stop where nothing moves"
    assert (state.tick - driven == 1) == (seconds < 1.0)
    if seconds > 1.0:
        assert set(person.column("arbitration.mode")[driven:]) == {Mode.EMERGENCY_STOP}
    assert not person.column("ros.sequence")[driven:].any()


def test_a_drive_without_a_tick_has_nothing_to_stop() -> None:
    person = Person()
    assert come_to_rest(person.console, person.state, person.recorder) == person.state
    assert person.recorder.ticks == 0


@pytest.mark.fault("P12")
def test_a_log_that_raises_is_a_recording_that_failed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    append = LogWriter.append

    def broken(log: LogWriter, tick: int, row: Row, messages: Sequence[tuple[str, bytes]] = ()) -> None:
        if tick == 100:
            raise RuntimeError("broken")
        append(log, tick, row, messages)

    def one_by_one(log: LogWriter, tick: int, vectors: Row, messages: Sequence[tuple[str, bytes]] = ()) -> int:
        log.append(tick, vectors[0], messages)
        return 1

    monkeypatch.setattr(LogWriter, "append", broken)
    monkeypatch.setattr(LogWriter, "append_block", one_by_one)
    session = override(parse(SESSION, SessionProfile, "session"), scenario={"duration_s": 1.0})
    session = override(session, outputs={"hud": None}, mode={"pacing": "free"})
    result = drive(resolve(session), tmp_path / "bundle")
    assert result.ticks == 99
    assert result.recording_failure == "RuntimeError: broken"
    assert verify(tmp_path / "bundle") == ["RuntimeError: broken"]
