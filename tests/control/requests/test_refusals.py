"""The limit that an implausible command breaks, in words."""

import math

from simconsole.control.requests.refusals import SteeringLimit, broken_limit, steering_limit
from simconsole.profiles.control import ControlProfile
from simconsole.values.signals import NO_COMMAND, RemoteKind, VehicleState

STANDING = VehicleState(*(0.0,) * len(VehicleState._fields))
LIMIT = SteeringLimit(10.0, 2.5)


def test_the_limit_is_the_sessions() -> None:
    profile = ControlProfile(implausible_lateral_accel_ratio=3.0, automatic_lateral_accel_mps2=4.0)
    assert steering_limit(profile, 2.6) == SteeringLimit(12.0, 2.6)


def test_an_angle_counts_by_the_kinematic_single_track() -> None:
    command = NO_COMMAND._replace(kind=float(RemoteKind.ACCELERATION), road_wheel_rad=math.atan(0.25))
    told = broken_limit(command, STANDING._replace(vx_mps=20.0), LIMIT)
    assert told == "lateral acceleration of 40.0 m/s2 at 20.0 m/s, at most 10 m/s2"


def test_a_twist_says_its_yaw_rate() -> None:
    command = NO_COMMAND._replace(kind=float(RemoteKind.TWIST), yaw_rate_radps=-2.0)
    told = broken_limit(command, STANDING._replace(vx_mps=-6.0), LIMIT)
    assert told == "lateral acceleration of 12.0 m/s2 at 6.0 m/s, at most 10 m/s2"
