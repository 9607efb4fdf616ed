"""Tyre force of one axle from the deflection of its contact patch: one law at every speed, standstill included.

The deflection u of the contact patch against the rim follows the slip velocity V and fades over the relaxation
length L: du/dt = -V - |omega R| u / L (Pacejka, Tyre and Vehicle Dynamics, transient slip). Its implicit update
u' = (u - h V) / (1 + h |omega R| / L) divides by no speed: a spring at rest, a relaxation filter in motion.
Force over deflection is the brush model's parabola (Fiala 1954): s - s^2/3 + s^3/27 of the friction limit up to full
sliding at s = 3. A deflection beyond that slides along, at every speed, locked wheels included.
"""

from math import sqrt
from typing import NamedTuple

from simconsole.kernels import kernel
from simconsole.vehicle.car.parameters import AxleParameters


class Tyre(NamedTuple):
    """Result of one step of one axle."""

    force_x_n: float  # on the car, along the wheel
    force_y_n: float  # to the wheel's left
    deflection_x_m: float
    deflection_y_m: float
    grip: float  # 1 adhering, 0 sliding


@kernel
def tyre(
    axle: AxleParameters,
    load_n: float,
    slip_x_mps: float,
    slip_y_mps: float,
    wheel_radps: float,
    deflection_x_m: float,
    deflection_y_m: float,
    step_s: float,
) -> Tyre:
    """Advance the deflection by one step and return the force of one axle.

    Args:
        axle: its parameters.
        load_n: vertical load, above 0.
        slip_x_mps: velocity of the contact patch over the ground along the wheel, rotation included.
        slip_y_mps: the same to the wheel's left.
        wheel_radps: spin. Exactly 0 means that the brake holds the wheel (powertrain.py).
        deflection_x_m: deflection before the step.
        deflection_y_m: the same to the wheel's left.
        step_s: length of the step.
    """
    travel = step_s * abs(wheel_radps) * axle.radius_m
    x = (deflection_x_m - step_s * slip_x_mps) / (1.0 + travel * axle.decay_x_per_m)
    y = (deflection_y_m - step_s * slip_y_mps) / (1.0 + travel * axle.decay_y_per_m)
    limit = axle.friction * load_n
    stiffness_x = axle.stiffness_x_per_m * load_n
    stiffness_y = axle.stiffness_y_per_m * load_n
    demand = sqrt(stiffness_x * x * (stiffness_x * x) + stiffness_y * y * (stiffness_y * y)) / limit
    if demand > 3.0:
        x = x * (3.0 / demand)
        y = y * (3.0 / demand)
        demand = 3.0
    grip = 1.0 - demand / 3.0
    elastic = 1.0 - demand / 3.0 + demand * demand / 27.0
    # The damping of the carcass fades with grip: sliding rubber does not store. A wheel that the brake holds moves with
    # the whole car instead of its own small inertia, so it can and must be damped more.
    damping = axle.locked_damping_nspm if wheel_radps == 0.0 else axle.damping_nspm
    rate = damping * grip * grip / step_s
    force_x = stiffness_x * x * elastic + rate * (x - deflection_x_m)
    force_y = stiffness_y * y * elastic + rate * (y - deflection_y_m)
    force = sqrt(force_x * force_x + force_y * force_y)
    if force > limit:
        force_x = force_x * (limit / force)
        force_y = force_y * (limit / force)
    return Tyre(force_x, force_y, x, y, grip)
