"""The wheel that is not there: motor, delay, lock, and the arms that hold it."""

import math
import random

import pytest

from simconsole.devices.force_feedback.simulated_wheel import (
    FIRM,
    HANDS_OFF,
    RELAXED,
    STEERING,
    Arm,
    SimulatedWheel,
    WheelBody,
    WheelState,
    step_wheel,
)
from simconsole.profiles.force_feedback import ForceFeedback, Motor
from simconsole.values.host.jit import compiled

FORCE = ForceFeedback(max_torque_nm=4.0, motor=Motor(delay_s=0.012))
HZ = 250


@pytest.fixture
def wheel() -> SimulatedWheel:
    return SimulatedWheel(FORCE, 1080.0, tick_hz=HZ)


def push(
    wheel: SimulatedWheel, level: float, ticks: int, arm: Arm = HANDS_OFF, hands_rad: float | None = None
) -> float:
    angle_rad = 0.0
    for _ in range(ticks):
        wheel.write(level)
        wheel.run(0.2)
        angle_rad = wheel.turn(arm, hands_rad)
    return angle_rad


def test_positive_level_turns_left_and_comes_late(wheel: SimulatedWheel) -> None:
    assert push(wheel, 1.0, 3) == 0.0, "12 ms on the way"
    assert push(wheel, 1.0, 10) > 0.01
    other = SimulatedWheel(ForceFeedback(max_torque_nm=4.0, level_pushes="right"), 1080.0, tick_hz=HZ)
    assert push(other, 1.0, 20) < -0.01


def test_lock_stops_the_wheel(wheel: SimulatedWheel) -> None:
    assert push(wheel, 1.0, 500) == pytest.approx(math.radians(540.0))
    assert wheel.state.radps == 0.0


def test_smallest_step_of_the_motor_is_lost_in_friction(wheel: SimulatedWheel) -> None:
    assert push(wheel, 6 / 127, 200) == 0.0
    assert push(wheel, 8 / 127, 200) > 0.0


@pytest.mark.parametrize(("arm", "yields_deg"), [(RELAXED, 1e9), (FIRM, 16.0), (STEERING, 5.0)])
def test_arms_yield_as_they_are_stiff(arm: Arm, yields_deg: float, wheel: SimulatedWheel) -> None:
    angle = push(wheel, 1.0, 250, arm, None if arm is RELAXED else 0.0)
    assert 2.0 < math.degrees(abs(angle)) < yields_deg
    if arm is RELAXED:
        assert math.degrees(angle) > 60.0, "resting hands go along"


def test_steering_hands_bring_the_wheel_where_they_want_it(wheel: SimulatedWheel) -> None:
    angle = push(wheel, 0.0, 250, STEERING, 1.0)
    assert angle == pytest.approx(1.0, abs=0.01)
    assert abs(wheel.state.human_nm) < 0.3


def test_hands_are_as_strong_as_their_limit(wheel: SimulatedWheel) -> None:
    push(wheel, 0.0, 1, FIRM, 9.0)
    body = wheel._body
    state = step_wheel(WheelState(0.0, 0.0, 0.0, 9.0, 0.0), 0.0, FIRM._replace(inertia_kgm2=0.0), body, 1)
    assert state.human_nm == FIRM.limit_nm


def test_both_executions_agree() -> None:
    dice, fast = random.Random(3), compiled(step_wheel)
    print("seed 3")
    body = WheelBody(0.05, 0.03, 0.2, 9.4)
    state = WheelState(0.0, 0.0, 0.0, 0.0, 0.0)
    for _ in range(2000):
        arm = dice.choice([HANDS_OFF, RELAXED, FIRM, STEERING])
        state = state._replace(hands_rad=dice.uniform(-9.0, 9.0))
        asked = dice.uniform(-4.0, 4.0)
        quick, slow = fast(state, asked, arm, body, 4), step_wheel(state, asked, arm, body, 4)
        assert tuple(map(float.hex, quick)) == tuple(map(float.hex, slow))
        state = slow
