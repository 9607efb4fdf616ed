"""The car on PAC2002 tyres: the same transient deflection, other steady forces. Chosen when the car is assembled.

The deflection over its relaxation length is the slip that PAC2002 is asked for: no division by speed, a spring at
standstill. Beyond `slide_demand` (the profile's `sliding_share`) the deflection slides along with the force it has.
"""

from functools import cache
from math import sqrt
from typing import Final, NamedTuple

from simconsole.values.kernels import clip, kernel
from simconsole.values.platform import Step
from simconsole.vehicle.car.axles import TyreModel
from simconsole.vehicle.car.car_step import make_step
from simconsole.vehicle.car.ground import field_grips, on_field, on_plane, plane_grips
from simconsole.vehicle.car.pac2002 import (
    LEAST_LOAD_N,
    Pac2002,
    Slip,
    peak_x,
    peak_y,
    steady,
    stiffness_x,
    stiffness_y,
)
from simconsole.vehicle.car.parameters import AxleParameters, SteeringParameters
from simconsole.vehicle.car.steering import ROLLING_MPS
from simconsole.vehicle.car.tyre import carcass_damping

MOST_NOMINAL: Final = 2.0
"""Nominal loads above which a tyre slides at the same deflection as there."""


class TirForce(NamedTuple):
    """A `Tyre` with its own aligning moment."""

    force_x_n: float
    force_y_n: float
    deflection_x_m: float
    deflection_y_m: float
    demand: float
    moment_nm: float  # as it rolls ahead


@kernel
def demand_of(p: Pac2002, s: Slip) -> float:
    """Return the demand of grip: the force that the stiffness at small slip would give, over the most there is."""
    share_x = stiffness_x(p, s.load_n) * s.along / peak_x(p, s)
    share_y = stiffness_y(p, s.load_n, s.camber_rad) * s.across / peak_y(p, s)
    return sqrt(share_x * share_x + share_y * share_y)


def make_tyre(p: Pac2002) -> TyreModel:
    """Return the kernel of a tyre with these coefficients, in place of `tyre.tyre`.

    It advances the deflection by one step and returns the force. The deflection fades over the way that the wheel
    travels, du/dt = -V - |Vx| u / L: in steady motion u / L is then the slip as PAC2002 has it, over the speed of
    travel, and nothing was divided by that speed. Over the speed of rolling, as `tyre` has it, 10 % of slip would be
    11 % when braking. A wheel that the brake holds is a spring.

    Plysteer and conicity belong to the side on which the tyre was measured: on the other it is mounted mirrored.
    """
    force_of = steady(p)

    @kernel
    def tir_tyre(
        axle: AxleParameters,
        friction: float,
        load_n: float,
        slip_x_mps: float,
        slip_y_mps: float,
        wheel_radps: float,
        deflection_x_m: float,
        deflection_y_m: float,
        camber_rad: float,
        side: float,
        step_s: float,
    ) -> TirForce:
        way = step_s * abs(slip_x_mps + wheel_radps * axle.radius_m) if wheel_radps != 0.0 else 0.0
        x = (deflection_x_m - step_s * slip_x_mps) / (1.0 + way * axle.decay_x_per_m)
        y = (deflection_y_m - step_s * slip_y_mps) / (1.0 + way * axle.decay_y_per_m)
        load = load_n if load_n > LEAST_LOAD_N else LEAST_LOAD_N
        # Stiffness over load falls without bound: under an impact the patch would slide only at an absurd deflection.
        usual = clip(load, LEAST_LOAD_N, MOST_NOMINAL * p.fnomin)
        demand = demand_of(p, Slip(x * axle.decay_x_per_m, -y * axle.decay_y_per_m, usual, camber_rad, friction))
        if demand > axle.slide_demand:
            share = axle.slide_demand / demand
            x = x * share
            y = y * share
            demand = axle.slide_demand
        turned = side * p.tyreside
        across = -turned * y * axle.decay_y_per_m
        given = force_of(p, Slip(x * axle.decay_x_per_m, across, load, turned * camber_rad, friction))
        touching = clip(load_n * (1.0 / LEAST_LOAD_N), 0.0, 1.0)
        damping = carcass_damping(axle, wheel_radps, demand)
        rate = damping * clip(load_n * axle.per_static_n, 0.0, 4.0) * (1.0 / step_s)
        force_x = given.x_n * touching + rate * (x - deflection_x_m)
        force_y = turned * given.y_n * touching + rate * (y - deflection_y_m)
        force = sqrt(force_x * force_x + force_y * force_y)
        limit = touching * (given.peak_x_n if given.peak_x_n > given.peak_y_n else given.peak_y_n)
        share = limit / force if force > limit else 1.0
        return TirForce(
            force_x_n=force_x * share,
            force_y_n=force_y * share,
            deflection_x_m=x,
            deflection_y_m=y,
            demand=demand,
            moment_nm=turned * given.moment_nm * touching,
        )

    return tir_tyre


@kernel
def tir_kingpin_moment(p: SteeringParameters, tyre_force: TirForce, rolling_mps: float) -> float:
    """Return the moment about the kingpin: the tyre's own, which changes sign when rolling back, and the caster's."""
    way = rolling_mps / (abs(rolling_mps) + ROLLING_MPS)
    return tyre_force.moment_nm * way - tyre_force.force_y_n * p.caster_trail_m


@cache
def step_on(coefficients: Pac2002, uneven: bool = False) -> Step:
    """Return the car's step on this tyre, over a plane or a field. Equal ones give the same: it compiles once."""
    ground = (field_grips, on_field) if uneven else (plane_grips, on_plane)
    return make_step(make_tyre(coefficients), tir_kingpin_moment, *ground)
