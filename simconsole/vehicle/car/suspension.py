"""Suspension: springs, dampers, anti-roll bars and stops between body and wheels, tyres as vertical springs."""

from typing import NamedTuple

from simconsole.values.kernels import kernel
from simconsole.vehicle.car.parameters import AxleParameters
from simconsole.vehicle.car.state import BodyState, Wheel


class Travel(NamedTuple):
    """Compression of one axle's struts."""

    left_m: float
    right_m: float
    left_mps: float
    right_mps: float


@kernel
def travel(axle: AxleParameters, body: BodyState, left: Wheel, right: Wheel) -> Travel:
    """Return how far and how fast the struts of an axle are compressed, from rest on level ground."""
    middle = body.heave_m - axle.ahead_m * body.pitch_rad
    middle_mps = body.heave_mps - axle.ahead_m * body.pitch_radps
    side = axle.half_track_m * body.roll_rad
    side_mps = axle.half_track_m * body.roll_radps
    return Travel(
        left.lift_m - (middle + side),
        right.lift_m - (middle - side),
        left.lift_mps - (middle_mps + side_mps),
        right.lift_mps - (middle_mps - side_mps),
    )


@kernel
def compression_rate(axle: AxleParameters, body: BodyState, left_mps: float, right_mps: float) -> float:
    """Return how fast both struts of an axle are compressed in the mean, from the rates of its wheels' lifts."""
    return 0.5 * (left_mps + right_mps) - (body.heave_mps - axle.ahead_m * body.pitch_radps)


@kernel
def support(axle: AxleParameters, force_x_n: float) -> float:
    """Return the force with which an axle's links push body and one wheel apart, by the force along both its tyres.

    Seen from the side a wheel moves about a pole: braking at the ground, with the brakes at the wheels, its links carry
    the slope of the line from contact patch to pole of the force (Reimpell, The Automotive Chassis, anti-dive).
    """
    return -0.5 * axle.support_slope * force_x_n


@kernel
def strut(axle: AxleParameters, compressed_m: float, compressed_mps: float, other_m: float) -> float:
    """Return by how much the force of one strut differs from that at rest: positive pushes body and wheel apart."""
    force = axle.spring_npm * compressed_m + axle.damper_nspm * compressed_mps
    force += axle.bar_npm * (compressed_m - other_m)
    if compressed_m > axle.travel_m:
        force += axle.stop_npm * (compressed_m - axle.travel_m)
    if compressed_m < -axle.travel_m:
        force += axle.stop_npm * (compressed_m + axle.travel_m)
    return force


@kernel
def wheel_load(axle: AxleParameters, wheel: Wheel) -> float:
    """Return the vertical load of a tyre in N: it pushes, it never pulls."""
    load = axle.static_n - axle.carcass_npm * wheel.lift_m - axle.carcass_nspm * wheel.lift_mps
    return load if load > 0.0 else 0.0


@kernel
def axle_roll(axle: AxleParameters, left: float, right: float) -> float:
    """Return the roll of an axle, positive left side up, from the lifts of its wheels (or its rate from theirs)."""
    return (left - right) * axle.roll_rad_per_m
