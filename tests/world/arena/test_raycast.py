"""Ranges of rays against an oracle that knows neither grid nor kernel."""

import math

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import ArenaProfile
from simconsole.values.host.jit import compiled, plain
from simconsole.world.arena.outlines import Array, Outlines, outlines_of
from simconsole.world.arena.raycast import NO_HIT_M, RayGrid, cast, cast_all, ray_grid
from tests.bits import difference
from tests.samples import Sample

BAR_M = 1e-3
NOBODY = np.empty((0, 3))
MOST_M = 12.0


def oracle(rays: Array, outlines: Outlines, others: Array, most_m: float) -> Array:
    """Return the range of each ray: every obstacle in closed form, in vectors of all rays."""
    x, y, dx, dy = rays.T
    best = np.full(len(rays), math.inf)
    for ax, ay, bx, by in outlines.segments:
        matrix = np.stack(
            (np.stack((dx, np.full_like(dx, ax - bx)), -1), np.stack((dy, np.full_like(dy, ay - by)), -1)), -2
        )
        aside = np.abs(np.linalg.det(matrix)) > 1e-12
        solved = np.linalg.solve(matrix[aside], np.stack((ax - x, ay - y), -1)[aside][..., None])[..., 0]
        hit = (solved[:, 0] >= 0.0) & (solved[:, 1] >= 0.0) & (solved[:, 1] <= 1.0)
        best[aside] = np.where(hit, np.minimum(best[aside], solved[:, 0]), best[aside])
    for cx, cy, radius in (*outlines.circles, *others):
        half = (x - cx) * dx + (y - cy) * dy
        inside = half**2 - ((x - cx) ** 2 + (y - cy) ** 2 - radius**2)
        root = np.sqrt(np.maximum(inside, 0.0))
        for found in (-half - root, -half + root):
            best = np.where((inside >= 0.0) & (found >= 0.0), np.minimum(best, found), best)
    return np.where(best <= most_m, best, NO_HIT_M)


def rays_from(rng: np.random.Generator, count: int, low: float, high: float) -> Array:
    turns = rng.uniform(0.0, math.tau, count)
    return np.column_stack((rng.uniform(low, high, (count, 2)), np.cos(turns), np.sin(turns)))


def ranges_of(rays: Array, grid: RayGrid, others: Array, most_m: float = MOST_M) -> Array:
    ranges = np.empty(len(rays))
    compiled(cast_all)(rays, most_m, grid, others, ranges)
    return ranges


def test_ranges_are_those_of_the_closed_form_in_random_arenas(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    worst_m = 0.0
    for _ in range(sample.of(20, 400)):
        count = int(rng.integers(1, 60))
        middles = rng.uniform(-4.0, 4.0, (count, 2))
        ends = middles + rng.uniform(-2.0, 2.0, (count, 2))
        circles = np.column_stack((rng.uniform(-4.0, 4.0, (5, 2)), rng.uniform(0.02, 0.6, 5)))
        outlines = Outlines(np.column_stack((middles, ends)), circles)
        others = np.column_stack((rng.uniform(-4.0, 4.0, (3, 2)), np.full(3, 0.105)))
        rays = rays_from(rng, 500, -8.0, 8.0)
        for most_m in (3.5, MOST_M):
            found, known = ranges_of(rays, ray_grid(outlines), others, most_m), oracle(rays, outlines, others, most_m)
            assert (np.minimum(found, known) >= 0.0).all()
            edge = np.abs(known - most_m) < BAR_M  # there one of the two may just not see it
            worst_m = max(worst_m, float(np.abs(found - known)[~edge & (known < NO_HIT_M)].max(initial=0.0)))
            assert ((found == NO_HIT_M) == (known == NO_HIT_M))[~edge].mean() > 0.999, "but for rays through a very end"
    assert worst_m <= BAR_M


def test_from_inside_of_the_shipped_arena_no_ray_escapes() -> None:
    profile = load_world("arena")
    assert isinstance(profile, ArenaProfile)
    outlines, rng = outlines_of(profile), np.random.default_rng(1)
    rays = rays_from(rng, 20_000, 0.01, 5.99)
    rays[:100, 2:] = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)] * 25  # along the lines of the grid
    turns = np.arctan2([0.0, 0.0, 6.0, 6.0] - rays[100:104, 1], [0.0, 9.0, 9.0, 0.0] - rays[100:104, 0])
    rays[100:104, 2:] = np.column_stack((np.cos(turns), np.sin(turns)))  # into the corners
    found = ranges_of(rays, ray_grid(outlines), NOBODY)
    assert found.max() < math.hypot(9.0, 6.0)
    assert found == pytest.approx(oracle(rays, outlines, NOBODY, MOST_M), abs=BAR_M)


def test_both_executions_have_equal_bits(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    profile = load_world("arena")
    assert isinstance(profile, ArenaProfile)
    grid, others = ray_grid(outlines_of(profile)), np.array([(2.0, 3.0, 0.1)])
    rays = rays_from(rng, sample.of(300, 20_000), -2.0, 9.0)
    slow = np.empty(len(rays))
    plain(cast_all)(rays, 3.5, grid, others, slow)
    assert not difference(slow, ranges_of(rays, grid, others, 3.5))


def test_a_ray_stops_at_its_range_and_at_robots_in_the_way() -> None:
    grid = ray_grid(Outlines(np.array([(2.0, -1.0, 2.0, 1.0)]), np.empty((0, 3))))
    robot = np.array([(1.0, 0.0, 0.25)])
    assert cast(0.0, 0.0, 1.0, 0.0, 3.5, grid, NOBODY) == pytest.approx(2.0)
    assert cast(0.0, 0.0, 1.0, 0.0, 1.9, grid, NOBODY) == NO_HIT_M
    assert cast(0.0, 0.0, 1.0, 0.0, 3.5, grid, robot) == pytest.approx(0.75)
    assert cast(1.0, 0.0, 1.0, 0.0, 3.5, grid, robot) == pytest.approx(0.25), "from inside to the far side"
    assert cast(0.0, 0.0, -1.0, 0.0, 3.5, grid, robot) == NO_HIT_M
    assert cast(2.0, -3.0, 0.0, 1.0, 3.5, grid, NOBODY) == NO_HIT_M, "a wall seen along its line has no width"
