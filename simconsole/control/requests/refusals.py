"""Which limit a command breaks that is refused because it steers too hard to be meant, in words with figures."""

from typing import NamedTuple

from simconsole.profiles.control import ControlProfile
from simconsole.values.signals import RemoteCommand, RemoteKind, VehicleState
from simconsole.values.trigonometry import cos, sin


class SteeringLimit(NamedTuple):
    """How hard a command may steer a vehicle before it counts as an error of its sender."""

    lateral_accel_mps2: float
    wheelbase_m: float


def steering_limit(profile: ControlProfile, wheelbase_m: float) -> SteeringLimit:
    """Return the limit of a session's `features.control` for a vehicle."""
    return SteeringLimit(profile.implausible_lateral_accel_ratio * profile.automatic_lateral_accel_mps2, wheelbase_m)


def broken_limit(remote: RemoteCommand, vehicle: VehicleState, limit: SteeringLimit) -> str:
    """Return what an implausible command asks for at the vehicle's speed, and what the limit is."""
    if remote.kind == RemoteKind.TWIST:
        asked_mps2 = abs(vehicle.vx_mps * remote.yaw_rate_radps)
    else:
        angle = remote.road_wheel_rad
        asked_mps2 = abs(vehicle.vx_mps**2 * sin(angle) / (cos(angle) * limit.wheelbase_m))
    return (
        f"lateral acceleration of {asked_mps2:.1f} m/s2 at {abs(vehicle.vx_mps):.1f} m/s, "
        f"at most {limit.lateral_accel_mps2:g} m/s2"
    )
