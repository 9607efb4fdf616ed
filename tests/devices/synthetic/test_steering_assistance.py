"""Keys and sticks steer less and slower the faster the car is, and never more than the tyres hold."""

import math

import numpy as np
import pytest

from simconsole.devices.calibration.calibrator import wheel_angle
from simconsole.devices.calibration.cockpit_settings import CockpitSettings, cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.synthetic.steering_assistance import (
    Assistance,
    AssistedSource,
    assistance_of,
    limit_rad,
    rate_radps,
    turned,
)
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.signals import DeviceSample
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from simconsole.values.units import RAD_PER_DEG
from tests.devices.calibration_run import CalibrationRun

ASSISTANCE = Assistance(lock_rad=450.0 * RAD_PER_DEG, half_at_mps=5.6, full_s=1.0)
STEP_S = 0.004
SPEEDS = [0.0, 2.0, 5.6, 10.0, 20.0, 36.0, 60.0]


def moved(now_rad: float, deflection: float, speed_mps: float, seconds: float) -> float:
    for _ in range(round(seconds / STEP_S)):
        now_rad = turned(now_rad, deflection, speed_mps, ASSISTANCE, STEP_S)
    return now_rad


def test_angle_and_rate_fall_with_speed() -> None:
    limits = [limit_rad(speed, ASSISTANCE) for speed in SPEEDS]
    rates = [rate_radps(speed, ASSISTANCE) for speed in SPEEDS]
    assert limits == sorted(limits, reverse=True)
    assert rates == sorted(rates, reverse=True)
    assert limits[0] == ASSISTANCE.lock_rad
    assert limits[2] == pytest.approx(0.5 * ASSISTANCE.lock_rad)
    assert limit_rad(-10.0, ASSISTANCE) == limit_rad(10.0, ASSISTANCE)


@pytest.mark.parametrize("speed_mps", SPEEDS)
def test_a_held_key_goes_to_what_the_speed_allows_and_back_twice_as_fast(speed_mps: float) -> None:
    limit = limit_rad(speed_mps, ASSISTANCE)
    assert moved(0.0, 1.0, speed_mps, 0.5) == pytest.approx(0.5 * limit, rel=0.01)
    assert moved(0.0, 1.0, speed_mps, 3.0) == pytest.approx(limit)
    assert moved(0.0, -1.0, speed_mps, 3.0) == pytest.approx(-limit)
    assert moved(limit, 0.0, speed_mps, 0.24) > 0.0
    assert moved(limit, 0.0, speed_mps, 0.52) == 0.0


def test_a_wheel_beyond_what_the_speed_allows_comes_in_steadily() -> None:
    """The car gains speed, or a stick had it there: no jump, and no time beyond that of a key let go."""
    angle, limit = ASSISTANCE.lock_rad, limit_rad(20.0, ASSISTANCE)
    after = turned(angle, 1.0, 20.0, ASSISTANCE, STEP_S)
    assert 0.0 < angle - after < 0.01 * angle
    assert moved(angle, 1.0, 20.0, 2.0) == pytest.approx(limit)


def test_the_other_key_goes_through_the_middle() -> None:
    angles = [0.3]
    for _ in range(200):
        angles.append(turned(angles[-1], -1.0, 15.0, ASSISTANCE, STEP_S))
    assert angles == sorted(angles, reverse=True)
    assert 0.0 in angles
    assert angles[-1] < 0.0


@pytest.mark.parametrize("cockpit", ["keyboard", "gamepad"])
@pytest.mark.parametrize("car", ["hatchback", "light_van", "commonroad_bmw320i"])
def test_no_speed_lets_a_key_ask_for_more_than_the_tyres_hold(cockpit: str, car: str) -> None:
    """Even of a car that does not understeer at all: v^2 times the curvature of its wheels' geometry."""
    assistance = assistance_of(load("devices", cockpit, CockpitProfile).wheel)
    assert assistance is not None
    profile = load("vehicles", car, CarProfile)
    wheelbase_m = profile.body.wheelbase_m
    for speed_mps in np.linspace(0.0, 70.0, 141).tolist():
        road_wheel_rad = limit_rad(speed_mps, assistance) / profile.steering.ratio
        assert speed_mps**2 * math.tan(road_wheel_rad) / wheelbase_m < 7.0


def test_a_real_wheel_is_not_assisted(t500: CockpitProfile) -> None:
    assert assistance_of(t500.wheel) is None


class Stick:
    """A pad whose stick is somewhere."""

    closed = False

    def __init__(self, settings: CockpitSettings) -> None:
        self.settings, self.intent, self.axis = settings, Intent(), math.nan

    def poll(self, tick: int) -> DeviceSample:
        sample = raw_sample(self.intent, self.settings)
        return sample if math.isnan(self.axis) else sample._replace(wheel_axis=self.axis)

    def close(self) -> None:
        self.closed = True


def at_speed(speed_mps: float) -> Snapshot:
    vector = np.zeros(PLATFORM_AT)
    vector[LAYOUT.vehicle.start + LAYOUT.vehicle.names.index("vx_mps")] = speed_mps
    return Snapshot(1, 250, vector)


def test_a_pad_at_speed_turns_the_wheel_as_far_as_the_speed_allows() -> None:
    profile = load("devices", "gamepad", CockpitProfile)
    settings, assistance = cockpit_settings(profile, 250), assistance_of(profile.wheel)
    assert assistance is not None
    stick = Stick(settings)
    source, run = AssistedSource(stick, settings, assistance, tick_hz=250), CalibrationRun(settings)
    furthest_rad = wheel_angle(-1.0, settings)  # the dead zone takes a part of the axis
    for speed_mps in (0.0, 10.0, 30.0):
        source.publish(at_speed(speed_mps))
        for deflection in (1.0, -0.5, 0.0):
            stick.intent = Intent(hand_wheel_rad=deflection * furthest_rad)
            for tick in range(500):
                driver = run.calibrate(source.poll(tick))
            want = max(-furthest_rad, min(furthest_rad, deflection * limit_rad(speed_mps, assistance)))
            assert driver.hand_wheel_rad == pytest.approx(want, abs=1e-6)
    stick.axis = 7.0
    assert source.poll(1).wheel_axis == 7.0  # for calibration to refuse
    source.close()
    assert stick.closed
