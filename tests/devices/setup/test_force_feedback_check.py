"""Feeling the forces, on a simulated wheel: what it does by itself is measured, what it does not is asked."""

from collections.abc import Callable

import msgspec
import numpy as np
import pytest

from simconsole.devices.force_feedback.motor import SimulatedWheelPort
from simconsole.devices.force_feedback.rim import Rim
from simconsole.devices.setup.device_commands import Pace
from simconsole.devices.setup.force_feedback_check import FORCES, Force, check_force_feedback
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError
from simconsole.values.units import DEG_PER_RAD, RAD_PER_DEG
from tests.devices.benched_wheel import TICK_HZ, BenchedWheel
from tests.devices.hands_off import ENDS, draws
from tests.samples import Sample

pytestmark = pytest.mark.usefixtures("sdl")


def at_once(tick_hz: int) -> Pace:
    return lambda tick: None


class Person:
    def __init__(self, answer: str = "y") -> None:
        self.answer = answer
        self.asked: list[str] = []
        self.announced: list[str] = []

    def __call__(self, question: str) -> str:
        if "Enter starts it" in question:
            self.announced.append(question.partition(":")[0])
            return ""
        self.asked.append(question.partition(":")[0])
        return self.answer


def quiet(line: str) -> None:
    return


def test_good_wheel_passes_and_pushes_are_measured_not_asked(t500: CockpitProfile) -> None:
    person = Person()
    found = check_force_feedback(t500, say=quiet, ask=person, virtual=True, pace=at_once)
    assert found["ok"]
    assert list(found["forces"]) == ["sign", "right", "let go", *(force.name for force in FORCES)]
    assert person.announced == list(found["forces"]), "Enter comes before each of them"
    assert person.asked == ["texture", "damping", "friction", "centre"]
    assert 0.5 <= found["forces"]["sign"]["turned_deg"] <= 12.0
    assert -12.0 <= found["forces"]["right"]["turned_deg"] <= -0.5


def test_force_that_is_not_felt_fails(t500: CockpitProfile) -> None:
    found = check_force_feedback(t500, say=quiet, ask=Person("n"), virtual=True, pace=at_once)
    assert not found["ok"]
    assert found["forces"]["sign"]["ok"]
    assert not found["forces"]["texture"]["ok"]


def test_wrong_sign_is_found_first_named_and_nothing_else_is_tried(
    t500: CockpitProfile, monkeypatch: pytest.MonkeyPatch
) -> None:
    write = SimulatedWheelPort.write
    monkeypatch.setattr(SimulatedWheelPort, "write", lambda port, level: write(port, -level))
    said: list[str] = []
    found = check_force_feedback(t500, say=said.append, ask=Person(), virtual=True, pace=at_once)
    assert not found["ok"]
    assert list(found["forces"]) == ["sign"]
    assert "force_feedback.level_pushes: value left: right; this motor pushes the other way" in said


def test_profile_of_a_motor_that_pushes_the_other_way_passes(t500: CockpitProfile) -> None:
    assert t500.force_feedback is not None
    force = msgspec.structs.replace(t500.force_feedback, level_pushes="right")
    cockpit = msgspec.structs.replace(t500, force_feedback=force)
    assert check_force_feedback(cockpit, say=quiet, ask=Person(), virtual=True, pace=at_once)["ok"]


def test_effect_that_does_not_end_by_itself_is_found(t500: CockpitProfile, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(SimulatedWheelPort, "start", lambda port: port._wheel.run(3600.0))
    found = check_force_feedback(t500, say=quiet, ask=Person(), virtual=True, pace=at_once)
    assert not found["forces"]["let go"]["ok"]
    assert not found["ok"]


def test_wheel_without_a_motor_is_said(t500: CockpitProfile) -> None:
    with pytest.raises(DeviceError, match="force_feedback: value missing"):
        check_force_feedback(load("devices", "gamepad", CockpitProfile), say=quiet, virtual=True)
    with pytest.raises(DeviceError, match=r"0\.05 to 0\.6"):
        check_force_feedback(t500, say=quiet, virtual=True, strength=0.9)


def test_nobody_there_to_answer_is_one_line_and_leaves_no_force(t500: CockpitProfile) -> None:
    def nobody(question: str) -> str:
        raise EOFError

    with pytest.raises(DeviceError, match="an answer to every question"):
        check_force_feedback(t500, say=quiet, ask=nobody, virtual=True, pace=at_once)


def test_each_force_is_counted_down(t500: CockpitProfile) -> None:
    said: list[str] = []
    check_force_feedback(t500, say=said.append, ask=Person(), virtual=True, pace=at_once)
    starts = [index for index, line in enumerate(said) if line == "3"]
    assert len(starts) == 7
    assert all(said[index : index + 3] == ["3", "2", "1"] for index in starts)


def test_any_key_ends_it_at_once_without_a_force(t500: CockpitProfile, monkeypatch: pytest.MonkeyPatch) -> None:
    levels: list[float] = []
    write = SimulatedWheelPort.write

    def noted(port: SimulatedWheelPort, level: float) -> None:
        levels.append(level)
        write(port, level)

    monkeypatch.setattr(SimulatedWheelPort, "write", noted)
    said: list[str] = []
    with pytest.raises(KeyboardInterrupt):
        check_force_feedback(
            t500, say=said.append, ask=Person(), virtual=True, pace=at_once, pressed=lambda: any(levels)
        )
    assert levels[-2] != 0.0 == levels[-1]
    assert said[-1] == "A key was pressed: the wheel is let go, and that was all."


def test_a_wheel_that_runs_away_is_let_go(t500: CockpitProfile, monkeypatch: pytest.MonkeyPatch) -> None:
    write = SimulatedWheelPort.write
    monkeypatch.setattr(SimulatedWheelPort, "write", lambda port, level: write(port, 1.0 if level else 0.0))
    with pytest.raises(DeviceError, match="beyond 12 deg by itself"):
        check_force_feedback(t500, say=quiet, ask=Person(), virtual=True, pace=at_once)


@pytest.mark.parametrize("kind", FORCES, ids=lambda kind: kind.name)
@pytest.mark.parametrize("name", ["t500rs_th8rs", "t300rs_th8a", "g29"])
def test_hands_that_let_go_of_a_force_leave_a_slow_wheel(
    name: str, kind: Force, sample: Sample, record_property: Callable[[str, object], None]
) -> None:
    """Somebody turns the wheel, as it is asked for, and lets go of it: it never is faster than 120 deg/s."""
    force = load("devices", name, CockpitProfile).force_feedback
    assert force is not None
    fastest_degps = 0.0
    for draw in (*ENDS[4:8], *draws(np.random.default_rng(sample.seed), sample.of(1, 200))):
        for start_deg in (0.0, 30.0, 400.0):
            wheel = BenchedWheel(force, draw)
            wheel.rim = Rim(start_deg * RAD_PER_DEG, 0.0)
            played(wheel, kind, force)
            fastest_degps = max(fastest_degps, wheel.fastest_radps * DEG_PER_RAD)
            assert fastest_degps <= 120.0, (draw, start_deg)
    record_property(f"let go of, {kind.name}, {name}", f"{fastest_degps:.0f} deg/s")


def played(wheel: BenchedWheel, kind: Force, force: ForceFeedback) -> None:
    """Play a force as `WheelBench.play` does."""
    rad, radps, inertia_kgm2 = wheel.rim.rad, 0.0, force.motor.inertia_kgm2
    for tick in range(1, round(kind.length_s * TICK_HZ) + 1):
        before, rad = rad, wheel.turn(kind.torque(tick / TICK_HZ, rad, radps, inertia_kgm2))
        radps += 0.5 * ((rad - before) * TICK_HZ - radps)
