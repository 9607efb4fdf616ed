"""Engine, clutch, differential and driven wheels as friction constraints, solved as impulses.

Engine friction, clutch, both wheel brakes and the differential's lock each try to bring a relative speed to exactly
zero and may use at most their capacity: sticking and slipping are one law, nothing is divided by a speed, nothing
chatters. They act on one set of shafts, so they are solved together: projected Gauss-Seidel sweeps that start from the
last step's impulses (Catto, Iterative Dynamics with Temporal Coherence, GDC 2005), which makes a car parked in gear
stand with no creep. Left and right are always treated alike, so that mirrored drives stay mirrored to the last bit.
"""

from typing import NamedTuple

from simconsole.kernels import approach, clip, kernel


class Shafts(NamedTuple):
    """Speeds and friction impulses after one step."""

    engine_radps: float
    left_radps: float
    right_radps: float
    engine_impulse_nms: float
    clutch_impulse_nms: float
    left_impulse_nms: float
    right_impulse_nms: float
    lock_impulse_nms: float


class Capacity(NamedTuple):
    """The most that each friction can do in one step, N m s; `lock_share` adds to the lock what the clutch drives."""

    engine_nms: float
    clutch_nms: float
    left_nms: float
    right_nms: float
    lock_nms: float
    lock_share: float


@kernel
def solve_shafts(
    before: Shafts, ratio: float, engine_inertia_kgm2: float, wheel_inertia_kgm2: float, most: Capacity
) -> Shafts:
    """Apply the frictions to the speeds that all other torques have already changed.

    Args:
        before: speeds, and the impulses found in the last step: engine and brakes positive slow a positive speed,
            the clutch's positive drives the wheels, the lock's positive drives the left wheel.
        ratio: engine speed per mean wheel speed; 0 in neutral, where the clutch capacity must be 0.
        engine_inertia_kgm2: engine and flywheel.
        wheel_inertia_kgm2: one driven wheel.
        most: the capacities.
    """
    # Divided once: the sweeps below wait for every result of the one before.
    per_engine = 1.0 / engine_inertia_kgm2
    per_wheel = 1.0 / wheel_inertia_kgm2
    half = 0.5 * ratio
    half_per_wheel = half * per_wheel
    half_inertia = 0.5 * wheel_inertia_kgm2
    clutch_inertia = 1.0 / (per_engine + 2.0 * half * half * per_wheel)
    friction = clip(before.engine_impulse_nms, -most.engine_nms, most.engine_nms)
    clutch = clip(before.clutch_impulse_nms, -most.clutch_nms, most.clutch_nms)
    left_brake = clip(before.left_impulse_nms, -most.left_nms, most.left_nms)
    right_brake = clip(before.right_impulse_nms, -most.right_nms, most.right_nms)
    bound = most.lock_nms + most.lock_share * abs(ratio * clutch)
    lock = clip(before.lock_impulse_nms, -bound, bound)
    engine = before.engine_radps - (friction + clutch) * per_engine
    left = before.left_radps + (half * clutch - left_brake + lock) * per_wheel
    right = before.right_radps + (half * clutch - right_brake - lock) * per_wheel
    for _ in range(4):
        new = clip(friction + engine * engine_inertia_kgm2, -most.engine_nms, most.engine_nms)
        engine = engine - (new - friction) * per_engine
        friction = new
        new = clip(clutch + (engine - half * (left + right)) * clutch_inertia, -most.clutch_nms, most.clutch_nms)
        engine = engine - (new - clutch) * per_engine
        left = left + (new - clutch) * half_per_wheel
        right = right + (new - clutch) * half_per_wheel
        clutch = new
        bound = most.lock_nms + most.lock_share * abs(ratio * clutch)
        if bound > 0.0:
            new = clip(lock - (left - right) * half_inertia, -bound, bound)
            left = left + (new - lock) * per_wheel
            right = right - (new - lock) * per_wheel
            lock = new
        new = clip(left_brake + left * wheel_inertia_kgm2, -most.left_nms, most.left_nms)
        left = left - (new - left_brake) * per_wheel
        left_brake = new
        new = clip(right_brake + right * wheel_inertia_kgm2, -most.right_nms, most.right_nms)
        right = right - (new - right_brake) * per_wheel
        right_brake = new
    # The brake holds: what rounding left is not motion, and the tyre asks whether its wheel is held.
    if abs(left_brake) < most.left_nms:
        left = 0.0
    if abs(right_brake) < most.right_nms:
        right = 0.0
    return Shafts(engine, left, right, friction, clutch, left_brake, right_brake, lock)


@kernel
def braked(wheel_radps: float, inertia_kgm2: float, capacity_nms: float) -> float:
    """Return the speed of a free-running wheel after its brake: at most to exactly 0."""
    return approach(wheel_radps, 0.0, capacity_nms * (1.0 / inertia_kgm2))
