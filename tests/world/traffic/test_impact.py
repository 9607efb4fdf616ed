"""Impulses against what mechanics keeps: momentum, angular momentum, and never more energy than before."""

import math

import numpy as np
import pytest

from simconsole.world.obstacles.impulse import FRICTION, RESTITUTION
from simconsole.world.traffic.impact import Change, Contact, Moving, collide, contact_of
from tests.samples import Sample
from tests.world.traffic.made import box

CAR = Moving(mass_kg=1400.0, yaw_inertia_kgm2=2200.0, x_m=0.0, y_m=0.0, vx_mps=0.0, vy_mps=0.0, yaw_rate_radps=0.0)
SPEEDS = (8.0, 8.0, 1.6)
FRONT = Contact(2.2, 0.0, -1.0, 0.0)


def after(body: Moving, change: Change) -> Moving:
    return body._replace(
        vx_mps=body.vx_mps + change.vx_mps,
        vy_mps=body.vy_mps + change.vy_mps,
        yaw_rate_radps=body.yaw_rate_radps + change.yaw_rate_radps,
    )


def energy(body: Moving) -> float:
    moving = body.mass_kg * (body.vx_mps**2 + body.vy_mps**2)
    return 0.5 * (moving + body.yaw_inertia_kgm2 * body.yaw_rate_radps**2)


def momentum(body: Moving) -> tuple[float, float, float]:
    x, y = body.mass_kg * body.vx_mps, body.mass_kg * body.vy_mps
    return x, y, body.x_m * y - body.y_m * x + body.yaw_inertia_kgm2 * body.yaw_rate_radps


def test_equal_cars_head_on_share_their_speed() -> None:
    one, other = CAR._replace(vx_mps=10.0), CAR._replace(x_m=4.4)
    changes = collide(one, other, FRONT)
    assert changes is not None
    mine, theirs = changes
    assert mine.vx_mps == pytest.approx(-0.5 * (1.0 + RESTITUTION) * 10.0)
    assert theirs.vx_mps == pytest.approx(-mine.vx_mps)
    assert (mine.vy_mps, mine.yaw_rate_radps) == pytest.approx((0.0, 0.0))


def test_who_is_struck_behind_the_middle_from_the_left_turns_left() -> None:
    one, other = CAR._replace(y_m=2.2, vy_mps=-5.0), CAR._replace(x_m=1.5)
    changes = collide(one, other, Contact(0.0, 0.9, 0.0, 1.0))
    assert changes is not None
    assert changes[1].vy_mps < -1.0
    assert changes[1].yaw_rate_radps > 0.1


def test_bodies_that_part_are_left_alone() -> None:
    assert collide(CAR._replace(vx_mps=-1.0), CAR._replace(x_m=4.4), FRONT) is None


def test_momentum_is_kept_and_energy_is_not_made(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    struck = 0
    for _ in range(sample.of(300, 20000)):
        bodies = [
            Moving(
                mass_kg, mass_kg * 1.5, *rng.uniform(-2.5, 2.5, 2).tolist(), *rng.normal(0.0, (8.0, 8.0, 1.6)).tolist()
            )
            for mass_kg in rng.choice((75.0, 1400.0, 2200.0), 2).tolist()
        ]
        turned = float(rng.uniform(-math.pi, math.pi))
        x_m, y_m = rng.uniform(-1.0, 1.0, 2).tolist()
        contact = Contact(x_m, y_m, math.cos(turned), math.sin(turned))
        changes = collide(bodies[0], bodies[1], contact)
        if changes is None:
            continue
        struck += 1
        moved = [after(body, change) for body, change in zip(bodies, changes, strict=True)]
        kept = [np.sum([momentum(body) for body in both], axis=0) for both in (bodies, moved)]
        assert kept[1] == pytest.approx(kept[0], rel=1e-9, abs=1e-6)
        assert sum(map(energy, moved)) <= sum(map(energy, bodies)) * (1.0 + 1e-9)
        push = [bodies[0].mass_kg * value for value in changes[0][:2]]
        along = push[0] * contact.normal_x + push[1] * contact.normal_y
        aside = push[1] * contact.normal_x - push[0] * contact.normal_y
        assert along > 0.0
        assert abs(aside) <= FRICTION * along * (1.0 + 1e-9)
    assert struck > 50


@pytest.mark.parametrize(
    ("x_m", "y_m", "towards", "normal"),
    [
        (4.2, 0.0, (10.0, 0.0), (-1.0, 0.0)),
        (3.9, 1.6, (14.0, 0.0), (-1.0, 0.0)),  # deep, and only at the corner: the front touched first all the same
        (0.3, 1.7, (8.0, 1.0), (0.0, -1.0)),
    ],
)
def test_the_sides_that_touched_last_in_time_are_those_that_meet(
    x_m: float, y_m: float, towards: tuple[float, float], normal: tuple[float, float]
) -> None:
    found = contact_of(box(0.0, 0.0), box(x_m, y_m), towards)
    assert found is not None
    assert found[2:] == pytest.approx(normal, abs=1e-9)
    assert abs(found.x_m) <= 2.25 + 1e-9
    assert abs(found.y_m) <= 0.9 + 1e-9


def test_no_contact_without_overlap_or_approach() -> None:
    assert contact_of(box(0.0, 0.0), box(9.0, 0.0), (10.0, 0.0)) is None
    assert contact_of(box(0.0, 0.0), box(4.2, 0.0), (0.0, 0.0)) is None
