"""A profile's force feedback as plain numbers: times mean the same at every tick rate."""

import math

import msgspec
import pytest

from simconsole.devices.force_feedback.force_settings import OBSERVER_RADPS, ForceSettings, force_settings
from simconsole.profiles.device import CockpitProfile

LOCK_RAD, RATIO = math.radians(36.0), 15.5


def settings(profile: CockpitProfile, tick_hz: int = 250, lock_rad: float = LOCK_RAD) -> ForceSettings:
    return force_settings(profile, RATIO, lock_rad, tick_hz)


def test_end_stop_stands_at_the_first_of_the_two_locks(t500: CockpitProfile) -> None:
    assert settings(t500).end_stop_rad == pytest.approx(math.radians(540.0 - 20.0)), "the wheel's own, less its margin"
    assert settings(t500, lock_rad=0.2).end_stop_rad == pytest.approx(0.2 * RATIO), "the car's"


@pytest.mark.parametrize("tick_hz", [50, 250, 1000])
def test_times_are_the_same_at_every_rate(tick_hz: int, t500: CockpitProfile) -> None:
    force, found = t500.force_feedback, settings(t500, tick_hz)
    assert force is not None
    assert found.ramp_per_tick * tick_hz * force.ramp_s == pytest.approx(1.0)
    assert found.slew_nm * tick_hz == pytest.approx(force.slew_nmps)
    assert 0.0 < found.motor_lag_share < 1.0
    # The lag of a first order: after its delay 1 - 1 / e of the way, to the accuracy of ticks.
    left = (1.0 - found.motor_lag_share) ** (force.motor.delay_s * tick_hz)
    assert left == pytest.approx(math.exp(-1.0), abs=0.22 if tick_hz == 50 else 0.06)


@pytest.mark.parametrize("tick_hz", [50, 250, 1000])
def test_observer_follows_a_steady_acceleration_without_error(tick_hz: int, t500: CockpitProfile) -> None:
    """Three equal poles at exp(-w T): a parabola is tracked exactly in the end, and at that pace."""
    found, tick_s = settings(t500, tick_hz), 1.0 / tick_hz
    angle = rate = accel = 0.0
    for tick in range(1, round(40.0 / OBSERVER_RADPS * tick_hz) + 1):
        angle += rate * tick_s + 0.5 * accel * tick_s * tick_s
        rate += accel * tick_s
        error = 0.5 * 3.0 * (tick * tick_s) ** 2 - angle
        angle += found.observer_angle * error
        rate += found.observer_rate_per_s * error
        accel += found.observer_accel_per_s2 * error
    assert accel == pytest.approx(3.0, rel=1e-6)


def test_without_lag_the_motor_is_there_at_once(t500: CockpitProfile) -> None:
    assert t500.force_feedback is not None
    motor = msgspec.structs.replace(t500.force_feedback.motor, delay_s=0.0)
    prompt = msgspec.structs.replace(t500, force_feedback=msgspec.structs.replace(t500.force_feedback, motor=motor))
    assert settings(prompt).motor_lag_share == 1.0
