"""A lidar that turns while its robot moves, against an oracle that takes each ray by itself."""

import math

import numpy as np
import pytest

from simconsole.values.host.jit import compiled, plain
from simconsole.world.arena.lidar import NOTHING_M, Beam, End, between, sweep
from simconsole.world.arena.outlines import Array, outlines_of
from simconsole.world.arena.raycast import NO_HIT_M, RayGrid, ray_grid
from tests.bits import difference
from tests.world.arena.shipped_arena import arena
from tests.world.arena.test_raycast import oracle

BEAM = Beam(x_m=-0.032, min_m=0.12, max_m=3.5, turn_s=0.2)
STILL = End(2.0, 1.0, 0.3, 0.0, 0.0, 0.0)
NOBODY = np.empty((0, 3))
RAYS = 360


def swept(grid: RayGrid, begin: End, end: End, others: Array = NOBODY, noise: Array | None = None) -> Array:
    ranges = np.empty(RAYS)
    compiled(sweep)(begin, end, BEAM, grid, others, np.zeros(RAYS) if noise is None else noise, ranges)
    return ranges


def circling(seconds: float) -> End:
    """A robot that drives at 0.2 m/s and turns at 1 rad/s."""
    yaw = 0.3 + seconds
    return End(
        2.0 + 0.2 * (math.sin(yaw) - math.sin(0.3)), 1.0 - 0.2 * (math.cos(yaw) - math.cos(0.3)), yaw,
        0.2 * math.cos(yaw), 0.2 * math.sin(yaw), 1.0,
    )  # fmt: skip


def test_each_ray_starts_where_the_robot_is_at_its_time() -> None:
    outlines, others = outlines_of(arena()), np.array([(2.0, 2.5, 0.105)])
    found = swept(ray_grid(outlines), circling(0.0), circling(0.2), others)
    rays = []
    for index in range(RAYS):
        here = circling(0.2 * index / RAYS)
        x, y = here.x_m - 0.032 * math.cos(here.yaw_rad), here.y_m - 0.032 * math.sin(here.yaw_rad)
        angle = here.yaw_rad + math.tau * index / RAYS
        rays.append((x, y, math.cos(angle), math.sin(angle)))
    known = oracle(np.array(rays), outlines, others, 3.5)
    known = np.where((known < BEAM.min_m) | (known == NO_HIT_M), NOTHING_M, known)
    assert (np.abs(found - known) <= 1e-3).mean() > 0.99, "but for rays past a corner"
    still = swept(ray_grid(outlines), circling(0.0), circling(0.0)._replace(yaw_rad=0.3), others)
    assert np.abs(still - known).max() > 0.05, "a robot that moved sees something else"


def test_what_is_too_near_or_too_far_has_no_echo() -> None:
    grid = ray_grid(outlines_of(arena()))
    near = swept(grid, STILL._replace(x_m=0.15), STILL._replace(x_m=0.15))
    assert set(near[near < BEAM.min_m]) == {NOTHING_M}
    far = swept(grid, STILL._replace(x_m=5.0, y_m=3.5), STILL._replace(x_m=5.0, y_m=3.5))
    assert (far == NOTHING_M).any()
    assert far.max() <= BEAM.max_m


def test_noise_is_added_to_echoes_alone() -> None:
    grid = ray_grid(outlines_of(arena()))
    clean, noise = swept(grid, STILL, STILL), np.full(RAYS, 0.01)
    noisy = swept(grid, STILL, STILL, noise=noise)
    both = (clean > 0.0) & (noisy > 0.0)
    assert noisy[both] == pytest.approx(clean[both] + 0.01)
    assert both.sum() > 300


def test_between_two_ends_goes_the_cubic_with_their_rates() -> None:
    def cubic(t: float) -> float:
        return 1.0 + 2.0 * t - 3.0 * t**2 + 0.5 * t**3

    def rate(t: float) -> float:
        return 2.0 - 6.0 * t + 1.5 * t**2

    for share in (0.0, 0.3, 1.0):
        found = between(cubic(0.0), cubic(0.2), rate(0.0), rate(0.2), 0.2, share)
        assert found == pytest.approx(cubic(0.2 * share))


def test_both_executions_have_equal_bits() -> None:
    grid, slow = ray_grid(outlines_of(arena())), np.empty(RAYS)
    plain(sweep)(circling(0.0), circling(0.2), BEAM, grid, NOBODY, np.zeros(RAYS), slow)
    assert not difference(slow, swept(grid, circling(0.0), circling(0.2)))
