"""Accelerations and speeds to pedals, by inverting what the vehicle says its pedals would give now.

The vehicle states three accelerations (released pedals, full throttle, full brake); between them pedals are taken as
linear. A small bounded integral corrects the rest. All along the direction of travel: positive is faster.
"""

from typing import Final, NamedTuple

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.values.kernels import clip, is_finite, kernel
from simconsole.values.signals import VehicleState

_LEAST_SPAN_MPS2: Final = 0.2  # a smaller difference of released and full pedal is unusable (declutched, stalled)
_MOST_MPS2: Final = 50.0  # nor is more than five times gravity


class Pedals(NamedTuple):
    """Throttle and brake 0 to 1, never both."""

    throttle: float
    brake: float


@kernel
def finite_or(value: float, otherwise: float) -> float:
    """Return `value` if it is finite, else `otherwise`."""
    return value if is_finite(value) else otherwise


@kernel
def pedals_for(accel_mps2: float, travel: float, vehicle: VehicleState, settings: ControlSettings) -> Pedals:
    """Return the pedals for a finite acceleration along the direction of travel (`travel` 1 forward, -1 backward).

    Where the vehicle's own figures are missing, contradictory or not finite, the nominal ones of the profile serve.
    """
    coast = clip(finite_or(travel * vehicle.coast_accel_mps2, 0.0), -_MOST_MPS2, _MOST_MPS2)
    if accel_mps2 > coast:
        full = finite_or(travel * vehicle.full_throttle_accel_mps2, coast)
        span = full - coast
        if span < _LEAST_SPAN_MPS2 or span > _MOST_MPS2:
            span = settings.nominal_throttle_accel_mps2
        return Pedals(clip((accel_mps2 - coast) / span, 0.0, 1.0), 0.0)
    if accel_mps2 > coast - settings.coast_band_mps2:
        return Pedals(0.0, 0.0)
    return Pedals(0.0, brake_for(accel_mps2, travel, vehicle, settings))


@kernel
def brake_for(accel_mps2: float, travel: float, vehicle: VehicleState, settings: ControlSettings) -> float:
    """Return the brake alone for a finite acceleration along the direction of travel, without the coasting band."""
    coast = clip(finite_or(travel * vehicle.coast_accel_mps2, 0.0), -_MOST_MPS2, _MOST_MPS2)
    span = coast - finite_or(travel * vehicle.full_brake_accel_mps2, coast)
    if span < _LEAST_SPAN_MPS2 or span > _MOST_MPS2:
        span = settings.nominal_brake_accel_mps2
    return clip((coast - accel_mps2) / span, 0.0, 1.0)


@kernel
def integrate(integral_mps2: float, error_mps2: float, settings: ControlSettings, tick_s: float) -> float:
    """Return the integral after one tick, bounded; a finite acceleration error in, an acceleration out."""
    bounded = clip(error_mps2, -settings.decel_max_mps2, settings.decel_max_mps2)
    moved = integral_mps2 + settings.integral_gain_per_s * bounded * tick_s
    return clip(moved, -settings.integral_max_mps2, settings.integral_max_mps2)
