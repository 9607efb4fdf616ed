"""The crossings of a road map: where each leads, who controls it, and where lanes for cars lead over it."""

import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator
from itertools import pairwise
from typing import NamedTuple

from simconsole.world.roads.road_map import CROSSING, Array, RoadMap


class Strip(NamedTuple):
    """Where a lane for cars leads over a crossing."""

    crossing: int  # place in the map's edges
    lane: int
    near_m: float  # way along the lane to where the crossing begins; negative where it begins before the lane does
    far_m: float
    low_m: float  # way along the crossing to where the lane begins
    high_m: float


class Crossing(NamedTuple):
    """A crossing, as people walk over it along its first lane."""

    edge: int
    line: Array
    length_m: float
    width_m: float
    signal: int
    link: int
    strips: tuple[Strip, ...]


def crossings_of(road_map: RoadMap, lanes: Collection[int] | None = None) -> list[Crossing]:
    """Return the crossings that lanes for cars lead over; of them only those over one of `lanes`, if it is given."""
    movements: dict[int, set[int]] = defaultdict(set)
    for one in road_map.connections:
        if road_map.lanes[one.from_lane].drivable and road_map.lanes[one.to_lane].drivable:
            for end in (one.from_lane, one.to_lane):
                movements[road_map.lanes[end].edge].update(one.via)
    found = []
    for place, edge in enumerate(road_map.edges):
        if edge.function != CROSSING or not edge.lanes:
            continue
        near = sorted({lane for crossed in edge.crossed for lane in movements[crossed]})
        if lanes is not None:
            near = [lane for lane in near if lane in lanes]
        strips = tuple(_strips(road_map, place, near))
        if strips:
            lane = road_map.lanes[edge.lanes[0]]
            found.append(
                Crossing(
                    edge=place,
                    line=lane.line[:, :2],
                    length_m=lane.length_m,
                    width_m=lane.width_m,
                    signal=edge.signal,
                    link=edge.link,
                    strips=strips,
                )
            )
    return found


def _strips(road_map: RoadMap, crossing: int, lanes: Iterable[int]) -> Iterator[Strip]:
    walked = road_map.lanes[road_map.edges[crossing].lanes[0]]
    for place in lanes:
        driven = road_map.lanes[place]
        met = _meeting(driven.line, walked.line)
        if met is None:
            continue
        s_m, u_m, sine = met
        steep = max(abs(sine), 0.3)  # a lane that leads along a crossing is not as long on it as the map may say
        along, across = 0.5 * walked.width_m / steep, 0.5 * driven.width_m / steep
        yield Strip(
            crossing=crossing,
            lane=place,
            near_m=s_m - along,
            far_m=s_m + along,
            low_m=max(0.0, u_m - across),
            high_m=min(walked.length_m, u_m + across),
        )


def _meeting(one: Array, other: Array) -> tuple[float, float, float] | None:
    """Return where two lines meet first: way along each (m), sine of the angle from one to the other; None: nowhere."""
    s = 0.0
    for (ax, ay), (bx, by) in pairwise(one[:, :2].tolist()):
        dx, dy = bx - ax, by - ay
        length, u = math.hypot(dx, dy), 0.0
        for (cx, cy), (ex, ey) in pairwise(other[:, :2].tolist()):
            fx, fy = ex - cx, ey - cy
            reach = math.hypot(fx, fy)
            cross = dx * fy - dy * fx
            if abs(cross) > 1e-9:
                share = ((cx - ax) * fy - (cy - ay) * fx) / cross
                there = ((cx - ax) * dy - (cy - ay) * dx) / cross
                if 0.0 <= share <= 1.0 and 0.0 <= there <= 1.0:
                    return s + share * length, u + there * reach, cross / (length * reach)
            u += reach
        s += length
    return None
