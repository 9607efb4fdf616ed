"""How far and how fast an automatic source may turn the road wheels at a speed."""

from typing import Final

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.longitudinal import finite_or
from simconsole.values.kernels import clip, kernel
from simconsole.values.signals import VehicleState
from simconsole.values.trigonometry import atan, cos, sin

_MOST_MPS: Final = 100.0
_MOST_RAD: Final = 1.5


@kernel
def curvature(road_wheel_rad: float, settings: ControlSettings) -> float:
    """Return the curvature in 1/m that a finite angle steers: kinematic single track, tan(angle) / wheelbase."""
    angle = clip(road_wheel_rad, -_MOST_RAD, _MOST_RAD)
    return sin(angle) / (cos(angle) * settings.wheelbase_m)


@kernel
def lateral_apart(first_rad: float, second_rad: float, vehicle: VehicleState, settings: ControlSettings) -> float:
    """Return by how many m/s2 of lateral acceleration two angles differ at the present speed."""
    speed = clip(finite_or(vehicle.vx_mps, 0.0), -_MOST_MPS, _MOST_MPS)
    return abs(curvature(first_rad, settings) - curvature(second_rad, settings)) * speed * speed


@kernel
def limited_angle(
    road_wheel_rad: float, lateral_accel_mps2: float, vehicle: VehicleState, settings: ControlSettings
) -> float:
    """Return a finite angle, reduced so that the lateral acceleration stays inside the limit; 0 is no limit.

    Kinematic single track: lateral acceleration = speed^2 tan(angle) / wheelbase. A speed that is not finite counts as
    standing: straightening the wheels because a number is broken would be the worse error.
    """
    speed = clip(finite_or(vehicle.vx_mps, 0.0), -_MOST_MPS, _MOST_MPS)
    if lateral_accel_mps2 <= 0.0 or abs(speed) <= settings.standstill_speed_mps:
        return road_wheel_rad
    most = atan(lateral_accel_mps2 * settings.wheelbase_m / (speed * speed))
    return clip(road_wheel_rad, -most, most)


@kernel
def limited_step(
    angle_rad: float,
    step_rad: float,
    lateral_jerk_mps3: float,
    vehicle: VehicleState,
    settings: ControlSettings,
    tick_s: float,
) -> float:
    """Return how far the road wheels may turn in this tick from a finite `angle_rad`: at most `step_rad` (>= 0).

    Less where that would be more lateral jerk than the limit; 0 is no limit. The derivative of lateral acceleration =
    speed^2 tan(angle) / wheelbase at a constant speed: jerk = speed^2 / (wheelbase cos(angle)^2) * steering rate.
    """
    speed = clip(finite_or(vehicle.vx_mps, 0.0), -_MOST_MPS, _MOST_MPS)
    if lateral_jerk_mps3 <= 0.0 or abs(speed) <= settings.standstill_speed_mps:
        return step_rad
    share = cos(angle_rad)
    most = lateral_jerk_mps3 * settings.wheelbase_m * share * share / (speed * speed) * tick_s
    return clip(step_rad, 0.0, most)
