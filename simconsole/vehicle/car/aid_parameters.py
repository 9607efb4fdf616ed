"""What the driver aids must know of a car: its tyres' stiffness, and how it steers."""

from typing import Final

from simconsole.profiles.parts.chassis import AxleProfile
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.units import MPS_PER_KMH, RAD_PER_DEG, STANDARD_GRAVITY_MPS2
from simconsole.vehicle.car.parameters import AidParameters, AxleParameters

LEAST_UNDERSTEER_KMH: Final = 250.0
"""Characteristic speed of the least understeer that stability control expects of a car."""


def aid_parameters(profile: CarProfile, front: AxleParameters, rear: AxleParameters) -> AidParameters:
    """Return what the aids go by; the axles give the loads at rest."""
    aids = profile.aids
    known = aids.characteristic_speed_kmh
    return AidParameters(
        anti_lock=float(aids.anti_lock),
        traction=float(aids.traction_control),
        stability=float(aids.stability_control),
        hill_hold=float(aids.hill_hold),
        understeer_per_square_mps=(
            _understeer(profile, front, rear) if known is None else 1.0 / (known * MPS_PER_KMH) ** 2
        ),
        lateral_mps2=aids.stability_lateral_mps2,
        stability_nms=aids.stability_nm_per_radps,
        stability_most_nm=aids.stability_nm,
    )


def slip_stiffness(profile: CarProfile, axle: AxleProfile) -> float:
    """Return force per load and slip at small slip, of the tyre that the car has."""
    given = {} if profile.tyre is None else profile.tyre.coefficients
    return given.get("PKX1", axle.slip_stiffness) * given.get("LKX", 1.0)


def _understeer(profile: CarProfile, front: AxleParameters, rear: AxleParameters) -> float:
    """Return k of the yaw rate r = v d / (L (1 + k v^2)) that the car settles at, per (m/s)^2.

    That of the linear single track (Riekert and Schunck, 1940) on the tyres' stiffness at their static loads, with the
    steering that gives way to the tyres' moment. A car that does not understeer is expected to do so a little.
    """
    body, steering = profile.body, profile.steering
    slips = 1.0 / _cornering(profile, profile.front, front.static_n) - 1.0 / _cornering(
        profile, profile.rear, rear.static_n
    )
    moment_nm_per_mps2 = body.mass_kg * body.front_mass_share * (steering.pneumatic_trail_m + steering.caster_trail_m)
    bent = steering.compliance_deg_per_100nm * RAD_PER_DEG / 100.0 * moment_nm_per_mps2
    found = (slips / STANDARD_GRAVITY_MPS2 + bent) / body.wheelbase_m
    return max(found, 1.0 / (LEAST_UNDERSTEER_KMH * MPS_PER_KMH) ** 2)


def _cornering(profile: CarProfile, axle: AxleProfile, load_n: float) -> float:
    """Return an axle's side force over load and slip angle at none."""
    if profile.tyre is None or not profile.tyre.coefficients:
        return axle.cornering_stiffness_per_rad
    from simconsole.vehicle.car.pac2002 import coefficients, stiffness_y

    return -stiffness_y(coefficients(profile.tyre.coefficients), load_n, 0.0) / load_n
