"""Impulses against what friction and restitution allow."""

import numpy as np
import pytest

from simconsole.values.host.jit import compiled, plain
from simconsole.world.obstacles.impulse import FRICTION, RESTITUTION, Impulse, Mobility, impulse
from tests.samples import Sample

CAR = Mobility(normal=1.0 / 1400.0, along=1.0 / 1400.0, mixed=0.0)


def change(normal_mps: float) -> float:
    return -(1.0 + RESTITUTION) * normal_mps


def test_straight_on_the_approach_ends_but_for_the_restitution() -> None:
    push = impulse(-10.0, 0.0, change(-10.0), CAR)
    assert push.normal_ns == pytest.approx(1400.0 * 11.0)
    assert push.along_ns == 0.0


@pytest.mark.parametrize("sliding_mps", [3.0, -3.0])
def test_slow_sliding_ends_and_fast_sliding_gets_all_friction(sliding_mps: float) -> None:
    held = impulse(-10.0, sliding_mps, change(-10.0), CAR)
    assert held.along_ns == pytest.approx(-1400.0 * sliding_mps)
    slides = impulse(-1.0, sliding_mps, change(-1.0), CAR)
    assert slides.along_ns == pytest.approx(-np.sign(sliding_mps) * FRICTION * slides.normal_ns)


def test_bodies_that_part_are_left_alone() -> None:
    assert impulse(0.5, 2.0, 0.1, CAR) == Impulse(0.0, 0.0)


def test_friction_and_the_wanted_change_hold_of_any_bodies(sample: Sample) -> None:
    rng, quick = np.random.default_rng(sample.seed), compiled(impulse)
    for _ in range(sample.of(300, 20_000)):
        masses, arms = 1.0 / rng.uniform(50.0, 3000.0, 2), rng.uniform(-2.0, 2.0, 2)
        inertia = rng.uniform(1e-4, 2e-3)
        at = Mobility(
            normal=masses.sum() + arms[0] ** 2 * inertia,
            along=masses.sum() + arms[1] ** 2 * inertia,
            mixed=arms.prod() * inertia,
        )
        normal, sliding = rng.uniform(-20.0, -0.01), rng.uniform(-20.0, 20.0)
        push = impulse(normal, sliding, change(normal), at)
        assert push.normal_ns > 0.0
        assert abs(push.along_ns) <= FRICTION * push.normal_ns * (1.0 + 1e-9)
        changed = push.normal_ns * at.normal + push.along_ns * at.mixed
        assert changed == pytest.approx(change(normal))
        assert tuple(quick(normal, sliding, change(normal), at)) == tuple(
            plain(impulse)(normal, sliding, change(normal), at)
        )
