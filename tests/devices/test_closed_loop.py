"""Torque out, angle in: the console, a controller on the urban course, and a simulated wheel with arms at it."""

import math
from collections.abc import Callable

import pytest

from simconsole.devices.force_feedback.simulated_wheel import FIRM, HANDS_OFF, RELAXED, STEERING, Arm
from simconsole.profiles.force_feedback import Motor
from simconsole.values.signals import Mode, Reason
from tests.devices.closed_loop import MODE_AT, Loop
from tests.samples import Sample

RATIO = 15.5


def test_autonomy_with_resting_hands_is_no_takeover(sample: Sample) -> None:
    """The motor moves the wheel through a lap, 13 in the long run; nothing of it may count as the person's."""
    loop, length_s = Loop(100), sample.of(330, 3600)
    loop.engage()
    turned_rad = 0.0
    for _ in loop.seconds(length_s):
        shot = loop.tick(RELAXED)
        turned_rad = max(turned_rad, abs(loop.wheel.state.rad))
        if shot.vector[MODE_AT] != Mode.AUTONOMOUS:
            break
    assert shot.arbitration.mode == Mode.AUTONOMOUS, f"lost after {shot.t_s} s"
    assert shot.vehicle.distance_m > length_s * 30_000.0 / 3600.0
    assert turned_rad > math.radians(150.0), "the wheel was moved far beyond the take-over threshold"


@pytest.mark.parametrize(
    "motor",
    [
        Motor(inertia_kgm2=0.065, damping_nms=0.06, friction_nm=0.35, delay_s=0.02),
        Motor(inertia_kgm2=0.035, damping_nms=0.01, friction_nm=0.1, delay_s=0.004),
    ],
    ids=["heavy and late", "light and quick"],
)
def test_wheel_that_is_not_as_its_profile_says_is_no_takeover(motor: Motor) -> None:
    loop = Loop(motor=motor)
    loop.engage()
    for _ in loop.seconds(300.0):
        if loop.tick(RELAXED).vector[MODE_AT] != Mode.AUTONOMOUS:
            break
    assert loop.snapshot.arbitration.mode == Mode.AUTONOMOUS, f"lost after {loop.snapshot.t_s} s"
    assert loop.snapshot.vehicle.distance_m > 2600.0


def test_controller_that_steers_in_jerks_is_no_takeover() -> None:
    """Steps of up to 20 deg at the hand wheel, at the gate's rate limit; the hands are only dragged along."""
    loop = Loop(grid_m=1.0)
    loop.engage()
    for _ in loop.seconds(300.0):
        if loop.tick(RELAXED).vector[MODE_AT] != Mode.AUTONOMOUS:
            break
    assert loop.snapshot.arbitration.mode == Mode.AUTONOMOUS, f"lost after {loop.snapshot.t_s} s"


def test_with_nobody_at_it_the_wheel_follows_the_road_wheels() -> None:
    loop = Loop()
    loop.engage()
    worst_rad = 0.0
    for _ in loop.seconds(90.0):
        shot = loop.tick(HANDS_OFF)
        worst_rad = max(worst_rad, abs(shot.driver.hand_wheel_rad - RATIO * shot.vehicle.road_wheel_rad))
    assert shot.arbitration.mode == Mode.AUTONOMOUS
    assert worst_rad < math.radians(5.0), math.degrees(worst_rad)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("start_s", [5.0, 24.0, 37.3])
def test_a_person_who_turns_the_wheel_takes_over(
    side: float, start_s: float, record_property: Callable[[str, object], None]
) -> None:
    """Pulled 20 deg aside of where the motor has it, at 120 deg/s, by steering hands: taken within 0.25 s.

    The hands need 0.1 s for 12 deg, the arms yield to the motor by a few deg, the detection holds for 50 ms.
    """
    loop = Loop()
    loop.engage()
    for _ in loop.seconds(start_s):
        loop.tick(RELAXED)
    began_s = loop.snapshot.t_s
    while loop.snapshot.arbitration.mode == Mode.AUTONOMOUS and loop.snapshot.t_s < began_s + 1.0:
        pulled = min(math.radians(20.0), math.radians(120.0) * (loop.snapshot.t_s - began_s))
        loop.tick(STEERING, RATIO * loop.snapshot.vehicle.road_wheel_rad + side * pulled)
    assert loop.snapshot.arbitration.mode == Mode.MANUAL
    assert loop.snapshot.arbitration.reason == Reason.STEERING_OVERRIDE
    assert loop.snapshot.t_s - began_s <= 0.25
    taken_ms = 1000.0 * (loop.snapshot.t_s - began_s)
    record_property("take-over against the motor", f"{taken_ms:.0f} ms after the hands began to turn")


def test_a_wheel_held_fast_is_taken_over_when_the_road_turns() -> None:
    loop = Loop()
    loop.engage()
    held = loop.wheel.state.rad
    for _ in loop.seconds(60.0):
        if loop.tick(FIRM, held).arbitration.mode != Mode.AUTONOMOUS:
            break
    assert loop.snapshot.arbitration.reason == Reason.STEERING_OVERRIDE


def test_a_motor_that_fails_in_autonomy_is_no_takeover() -> None:
    loop = Loop()
    loop.engage()
    for _ in loop.seconds(24.0):
        loop.tick(RELAXED)
    for _ in loop.seconds(5.0):
        shot = loop.tick(HANDS_OFF, wheel_motor=0.0)
        assert (shot.torque.torque_nm, shot.torque.enabled) == (0.0, 0.0)
    assert shot.arbitration.mode == Mode.AUTONOMOUS


def test_hands_on_and_off_are_told_apart_within_half_a_second(
    record_property: Callable[[str, object], None],
) -> None:
    """Hands that hold the wheel against the road's turning, and hands that are taken off again."""
    loop = Loop()
    loop.engage()
    for _ in loop.seconds(24.0):
        loop.tick(HANDS_OFF)
    assert loop.snapshot.torque.hands_on == 0.0
    hands = loop.wheel.state.rad
    said_on = next(t for t in loop.seconds(2.0) if loop.tick(FIRM, hands + math.radians(6.0)).torque.hands_on)
    for _ in loop.seconds(1.0):
        loop.tick(FIRM, loop.wheel.state.rad + math.radians(3.0))
    said_off = next(t for t in loop.seconds(2.0) if not loop.tick(HANDS_OFF).torque.hands_on)
    assert said_on / loop.tick_hz <= 0.5
    assert said_off / loop.tick_hz <= 0.5
    record_property("hands", f"on after {said_on / loop.tick_hz:.3f} s, off after {said_off / loop.tick_hz:.3f} s")


@pytest.mark.parametrize("arm", [HANDS_OFF, RELAXED, FIRM], ids=["off", "relaxed", "firm"])
def test_the_persons_torque_is_estimated_within_a_third_of_a_newton_metre(
    arm: Arm, record_property: Callable[[str, object], None]
) -> None:
    """While the motor drives the wheel round the course; `FIRM` hands lead it a few degrees aside, left and right."""
    loop = Loop()
    loop.engage()
    squares, count = 0.0, 0
    for _ in loop.seconds(60.0):
        aside = math.radians(4.0) * math.sin(3.0 * loop.snapshot.t_s)
        target = RATIO * loop.snapshot.vehicle.road_wheel_rad + aside if arm is FIRM else None
        shot = loop.tick(arm, target)
        squares += (shot.torque.human_nm - loop.wheel.state.human_nm) ** 2
        count += 1
    assert shot.arbitration.mode == Mode.AUTONOMOUS
    rms_nm = math.sqrt(squares / count)
    record_property("human torque estimate", f"{rms_nm:.3f} N m RMS")
    assert rms_nm <= 0.3


def test_the_wheel_never_swings_up_by_itself() -> None:
    """Loop stability: pushed aside while standing and while driving, the wheel comes to rest."""
    loop = Loop()
    loop.engage()
    for _ in loop.seconds(8.0):
        loop.tick(HANDS_OFF)
    loop.wheel.state = loop.wheel.state._replace(radps=1.0)
    rates = [abs((loop.tick(HANDS_OFF), loop.wheel.state.radps)[1]) for _ in loop.seconds(2.0)]
    assert max(rates[-loop.tick_hz // 2 :]) < 0.15
