"""The parts of the motor's torque, each alone."""

import itertools
import math

import pytest

from simconsole.devices.force_feedback.force_settings import ForceSettings, force_settings
from simconsole.devices.force_feedback.guidance import GuidanceReference
from simconsole.devices.force_feedback.rim import Rim
from simconsole.devices.force_feedback.torque_parts import (
    TorqueParts,
    centring_spring,
    end_stop,
    servo,
    soft_clip,
    torque_parts,
)
from simconsole.profiles.device import CockpitProfile
from simconsole.values.platform import NO_STIFFNESS
from simconsole.values.signals import VehicleState

CAR = VehicleState(*(0.0,) * len(VehicleState._fields))._replace(vx_mps=15.0, hand_wheel_torque_nm=-2.0)
STRAIGHT = Rim(0.0, 0.0)


@pytest.fixture(scope="module")
def force(t500: CockpitProfile) -> ForceSettings:
    return force_settings(t500, 15.5, math.radians(36.0), 250)


def alone(force: ForceSettings, target: Rim, rim: Rim, vehicle: VehicleState) -> TorqueParts:
    """The parts in MANUAL."""
    return torque_parts(False, target, rim, vehicle, GuidanceReference(0.0, 0.0), 0.0, 1.0, 0.0, 0.0, force)


def test_car_torque_fades_and_friction_grows_towards_standstill(force: ForceSettings) -> None:
    at = [alone(force, STRAIGHT, STRAIGHT, CAR._replace(vx_mps=v)).car_nm for v in (0.0, 0.5, 5.0, 30.0)]
    assert at[0] == 0.0
    assert at == sorted(at, reverse=True)
    turning = Rim(0.0, 1.0)
    drags = [alone(force, STRAIGHT, turning, CAR._replace(vx_mps=v)).effects_nm for v in (0.0, 1.0, 20.0)]
    assert drags[0] < drags[1] < drags[2] < 0.0


def test_road_is_felt_over_distance_alone(force: ForceSettings) -> None:
    texture = [alone(force, STRAIGHT, STRAIGHT, CAR._replace(distance_m=0.1 * k)).effects_nm for k in range(400)]
    assert 0.02 < max(texture) <= force.texture_nm
    assert abs(sum(texture) / len(texture)) < 0.005
    standing = CAR._replace(vx_mps=0.0, distance_m=3.3)
    assert alone(force, STRAIGHT, STRAIGHT, standing).effects_nm == 0.0


def test_end_stop_pushes_back_only_beyond_the_lock(force: ForceSettings) -> None:
    lock = force.end_stop_rad
    assert lock < math.radians(540.0)
    assert end_stop(Rim(lock, 3.0), force) == 0.0
    assert end_stop(Rim(lock + 0.1, 0.0), force) == pytest.approx(-2.5)
    assert end_stop(Rim(-lock - 0.1, 0.0), force) == pytest.approx(2.5)
    assert end_stop(Rim(lock + 0.1, 2.0), force) < end_stop(Rim(lock + 0.1, -2.0), force) < 0.0


def test_soft_clip_is_monotone_bounded_odd_and_smooth(force: ForceSettings) -> None:
    top = force.max_torque_nm
    values = [soft_clip(0.01 * k, force) for k in range(5000)]
    assert all(before < after < top for before, after in itertools.pairwise(values))
    assert max(after - before for before, after in itertools.pairwise(values)) < 0.01 + 1e-9
    assert values[200] == 2.0
    assert soft_clip(-7.0, force) == -soft_clip(7.0, force)


def test_servo_pulls_towards_the_target(force: ForceSettings) -> None:
    assert servo(Rim(0.1, 0.0), STRAIGHT, force) == pytest.approx(1.8)
    assert servo(Rim(0.0, 1.0), Rim(0.0, 1.0), force) == 0.0


def test_spring_to_the_middle_is_for_tyres_that_pull_nowhere(force: ForceSettings, t500: CockpitProfile) -> None:
    assert t500.force_feedback is not None
    spring = t500.force_feedback.centring_spring_nm_per_rad
    assert force.centring_spring_nm_per_rad == spring > 0.0
    at_nm = [centring_spring(rad, force) for rad in (-9.0, -0.1, 0.0, 0.1, 9.0)]
    assert at_nm == pytest.approx([2.5, 0.1 * spring, 0.0, -0.1 * spring, -2.5])
    pulled = force_settings(t500, 15.5, math.radians(36.0), 250, NO_STIFFNESS._replace(pulls=1.0))
    assert centring_spring(0.1, pulled) == 0.0
    assert force.rim_12mps_nm_per_rad - pulled.rim_12mps_nm_per_rad == spring, "it is damped as a car's own stiffness"
