"""The hand wheel as a rigid rim with friction: one step of its motion. Pure kernels."""

from typing import NamedTuple

from simconsole.values.kernels import approach, kernel


class Rim(NamedTuple):
    """Where the wheel is and how fast it turns, left-positive."""

    rad: float
    radps: float


@kernel
def turn(rim: Rim, torque_nm: float, inertia_kgm2: float, damping_nms: float, friction_nm: float, step_s: float) -> Rim:
    """Return the rim after one step: J dw/dt = T - b w - F sign(w), implicit in b.

    Friction only ever brings the wheel to rest, so that it sticks while less than F pulls at it.

    Args:
        rim: Before.
        torque_nm: All torque on it except its own friction.
        inertia_kgm2: Of all that turns (> 0).
        damping_nms: Viscous.
        friction_nm: Coulomb.
        step_s: Length of the step.
    """
    pushed = (rim.radps + torque_nm / inertia_kgm2 * step_s) / (1.0 + damping_nms / inertia_kgm2 * step_s)
    radps = approach(pushed, 0.0, friction_nm / inertia_kgm2 * step_s)
    return Rim(rim.rad + radps * step_s, radps)
