"""What the console itself asks for when nobody drives: parked, safe stop, stopped, emergency stop."""

from typing import Final, NamedTuple

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.longitudinal import brake_for, finite_or, integrate
from simconsole.values.kernels import approach, clip, kernel
from simconsole.values.signals import VehicleState


class Stopping(NamedTuple):
    """A safe stop after this tick."""

    brake: float
    stop_accel_mps2: float  # deceleration asked for (<= 0), along the direction of travel
    integral_mps2: float


_MOST_MPS2: Final = 20.0


@kernel
def stands(vehicle: VehicleState, settings: ControlSettings) -> bool:
    """Return whether the vehicle moves in no direction faster than standstill; a speed not finite is not slow."""
    square = vehicle.vx_mps * vehicle.vx_mps + vehicle.vy_mps * vehicle.vy_mps
    return square <= settings.standstill_speed_mps * settings.standstill_speed_mps


@kernel
def travel_direction(vehicle: VehicleState) -> float:
    """Return 1 if the vehicle rolls forward or stands, -1 if it rolls backward."""
    return -1.0 if vehicle.vx_mps < 0.0 else 1.0


@kernel
def stop_start(vehicle: VehicleState, settings: ControlSettings) -> float:
    """Return the deceleration with which a safe stop begins: the present one, within what a safe stop may ask for."""
    now = finite_or(travel_direction(vehicle) * vehicle.ax_mps2, 0.0)
    return clip(now, -settings.stop_decel_mps2, 0.0)


@kernel
def safe_stop(
    stop_accel_mps2: float,
    integral_mps2: float,
    steered: bool,
    vehicle: VehicleState,
    settings: ControlSettings,
    tick_s: float,
) -> Stopping:
    """Brake to a standstill, corrected by a bounded integral, never beyond 4 m/s2.

    2.5 m/s2 reached with 1.5 m/s3, the specified values, while the stop is steered; harder where it is not: then the
    length of the stop decides whether the car stays in its lane (docs/decisions/0009-stops-that-nobody-steers.md).
    """
    if stands(vehicle, settings):
        return Stopping(settings.hold_brake, stop_accel_mps2, 0.0)
    decel = settings.stop_decel_mps2 if steered else settings.blind_stop_decel_mps2
    jerk = settings.stop_jerk_mps3 if steered else settings.blind_stop_jerk_mps3
    accel = approach(stop_accel_mps2, -decel, jerk * tick_s)
    travel = travel_direction(vehicle)
    measured = clip(finite_or(travel * vehicle.ax_mps2, accel), -_MOST_MPS2, _MOST_MPS2)
    integral = integrate(integral_mps2, accel - measured, settings, tick_s)
    wanted = clip(accel + integral, -settings.stop_decel_max_mps2, 0.0)
    return Stopping(brake_for(wanted, travel, vehicle, settings), accel, integral)
