"""Tyre force of one wheel from the deflection of its contact patch: one law at every speed, standstill included.

The deflection u of the contact patch against the rim follows the slip velocity V and fades over the relaxation
length L: du/dt = -V - |omega R| u / L (Pacejka, Tyre and Vehicle Dynamics, transient slip). Its implicit update
u' = (u - h V) / (1 + h |omega R| / L) divides by no speed: a spring at rest, a relaxation filter in motion.
Force over deflection is a rational curve of the combined demand s = |stiffness * u| / friction: s / (1 + s^2/4), which
begins as a spring, has its maximum, the friction limit, at s = 2 and falls to the sliding friction. A deflection
beyond that slides along, at every speed, locked wheels included.
"""

from math import sqrt
from typing import NamedTuple

from simconsole.values.kernels import clip, foreseen, kernel
from simconsole.vehicle.car.parameters import AxleParameters

PEAK_DEMAND = 2.0
LEAST_SHARE = 0.2
"""Of friction and stiffness per load that a falling line leaves at any load."""


class Tyre(NamedTuple):
    """Result of one step of one tyre."""

    force_x_n: float  # on the car, along the wheel
    force_y_n: float  # to the wheel's left
    deflection_x_m: float
    deflection_y_m: float
    demand: float  # of grip: 0 none, 2 all there is, more: sliding


@kernel
def falling(fall: float, over: float) -> float:
    """Return the share that is left at `over` static loads more than the static load."""
    return clip(1.0 - fall * over, LEAST_SHARE, 2.0)


@kernel
def camber_slip(axle: AxleParameters, camber_rad: float) -> float:
    """Return the slip that does as much as a wheel's lean."""
    lean = axle.camber_slip * camber_rad
    if camber_rad > 0.0:
        lean += axle.camber_offset
    if camber_rad < 0.0:
        lean -= axle.camber_offset
    return lean


@kernel
def carcass_damping(axle: AxleParameters, wheel_radps: float, demand: float) -> float:
    """Return the damping of the carcass in N s/m, at static load.

    That of a rolling tyre fades with grip: sliding rubber stores no energy. A wheel that the brake holds moves with
    the whole car instead of its own small inertia, so it can and must be damped more, at any grip: where it slides, its
    deflection stays the same and there is nothing to damp.
    """
    if wheel_radps == 0.0:
        return axle.locked_damping_nspm
    held = clip(1.0 - demand / PEAK_DEMAND, 0.0, 1.0)
    return axle.damping_nspm * held * held


@kernel
def tyre(
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
) -> Tyre:
    """Advance the deflection by one step and return the force of one tyre.

    Args:
        axle: its parameters.
        friction: of tyre and ground at static load.
        load_n: vertical load, 0 in the air.
        slip_x_mps: velocity of the contact patch over the ground along the wheel, rotation included.
        slip_y_mps: the same to the wheel's left.
        wheel_radps: spin. Exactly 0 means that the brake holds the wheel (powertrain.py).
        deflection_x_m: deflection before the step.
        deflection_y_m: the same to the wheel's left.
        camber_rad: lean of the wheel, positive to the right as a body's roll in a left bend (inclination angle
            of ISO 8855). Camber thrust pushes to the side to which the wheel leans.
        side: of the car, 1 left, -1 right. This tyre is the same on both.
        step_s: length of the step.
    """
    rolled = step_s * abs(wheel_radps) * axle.radius_m
    lean = camber_slip(axle, camber_rad)
    fade_x = 1.0 + rolled * axle.decay_x_per_m
    fade_y = 1.0 + rolled * axle.decay_y_per_m
    per_fade = 1.0 / (fade_x * fade_y)  # one division for both
    x = (deflection_x_m - step_s * slip_x_mps) * (fade_y * per_fade)
    y = (deflection_y_m - step_s * slip_y_mps - rolled * lean) * (fade_x * per_fade)
    over = clip(load_n * axle.per_static_n, 0.0, 4.0) - 1.0
    grip = friction * falling(axle.friction_fall, over)
    firm = falling(axle.stiffness_fall, over)
    stiffness_x = axle.stiffness_x_per_m * firm
    stiffness_y = axle.stiffness_y_per_m * firm
    demand = sqrt(stiffness_x * x * (stiffness_x * x) + stiffness_y * y * (stiffness_y * y)) * (1.0 / grip)
    if demand > axle.slide_demand:
        foreseen()
        share = axle.slide_demand / demand
        x = x * share
        y = y * share
        demand = axle.slide_demand
    elastic = load_n / (1.0 + 0.25 * demand * demand)
    rate = carcass_damping(axle, wheel_radps, demand) * (1.0 + over) * (1.0 / step_s)
    force_x = stiffness_x * x * elastic + rate * (x - deflection_x_m)
    force_y = stiffness_y * y * elastic + rate * (y - deflection_y_m)
    square = force_x * force_x + force_y * force_y
    limit = grip * load_n
    if square > limit * limit:
        foreseen()
        share = limit / sqrt(square)
        force_x = force_x * share
        force_y = force_y * share
    return Tyre(force_x, force_y, x, y, demand)
