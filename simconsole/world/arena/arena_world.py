"""The world of an arena: its obstacles, a way round in it, and a drawing."""

import math
from functools import partial
from itertools import pairwise
from typing import Final

import numpy as np

from simconsole.profiles.world import ArenaPoint, ArenaProfile
from simconsole.values.platform import Pose
from simconsole.values.units import RAD_PER_DEG
from simconsole.world.arena.outlines import bounds, outlines_of, wall_lines
from simconsole.world.drawing import Drawing
from simconsole.world.path_geometry import Piece
from simconsole.world.route import Route, Stretch
from simconsole.world.world import World

ROUND_MPS: Final = 0.2
"""Speed limit on the way round: what a small robot can drive."""
AHEAD_M: Final = 1.0
"""Length of the route of an arena without a way round: straight ahead from the first start."""
_STEP_M: Final = 0.25
_MARGIN_M: Final = 0.25


class ArenaWorld(World):
    """The world of an arena."""

    def __init__(self, profile: ArenaProfile) -> None:
        route = _route(profile)
        super().__init__(profile.title, route, partial(_draw, profile, route))
        self.profile = profile
        self.outlines = outlines_of(profile)


def arena_of(world: World) -> ArenaWorld | None:
    """Return the world as an arena, None where it is of another kind."""
    return world if isinstance(world, ArenaWorld) else None


def _route(profile: ArenaProfile) -> Route:
    """Return the way round, or a piece straight ahead."""
    first = profile.starts[0]
    yaw = first.yaw_deg * RAD_PER_DEG
    ahead = ArenaPoint(x_m=first.x_m + AHEAD_M * math.cos(yaw), y_m=first.y_m + AHEAD_M * math.sin(yaw))
    points = profile.round or (ArenaPoint(x_m=first.x_m, y_m=first.y_m), ahead)
    stretches, s_m = [], 0.0
    for a, b in pairwise(points):
        x_m, y_m = b.x_m - a.x_m, b.y_m - a.y_m
        length_m = math.hypot(x_m, y_m)
        stretches.append(Stretch(s_m, Pose(a.x_m, a.y_m, math.atan2(y_m, x_m)), Piece(length_m, 0.0, 0.0), ROUND_MPS))
        s_m += length_m
    return Route(stretches)


def _draw(profile: ArenaProfile, route: Route) -> Drawing:
    west, south, east, north = bounds(outlines_of(profile))
    floor = np.array(
        (
            (west - _MARGIN_M, south - _MARGIN_M),
            (east + _MARGIN_M, south - _MARGIN_M),
            (east + _MARGIN_M, north + _MARGIN_M),
            (west - _MARGIN_M, north + _MARGIN_M),
        )
    )
    return Drawing(
        surfaces=(floor,),
        islands=(),
        edges=(),
        centre_lines=(),
        zebras=(),
        stop_lines=(),
        lights=(),
        path=route.offset(0.0, 0.0, route.length_m, _STEP_M),
        walls=wall_lines(profile),
    )
