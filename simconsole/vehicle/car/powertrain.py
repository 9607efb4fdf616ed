"""Engine, clutch and driven wheels as three friction constraints, solved as impulses.

Engine friction, clutch and wheel brake each try to bring a relative speed to exactly zero and may use at most their
capacity: sticking and slipping are one law, nothing is divided by a speed, nothing chatters. The three act on one
shaft, so they are solved together: projected Gauss-Seidel sweeps that start from the last step's impulses (Catto,
Iterative Dynamics with Temporal Coherence, GDC 2005), which makes a car parked in gear stand with no creep.
"""

from typing import NamedTuple

from simconsole.kernels import approach, clip, kernel


class Shafts(NamedTuple):
    """Speeds and friction impulses after one step."""

    engine_radps: float
    wheel_radps: float
    engine_impulse_nms: float
    clutch_impulse_nms: float
    brake_impulse_nms: float


@kernel
def solve_shafts(
    engine_radps: float,
    wheel_radps: float,
    ratio: float,
    engine_inertia_kgm2: float,
    wheel_inertia_kgm2: float,
    engine_capacity_nms: float,
    clutch_capacity_nms: float,
    brake_capacity_nms: float,
    engine_impulse_nms: float,
    clutch_impulse_nms: float,
    brake_impulse_nms: float,
) -> Shafts:
    """Apply the frictions to the speeds that all other torques have already changed.

    Args:
        engine_radps: engine speed.
        wheel_radps: speed of the driven wheels.
        ratio: engine speed per wheel speed; 0 in neutral, where the clutch capacity must be 0.
        engine_inertia_kgm2: engine and flywheel.
        wheel_inertia_kgm2: both driven wheels.
        engine_capacity_nms: engine friction torque times the step.
        clutch_capacity_nms: clutch torque times the step.
        brake_capacity_nms: brake and rolling resistance torque times the step.
        engine_impulse_nms: impulse found in the last step, positive slows a positive speed.
        clutch_impulse_nms: the same, positive drives the wheels.
        brake_impulse_nms: the same as the engine's.
    """
    clutch_inertia = 1.0 / (1.0 / engine_inertia_kgm2 + ratio * ratio / wheel_inertia_kgm2)
    friction = clip(engine_impulse_nms, -engine_capacity_nms, engine_capacity_nms)
    clutch = clip(clutch_impulse_nms, -clutch_capacity_nms, clutch_capacity_nms)
    brake = clip(brake_impulse_nms, -brake_capacity_nms, brake_capacity_nms)
    engine = engine_radps - (friction + clutch) / engine_inertia_kgm2
    wheel = wheel_radps + (ratio * clutch - brake) / wheel_inertia_kgm2
    for _ in range(3):
        new = clip(friction + engine * engine_inertia_kgm2, -engine_capacity_nms, engine_capacity_nms)
        engine = engine - (new - friction) / engine_inertia_kgm2
        friction = new
        new = clip(clutch + (engine - ratio * wheel) * clutch_inertia, -clutch_capacity_nms, clutch_capacity_nms)
        engine = engine - (new - clutch) / engine_inertia_kgm2
        wheel = wheel + ratio * (new - clutch) / wheel_inertia_kgm2
        clutch = new
        new = clip(brake + wheel * wheel_inertia_kgm2, -brake_capacity_nms, brake_capacity_nms)
        wheel = wheel - (new - brake) / wheel_inertia_kgm2
        brake = new
    if abs(brake) < brake_capacity_nms:
        wheel = 0.0  # the brake holds: what rounding left is not motion, and the tyre asks whether its wheel is held
    return Shafts(engine, wheel, friction, clutch, brake)


@kernel
def braked(wheel_radps: float, inertia_kgm2: float, capacity_nms: float) -> float:
    """Return the speed of free-running wheels after their brake: at most to exactly 0."""
    return approach(wheel_radps, 0.0, capacity_nms / inertia_kgm2)
