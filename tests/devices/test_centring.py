"""Back to the start with a wheel that has a motor: centred first, then the pedals, then the start."""

import math
from collections.abc import Callable

import pytest

from simconsole.devices.force_feedback.simulated_wheel import FIRM, HANDS_OFF, RELAXED, STEERING, Arm
from simconsole.values.signals import Event, EventInput, Mode, Notice, Reason
from simconsole.values.state_vector import Snapshot
from tests.devices.closed_loop import Loop

RESTART = EventInput(float(Event.RESTART))


@pytest.fixture
def loop() -> Loop:
    """A person at the standing car, the wheel turned 90 deg to the left."""
    loop = Loop()
    for _ in loop.seconds(1.0):
        loop.tick(STEERING, math.radians(90.0))
    assert loop.snapshot.arbitration.mode == Mode.MANUAL
    assert loop.snapshot.driver.hand_wheel_rad > math.radians(80.0)
    return loop


def pressed_brake(loop: Loop) -> float:
    """The raw axis of a brake that is pressed half way."""
    brake = loop.session.cockpit.pedals.brake
    return 0.5 * (brake.rest_raw + brake.full_raw)


@pytest.mark.parametrize("arm", [HANDS_OFF, RELAXED], ids=["hands off", "hands rest on it"])
def test_the_motor_centres_the_wheel_then_the_drive_starts_again(
    arm: Arm, loop: Loop, record_property: Callable[[str, object], None]
) -> None:
    shots = [loop.tick(arm, events=RESTART)]
    while not shots[-1].arbitration.restarted and len(shots) < 5 * loop.tick_hz:
        shots.append(loop.tick(arm))
    assert shots[-1].arbitration.restarted
    assert abs(shots[-1].driver.hand_wheel_rad) <= math.radians(5.0)
    assert {shot.arbitration.notice for shot in shots[:-1]} == {float(Notice.CENTRING_WHEEL)}
    assert max(abs(shot.torque.torque_nm) for shot in shots) <= loop.force.max_torque_nm
    assert max(abs(shot.driver.hand_wheel_radps) for shot in shots) < math.radians(200.0)
    record_property("centring", f"90 deg in {len(shots) / loop.tick_hz:.2f} s")


def test_pressed_pedals_are_waited_for_with_the_wheel_held(loop: Loop) -> None:
    brake = pressed_brake(loop)
    loop.tick(HANDS_OFF, events=RESTART, brake_axis=brake)
    shots = [loop.tick(HANDS_OFF, brake_axis=brake) for _ in loop.seconds(4.0)]
    assert shots[-1].arbitration.notice == Notice.RELEASE_PEDALS
    assert abs(shots[-1].driver.hand_wheel_rad) <= math.radians(5.0)
    assert loop.tick(HANDS_OFF).arbitration.restarted


def test_hands_that_hold_the_wheel_win_and_the_restart_is_refused(loop: Loop) -> None:
    loop.tick(FIRM, math.radians(90.0), RESTART)
    shots = [loop.tick(FIRM, math.radians(90.0)) for _ in loop.seconds(10.0)]
    assert not any(shot.arbitration.restarted for shot in shots)
    assert shots[-1].arbitration.refusal == Reason.REFUSED_WHEEL_NOT_CENTRED
    assert max(abs(shot.torque.torque_nm) for shot in shots) < loop.force.max_torque_nm


def test_a_wheel_without_a_motor_is_centred_by_the_person(loop: Loop) -> None:
    loop.tick(HANDS_OFF, wheel_motor=0.0)
    first = loop.tick(HANDS_OFF, events=RESTART, wheel_motor=0.0)
    assert (first.arbitration.notice, first.torque.enabled) == (Notice.CENTRE_WHEEL, 0.0)
    shots: list[Snapshot] = []
    for tick in loop.seconds(2.0):
        shots.append(loop.tick(STEERING, max(0.0, math.radians(90.0) - tick / loop.tick_hz), wheel_motor=0.0))
        if shots[-1].arbitration.restarted:
            break
    assert shots[-1].arbitration.restarted


def test_the_motor_never_centres_a_wheel_that_steers_a_moving_car() -> None:
    loop = Loop()
    loop.engage()
    while abs(loop.snapshot.driver.hand_wheel_rad) < math.radians(20.0):
        loop.tick(HANDS_OFF)
        assert loop.snapshot.t_s < 60.0, "the course has bends"
    assert loop.snapshot.vehicle.vx_mps > 1.0
    shot = loop.tick(HANDS_OFF, events=RESTART)
    assert (shot.arbitration.mode, shot.arbitration.notice) == (Mode.AUTONOMOUS, Notice.NONE)
    assert shot.arbitration.refusal == Reason.REFUSED_WHEEL_NOT_CENTRED
