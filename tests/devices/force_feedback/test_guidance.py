"""Haptic guidance: the law itself, its bound, and what hands feel while control is shared in a whole drive."""

import math
from collections.abc import Callable

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from simconsole.devices.force_feedback.force_settings import ForceSettings, force_settings
from simconsole.devices.force_feedback.guidance import GuidanceReference, guidance, guidance_reference
from simconsole.devices.force_feedback.rim import Rim
from simconsole.devices.force_feedback.simulated_wheel import FIRM, HANDS_OFF, RELAXED, Arm
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.force_feedback import Guidance
from simconsole.values.host.jit import compiled
from simconsole.values.signals import Event, EventInput, Mode
from simconsole.values.state_vector import Snapshot
from tests.devices.closed_loop import Loop

RATIO = 15.5
NUMBERS = st.floats(-10.0, 10.0)


def settings(**changes: float) -> ForceSettings:
    cockpit = load("devices", "t500rs_th8rs", CockpitProfile)
    assert cockpit.force_feedback is not None
    force = msgspec.structs.replace(cockpit.force_feedback, guidance=Guidance(**changes))
    return force_settings(msgspec.structs.replace(cockpit, force_feedback=force), RATIO, 0.62, 250)


def test_torque_is_the_law_of_four_design_choices() -> None:
    force = settings(support=0.5, feedback=2.0, authority_nm_per_rad=3.0, stiffness_nm_per_rad=1.5, damping_nms=0.0)
    now, rim = GuidanceReference(0.30, 0.20), Rim(0.25, 0.7)
    want = 0.5 * 1.5 * 0.20 + 2.0 * 1.5 * 0.10 + 3.0 * (0.30 - 0.25)
    assert guidance(now, rim, 1.0, 1.0, force) == pytest.approx(want)
    assert guidance(now, rim, 1.0, 0.4, force) == pytest.approx(0.4 * want), "in step with its authority"
    standing = guidance(now, rim, 0.0, 1.0, force)
    assert standing == pytest.approx(3.0 * 0.05), "no car torque to carry while standing"


def test_no_gain_no_torque_and_no_authority_no_guidance() -> None:
    mute = settings(support=0.0, feedback=0.0, authority_nm_per_rad=0.0, damping_nms=0.0)
    assert guidance(GuidanceReference(1.0, 0.5), Rim(0.0, 0.0), 1.0, 1.0, mute) == 0.0
    assert guidance(GuidanceReference(1.0, 0.5), Rim(0.0, 0.0), 1.0, 0.0, settings()) == 0.0


FAST = compiled(guidance)


@given(NUMBERS, NUMBERS, NUMBERS, NUMBERS, st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_guidance_is_bounded_odd_and_equal_in_both_executions(
    rad: float, slow: float, at: float, rate: float, rolling: float, share: float
) -> None:
    force = settings()
    torque = guidance(GuidanceReference(rad, slow), Rim(at, rate), rolling, share, force)
    assert abs(torque) <= share * force.guide_most_nm
    assert torque == -guidance(GuidanceReference(-rad, -slow), Rim(-at, -rate), rolling, share, force)
    assert torque == FAST(GuidanceReference(rad, slow), Rim(at, rate), rolling, share, force)


def test_slow_part_begins_at_the_reference_and_takes_its_time() -> None:
    force, shared = settings(slow_s=0.8), float(Mode.SHARED)
    now = guidance_reference(0.02, 5.0, float(Mode.MANUAL), force, 0.004)
    assert now.rad == now.slow_rad == pytest.approx(0.31)
    for _ in range(200):
        now = guidance_reference(0.03, now.slow_rad, shared, force, 0.004)
    assert now.slow_rad == pytest.approx(0.31 + 0.155 * (1.0 - math.exp(-1.0)), rel=0.01)


def shared_loop() -> Loop:
    """Driving by the controller for some seconds, then shared."""
    loop = Loop()
    loop.engage()
    for _ in loop.seconds(18.0):
        loop.tick(HANDS_OFF)
    loop.tick(HANDS_OFF, events=EventInput(float(Event.REQUEST_SHARED)))
    assert loop.snapshot.arbitration.mode == Mode.SHARED, loop.snapshot.arbitration
    return loop


def drive_on(loop: Loop, arm: Arm, hands_rad: float | None = None) -> Snapshot:
    """One tick with the person's foot holding the speed: shared control leaves it to them."""
    slow = loop.snapshot.vehicle.vx_mps < 8.0
    return loop.tick(arm, hands_rad, throttle_axis=0.4 if slow else 1.0)


def test_hands_that_let_go_are_led_round_the_bends(record_property: Callable[[str, object], None]) -> None:
    loop = shared_loop()
    misses, bends = [], []
    for _ in loop.seconds(20.0):
        shot = drive_on(loop, HANDS_OFF)
        assert shot.arbitration.mode == Mode.SHARED
        reference = RATIO * shot.arbitration.remote_road_wheel_rad
        misses.append(abs(shot.driver.hand_wheel_rad - reference))
        bends.append(abs(reference))
    assert max(bends) > math.radians(30.0), "real bends"
    assert sum(misses) / len(misses) < 0.5 * sum(bends) / len(bends)
    record_property(
        "guided wheel",
        f"mean miss {math.degrees(sum(misses) / len(misses)):.1f} deg of "
        f"{math.degrees(sum(bends) / len(bends)):.1f} deg mean bend, nobody at it",
    )


def test_hands_that_hold_on_feel_the_controller_and_win() -> None:
    loop = shared_loop()
    held = loop.wheel.state.rad
    strongest = 0.0
    cars = []
    for _ in loop.seconds(25.0):
        shot = drive_on(loop, FIRM, held)
        force = shot.torque.guide_nm
        wish = RATIO * shot.arbitration.remote_road_wheel_rad - shot.driver.hand_wheel_rad
        if abs(wish) > math.radians(25.0):
            assert force * wish > 0.0, "felt towards where the controller wants the wheel"
            cars.append(math.copysign(shot.torque.car_nm, shot.torque.car_nm * wish))
        strongest = max(strongest, abs(force))
        assert abs(loop.wheel.state.rad - held) < math.radians(25.0), "and no stronger than a person"
        if shot.arbitration.mode != Mode.SHARED:
            break
    assert 0.5 < strongest <= 2.0
    assert len(cars) > 500
    assert max(cars) <= 0.1, "the car itself pulls back: guidance alone is bounded, so alone guides"


def test_guidance_is_only_in_shared_control() -> None:
    loop = Loop()
    loop.engage()
    for _ in loop.seconds(8.0):
        assert loop.tick(HANDS_OFF).torque.guide_nm == 0.0


@pytest.mark.parametrize("arm", [HANDS_OFF, RELAXED, FIRM], ids=["off", "relaxed", "firm"])
def test_persons_torque_is_estimated_while_guided(arm: Arm, record_property: Callable[[str, object], None]) -> None:
    """Where it matters most: motor and hands at the same wheel. `FIRM` hands steer the bends a little aside."""
    loop = shared_loop()
    squares, count = 0.0, 0
    for _ in loop.seconds(20.0):
        aside = math.radians(4.0) * math.sin(3.0 * loop.snapshot.t_s)
        target = RATIO * loop.snapshot.arbitration.remote_road_wheel_rad + aside if arm is FIRM else None
        shot = drive_on(loop, arm, target)
        squares += (shot.torque.human_nm - loop.wheel.state.human_nm) ** 2
        count += 1
    rms_nm = math.sqrt(squares / count)
    record_property("human torque estimate while guided", f"{rms_nm:.3f} N m RMS")
    assert rms_nm <= 0.3
