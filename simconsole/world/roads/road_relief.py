"""The ground of a road map: heights as its lanes have them, banked in bends, kerbs and verges beside them."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from simconsole.profiles.world import GroundProfile
from simconsole.values.height_field import HeightField
from simconsole.world.relief.compile_field import MARGIN_M, Edges, height_field
from simconsole.world.relief.strips import Array, Strips, banks, evenly, rounded, strip, together
from simconsole.world.roads.road_map import ROAD, Edge, Lane, RoadMap
from simconsole.world.route import Route

SHORTEST_M: Final = 3.0
"""Of a lane whose ends, written in centimetres, say how steep it is; its neighbours close the gap."""
FADE_M: Final = 40.0
"""Way over which a bank comes in before a bend and goes out before a junction."""


def road_field(road_map: RoadMap, route: Route, ground: GroundProfile) -> HeightField:
    """Return the field of a map around a route."""
    shape = together(_near(part, route) for part in _strips(road_map, ground))
    return height_field(shape, shape, Edges(ground.kerb_m, ground.off_road_friction_share))


def _near(part: Strips, route: Route) -> Strips:
    """Return the points of a strip that lie in the rectangle around a route."""
    low_x, high_x = float(route.x.min()) - MARGIN_M, float(route.x.max()) + MARGIN_M
    low_y, high_y = float(route.y.min()) - MARGIN_M, float(route.y.max()) + MARGIN_M
    keep = (part.x_m > low_x) & (part.x_m < high_x) & (part.y_m > low_y) & (part.y_m < high_y)
    return Strips(*(column[keep] for column in part))


def _strips(road_map: RoadMap, ground: GroundProfile) -> Iterator[Strips]:
    for edge in road_map.edges:
        lanes = [road_map.lanes[place] for place in edge.lanes]
        for place, lane in enumerate(lanes):
            if lane.drivable and lane.length_m >= SHORTEST_M:
                yield _lane_strip(edge, lane, lanes[place + 1 :], ground)


def _lane_strip(edge: Edge, lane: Lane, to_the_left: list[Lane], ground: GroundProfile) -> Strips:
    line = evenly(lane.line)
    line[:, 2] = rounded(line[:, 2], ground.vertical_curve_m)
    bank: Array = np.zeros(len(line))
    if edge.function == ROAD and ground.bank_percent > 0.0:
        bank = banks(line, 0.01 * ground.bank_percent, ground.bank_full_radius_m, FADE_M)
        # A road turns about its axis, which the edge's leftmost lane has on its left.
        axis_m = 0.5 * lane.width_m + sum(other.width_m for other in to_the_left)
        line[:, 2] -= bank * axis_m
    half = 0.5 * lane.width_m
    return strip(line, bank, half, half)
