"""The template of a world of one's own, as a package that registers it. `$name` is what the user called it."""

from typing import Final

ENTRY: Final = ("simconsole.worlds", "WORLD")
"""The group of its entry point, and what that names in its module."""

WORLD: Final = '''\
"""$name: a world of one's own. `pip install -e .` registers it; a session names `$name.yaml` beside it.

A round track with two straights, over a hill. Equal parameters must make an equal world, or drives do not replay.
"""

import math

import numpy as np

from simconsole.values.height_field import Grid, HeightField
from simconsole.values.platform import Pose
from simconsole.values.registered import Bounded
from simconsole.world.drawing import Drawing
from simconsole.world.path_geometry import Piece, travel
from simconsole.world.registered import OwnWorld, WorldSettings
from simconsole.world.route import Route, Stretch
from simconsole.world.world import World

PARAMETERS = {
    "straight_m": Bounded(120.0, 10.0, 2000.0),
    "radius_m": Bounded(30.0, 8.0, 500.0),
    "hill_m": Bounded(1.0, 0.0, 5.0),
    "limit_kmh": Bounded(50.0, 5.0, 200.0),
}
"""Each with what it is, and between which values a profile may put it."""
HALF_M, CHUNK_M, CELL_M, BESIDE_M = 1.75, 10.0, 5.0, 30.0


def route_of(straight_m, radius_m, limit_mps):
    """Return the track, once round to the left."""
    half = Piece(math.pi * radius_m, 1.0 / radius_m, 1.0 / radius_m)
    pose, s_m, stretches = Pose(0.0, 0.0, 0.0), 0.0, []
    for piece in (Piece(straight_m, 0.0, 0.0), half) * 2:
        stretches.append(Stretch(s_m, pose, piece, limit_mps))
        pose, s_m = travel(pose, piece), s_m + piece.length_m
    return Route(stretches, closed=True)


def draw(route):
    """Return what there is to see: asphalt, its edges, and the path."""
    ends = np.linspace(0.0, route.length_m, math.ceil(route.length_m / CHUNK_M) + 1).tolist()
    sides = [[route.offset(side, a, b, 1.0) for side in (-HALF_M, HALF_M)] for a, b in zip(ends, ends[1:])]
    return Drawing(
        surfaces=tuple(np.concatenate((right, left[::-1])) for right, left in sides),
        islands=(),
        edges=tuple(route.offset(side, 0.0, route.length_m, 1.0) for side in (-HALF_M, HALF_M)),
        centre_lines=(),
        zebras=(),
        stop_lines=(),
        lights=(),
        path=route.offset(0.0, 0.0, route.length_m, 1.0),
    )


def ground(route, hill_m):
    """Return a hill over the whole track: a height and the distance from the road's edge at each node."""
    from_x_m, from_y_m = route.x.min() - BESIDE_M, route.y.min() - BESIDE_M
    columns = math.ceil((route.x.max() + BESIDE_M - from_x_m) / CELL_M) + 1
    rows = math.ceil((route.y.max() + BESIDE_M - from_y_m) / CELL_M) + 1
    x, y = np.linspace(-1.0, 1.0, columns), np.linspace(-1.0, 1.0, rows)[:, None]
    nodes = np.empty((rows, columns, 2))
    nodes[..., 0] = hill_m * np.cos(0.5 * math.pi * x) * np.cos(0.5 * math.pi * y)
    nodes[..., 1] = -1.0  # everywhere as on the road
    grid = Grid(
        from_x_m=float(from_x_m),
        from_y_m=float(from_y_m),
        cell_m=CELL_M,
        per_cell_m=1.0 / CELL_M,
        columns=float(columns),
        rows=float(rows),
        kerb_m=0.0,
        off_road_share=1.0,
    )
    return HeightField(grid, nodes)


def make(settings: WorldSettings) -> World:
    """Return the world: its route at once, drawing and ground when somebody asks for them."""
    straight_m, radius_m, hill_m, limit_kmh = (settings.parameters[name] for name in PARAMETERS)
    route = route_of(straight_m, radius_m, limit_kmh / 3.6)
    return World(
        settings.profile.title,
        route,
        lambda: draw(route),
        (lambda: ground(route, hill_m)) if hill_m else None,
    )


WORLD = OwnWorld(PARAMETERS, make)
'''

PROFILE: Final = """\
# $name: a session or scenario beside it names it `$name.yaml` (environment.world).
kind: own
schema: 1
title: $name
name: $name
parameters: {straight_m: 100.0}
"""

TEST: Final = '''\
"""$name keeps the contract of worlds, and is as long as its formulas say. No installation is needed for this."""

import math
from pathlib import Path
from runpy import run_path

import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import OwnWorldProfile
from simconsole.values.errors import ProfileError
from simconsole.world.contract import problems
from simconsole.world.registered import make_own

HERE = Path(__file__).parent
WORLD = run_path(str(HERE / "$name.py"))["WORLD"]


def made(**parameters):
    profile = load_world(str(HERE / "$name.yaml"))
    values = {**profile.parameters, **parameters}
    return make_own(OwnWorldProfile(schema=1, title=profile.title, name="$name", parameters=values), WORLD)


@pytest.mark.parametrize("hill_m", [0.0, 2.0])
def test_it_keeps_the_contract(hill_m):
    assert problems(made(hill_m=hill_m), made(hill_m=hill_m)) == []


def test_it_is_as_long_as_its_formula_says():
    assert made(radius_m=20.0).route.length_m == pytest.approx(2.0 * (100.0 + 20.0 * math.pi))


def test_its_parameters_have_bounds():
    with pytest.raises(ProfileError, match="parameters: radius_m: value 1: 8 to 500"):
        made(radius_m=1.0)
    with pytest.raises(ProfileError, match="parameters: wings: one of"):
        made(wings=1.0)
'''
