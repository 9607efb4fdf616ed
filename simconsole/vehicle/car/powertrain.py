"""Engine, clutch, differential and driven wheels as friction constraints, solved as impulses.

Engine friction, clutch, both wheel brakes and the differential's lock each try to bring a relative speed to exactly
zero and may use at most their capacity: sticking and slipping follow one law, nothing is divided by a speed, nothing
chatters. They act on one set of shafts, so they are solved together: projected Gauss-Seidel sweeps that start from the
last step's impulses (Catto, Iterative Dynamics with Temporal Coherence, GDC 2005), which makes a car parked in gear
stand with no creep. Left and right are always treated alike, so that mirrored drives stay mirrored to the last bit.
"""

from typing import Final, NamedTuple

from simconsole.values.kernels import approach, clip, kernel, steady_clip

MOST_SWEEPS: Final = 4.0


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


class Inertia(NamedTuple):
    """Inertia of one shaft."""

    kgm2: float
    per_kgm2: float  # 1 / kgm2


@kernel
def slowed(s: Shafts, flywheel: Inertia, wheel: Inertia, most: Capacity) -> Shafts:
    """Return the shafts after the frictions that work against standing parts: in the engine, and both brakes."""
    # While everything turns all three stay at their limits, at rest within them: then no speed waits for another.
    engine_nms = steady_clip(s.engine_impulse_nms + s.engine_radps * flywheel.kgm2, -most.engine_nms, most.engine_nms)
    left_nms = steady_clip(s.left_impulse_nms + s.left_radps * wheel.kgm2, -most.left_nms, most.left_nms)
    right_nms = steady_clip(s.right_impulse_nms + s.right_radps * wheel.kgm2, -most.right_nms, most.right_nms)
    return Shafts(
        engine_radps=s.engine_radps - (engine_nms - s.engine_impulse_nms) * flywheel.per_kgm2,
        left_radps=s.left_radps - (left_nms - s.left_impulse_nms) * wheel.per_kgm2,
        right_radps=s.right_radps - (right_nms - s.right_impulse_nms) * wheel.per_kgm2,
        engine_impulse_nms=engine_nms,
        clutch_impulse_nms=s.clutch_impulse_nms,
        left_impulse_nms=left_nms,
        right_impulse_nms=right_nms,
        lock_impulse_nms=s.lock_impulse_nms,
    )


@kernel
def coupled(s: Shafts, ratio: float, clutch_kgm2: float, flywheel: Inertia, wheel: Inertia, most: Capacity) -> Shafts:
    """Return the shafts after the frictions between them: the clutch, then the lock, which leaves it as it is."""
    half = 0.5 * ratio
    slip = s.engine_radps - half * (s.left_radps + s.right_radps)
    clutch_nms = steady_clip(s.clutch_impulse_nms + slip * clutch_kgm2, -most.clutch_nms, most.clutch_nms)
    more = clutch_nms - s.clutch_impulse_nms
    left = s.left_radps + more * (half * wheel.per_kgm2)
    right = s.right_radps + more * (half * wheel.per_kgm2)
    lock_nms = s.lock_impulse_nms
    bound = most.lock_nms + most.lock_share * abs(ratio * clutch_nms)
    if bound > 0.0:
        lock_nms = steady_clip(lock_nms - (left - right) * (0.5 * wheel.kgm2), -bound, bound)
        left = left + (lock_nms - s.lock_impulse_nms) * wheel.per_kgm2
        right = right - (lock_nms - s.lock_impulse_nms) * wheel.per_kgm2
    engine = s.engine_radps - more * flywheel.per_kgm2
    return Shafts(
        engine_radps=engine,
        left_radps=left,
        right_radps=right,
        engine_impulse_nms=s.engine_impulse_nms,
        clutch_impulse_nms=clutch_nms,
        left_impulse_nms=s.left_impulse_nms,
        right_impulse_nms=s.right_impulse_nms,
        lock_impulse_nms=lock_nms,
    )


@kernel
def solve_shafts(before: Shafts, ratio: float, flywheel: Inertia, wheel: Inertia, most: Capacity) -> Shafts:
    """Apply the frictions to the speeds that all other torques have already changed.

    Args:
        before: speeds, and the impulses found in the last step: engine and brakes positive slow a positive speed,
            the clutch's positive drives the wheels, the lock's positive drives the left wheel.
        ratio: engine speed per mean wheel speed; 0 in neutral, where the clutch capacity must be 0.
        flywheel: engine and flywheel.
        wheel: one driven wheel.
        most: the capacities.
    """
    half = 0.5 * ratio
    clutch_kgm2 = 1.0 / (flywheel.per_kgm2 + 2.0 * half * half * wheel.per_kgm2)
    friction = clip(before.engine_impulse_nms, -most.engine_nms, most.engine_nms)
    clutch = clip(before.clutch_impulse_nms, -most.clutch_nms, most.clutch_nms)
    left_brake = clip(before.left_impulse_nms, -most.left_nms, most.left_nms)
    right_brake = clip(before.right_impulse_nms, -most.right_nms, most.right_nms)
    bound = most.lock_nms + most.lock_share * abs(ratio * clutch)
    lock = clip(before.lock_impulse_nms, -bound, bound)
    engine = before.engine_radps - (friction + clutch) * flywheel.per_kgm2
    left = before.left_radps + (half * clutch - left_brake + lock) * wheel.per_kgm2
    right = before.right_radps + (half * clutch - right_brake - lock) * wheel.per_kgm2
    start = Shafts(
        engine_radps=engine,
        left_radps=left,
        right_radps=right,
        engine_impulse_nms=friction,
        clutch_impulse_nms=clutch,
        left_impulse_nms=left_brake,
        right_impulse_nms=right_brake,
        lock_impulse_nms=lock,
    )
    # Clutch and lock do not influence each other. While everything turns, engine friction and brakes are at their
    # bounds: then nothing changes after the first sweep, and its result is the solution.
    shafts = slowed(start, flywheel, wheel, most)
    sweeps = 0.0
    moved = True
    while moved and sweeps < MOST_SWEEPS:
        now = slowed(coupled(shafts, ratio, clutch_kgm2, flywheel, wheel, most), flywheel, wheel, most)
        moved = (
            now.engine_impulse_nms != shafts.engine_impulse_nms
            or now.left_impulse_nms != shafts.left_impulse_nms
            or now.right_impulse_nms != shafts.right_impulse_nms
        )
        shafts = now
        sweeps += 1.0
    # A held wheel gets exactly 0, not a rounding error: the tyre tests for 0 to know that its wheel is held.
    return Shafts(
        engine_radps=shafts.engine_radps,
        left_radps=0.0 if abs(shafts.left_impulse_nms) < most.left_nms else shafts.left_radps,
        right_radps=0.0 if abs(shafts.right_impulse_nms) < most.right_nms else shafts.right_radps,
        engine_impulse_nms=shafts.engine_impulse_nms,
        clutch_impulse_nms=shafts.clutch_impulse_nms,
        left_impulse_nms=shafts.left_impulse_nms,
        right_impulse_nms=shafts.right_impulse_nms,
        lock_impulse_nms=shafts.lock_impulse_nms,
    )


@kernel
def braked(wheel_radps: float, per_inertia_kgm2: float, capacity_nms: float) -> float:
    """Return the speed of a free-running wheel after its brake: at most to exactly 0."""
    return approach(wheel_radps, 0.0, capacity_nms * per_inertia_kgm2)
