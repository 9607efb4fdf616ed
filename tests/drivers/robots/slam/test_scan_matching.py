import math
from itertools import pairwise

import numpy as np
import pytest

from simconsole.drivers.robots.slam.hit_map import HitMap, draw, empty_map, grown
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.drivers.robots.slam.scan_matching import Prior, fitted, line_at, misses, searched
from simconsole.values.host.jit import compiled, plain
from tests.samples import Sample

TIGHT, LOOSE = 1e6, 1.0


def room(rng: np.random.Generator, count: int = 400, noise_m: float = 0.005) -> Array:
    """Echoes on the walls of a room of 3 x 2 m about the origin, with a box in a corner: no turn looks like another."""
    corners = [(-1.5, -1.0), (1.5, -1.0), (1.5, 0.5), (1.0, 0.5), (1.0, 1.0), (-1.5, 1.0), (-1.5, -1.0)]
    places = []
    for a, b in pairwise(corners):
        shares = rng.random(count // 6)
        places.append(np.array(a) + shares[:, None] * (np.array(b) - np.array(a)))
    return np.concatenate(places) + rng.normal(0.0, noise_m, (6 * (count // 6), 2))


def field_of(points: Array) -> HitMap:
    field = grown(empty_map(0.0, 0.0, 0.05), points)
    lines = np.column_stack((np.zeros_like(points), points))
    for number in (1, 2):
        compiled(draw)(field, lines, np.ones(len(points)), number)
    return field


def seen_at(points: Array, x: float, y: float, yaw: float) -> Array:
    """The same places in the frame of a robot."""
    cosine, sine = math.cos(yaw), math.sin(yaw)
    return np.asarray((points - (x, y)) @ np.array(((cosine, -sine), (sine, cosine))))


def test_a_scan_fits_within_millimetres(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    field = field_of(room(rng))
    for _ in range(sample.of(20, 500)):
        x, y, yaw = rng.uniform((-0.3, -0.3, -3.0), (0.3, 0.3, 3.0)).tolist()
        off = rng.uniform(-0.03, 0.03, 3).tolist()
        guess = Prior(x + off[0], y + off[1], yaw + off[2], LOOSE, LOOSE)
        fit = compiled(fitted)(field, seen_at(room(rng), x, y, yaw), guess)
        assert math.hypot(fit.x_m - x, fit.y_m - y) < 0.006
        assert fit.yaw_rad == pytest.approx(yaw, abs=0.005)
        assert fit.near > 0.9 * (fit.near + fit.off)


def test_in_a_corridor_odometry_holds_along_the_walls(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    x = rng.uniform(-1.5, 1.5, 400)
    walls = np.column_stack((x, np.where(rng.random(400) < 0.5, -0.5, 0.5) + rng.normal(0.0, 0.005, 400)))
    fit = compiled(fitted)(field_of(walls), walls[100:300], Prior(0.02, 0.02, 0.02, TIGHT, LOOSE))
    assert fit.x_m == pytest.approx(0.02, abs=0.005)
    fit = compiled(fitted)(field_of(walls), walls[100:300], Prior(0.02, 0.02, 0.02, 100.0, LOOSE))
    assert fit.y_m == pytest.approx(0.0, abs=0.004)
    assert fit.xx < 0.01 * fit.yy, "what is not known is not claimed"


def test_things_that_are_not_on_the_map_hardly_count(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    field, scan = field_of(room(rng)), room(rng)
    scan[::6] = rng.uniform((0.2, -0.6), (0.5, -0.3), (len(scan[::6]), 2))  # somebody stands in the room
    fit = compiled(fitted)(field, scan, Prior(0.02, -0.02, 0.02, LOOSE, LOOSE))
    assert math.hypot(fit.x_m, fit.y_m) < 0.006
    assert fit.off >= len(scan[::6]) * 0.8


def test_a_robot_that_is_far_off_is_found_by_looking(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    field = field_of(room(rng, 900))
    guess = Prior(0.2, -0.2, 0.2, LOOSE, LOOSE)
    near = compiled(searched)(field, room(rng), guess, 0.3, 0.3)
    fit = compiled(fitted)(field, room(rng), near)
    assert math.hypot(fit.x_m, fit.y_m) < 0.01


def test_a_line_needs_echoes_that_lie_on_one() -> None:
    field = field_of(np.column_stack((np.linspace(-1.0, 1.0, 200), np.full(200, 0.52))))
    line = compiled(line_at)(field, 0.3, 0.53)
    assert (abs(line.normal_x), abs(line.normal_y)) == pytest.approx((0.0, 1.0), abs=1e-9)
    assert line.y_m == pytest.approx(0.52)
    nothing = compiled(line_at)(field, 0.3, 0.0)
    assert (nothing.normal_x, nothing.normal_y) == (0.0, 0.0)
    spot = field_of(np.full((50, 2), 0.52) + np.random.default_rng(1).normal(0.0, 0.004, (50, 2)))
    assert compiled(line_at)(spot, 0.52, 0.52).normal_x == 0.0


def test_both_executions_agree(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    field, scan = field_of(room(rng)), room(rng)[::8]
    prior = Prior(0.02, -0.02, 0.02, LOOSE, LOOSE)
    assert plain(fitted)(field, scan, prior) == compiled(fitted)(field, scan, prior)
    assert plain(misses)(field, scan, 0.0, 0.0, 0.1) == compiled(misses)(field, scan, 0.0, 0.0, 0.1)
    one, other = (run(searched)(field, scan, prior, 0.05, 0.04) for run in (plain, compiled))
    assert one == other
