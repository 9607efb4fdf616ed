import math
from itertools import pairwise

import numpy as np
import pytest

from simconsole.hud.driver_view.scene import world_parts
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import ArenaProfile, Pillar, Spot
from simconsole.scene.entities import world_shapes
from simconsole.world.arena.arena_world import AHEAD_M, ArenaWorld, arena_of
from simconsole.world.arena.raycast import cast, ray_grid
from simconsole.world.drawing_arrays import from_arrays, to_arrays
from simconsole.world.kinds.worlds import open_world

NOBODY = np.empty((0, 3))


def shipped() -> ArenaWorld:
    world = arena_of(open_world(load_world("arena")))
    assert world is not None
    return world


def test_shipped_arena_is_6_by_9_m_with_five_targets_and_three_starts() -> None:
    world = shipped()
    ends = world.outlines.segments.reshape(-1, 2)
    assert (ends.min(axis=0).tolist(), ends.max(axis=0).tolist()) == ([0.0, 0.0], [9.0, 6.0])
    assert [spot.name for spot in world.profile.targets] == ["A", "B", "C", "D", "E"]
    assert len(world.profile.starts) == 3
    assert arena_of(open_world(load_world("urban"))) is None


def test_a_robot_can_drive_the_way_round() -> None:
    world = shipped()
    grid = ray_grid(world.outlines)
    points = world.profile.round
    assert points is not None
    for a, b in pairwise(points):
        length_m = math.hypot(b.x_m - a.x_m, b.y_m - a.y_m)
        dx, dy = (b.x_m - a.x_m) / length_m, (b.y_m - a.y_m) / length_m
        for aside_m in (-0.3, 0.0, 0.3):
            x, y = a.x_m - aside_m * dy, a.y_m + aside_m * dx
            assert cast(x, y, dx, dy, 20.0, grid, NOBODY) > length_m, (a, b)
    assert world.route.length_m > 30.0
    assert world.route.speed_limit_mps == 0.2


def test_an_arena_without_a_way_round_begins_straight_ahead() -> None:
    profile = ArenaProfile(
        schema=1,
        title="t",
        pillars=(Pillar(x_m=0.0, y_m=0.0, radius_m=0.5),),
        starts=(Spot(name="a", x_m=2.0, y_m=1.0, yaw_deg=90.0),),
    )
    route = ArenaWorld(profile).route
    assert route.length_m == AHEAD_M
    assert (route.at(0.5).x_m, route.at(0.5).y_m) == pytest.approx((2.0, 1.5))


def test_walls_are_seen_by_driver_and_operators_and_no_trees_grow_indoors() -> None:
    drawing = shipped().drawing
    again = from_arrays(to_arrays(drawing))
    assert again is not None
    assert all((a == b).all() for a, b in zip(drawing.walls, again.walls, strict=True))
    parts = {part.name: part.mesh for part in world_parts(drawing, ())}
    assert parts["walls"]["position"][:, 2].max() == 0.5
    assert len(parts["trees"]) == len(parts["buildings"]) == len(parts["kerbs"]) == 0
    shapes = world_shapes(drawing)
    assert len(shapes.walls.triangles) == 2 * sum(len(line) - 1 for line in drawing.walls)
    assert shapes.walls.vertices[:, 2].max() == 0.5
    assert len(shapes.wall_lines) == len(drawing.walls)
