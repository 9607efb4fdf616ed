"""The ways of people on foot as flat arrays: from the pavement over a crossing to the pavement on the other side."""

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.world.people.crossings import Crossing, Strip
from simconsole.world.roads.road_map import ROAD, Array, RoadMap

Numbers = NDArray[np.int64]

KERB_M: Final = 1.0
"""So far from the carriageway people wait."""
PAVEMENT_M: Final = 15.0
"""So far from a crossing they come, and go, along the pavement."""
SEEN_M: Final = 90.0
"""Vehicles whose way to a crossing is longer do not matter to those who want to cross."""
_NEAR_M: Final = 8.0  # a pavement whose end is further from the crossing's end does not lead there
_OUT_M: Final = 4.0  # where no pavement leads there, people come from so far


class Footways(NamedTuple):
    """Ways and strips by their numbers; rows of several of one begin at `..._starts[number]`."""

    points: Array  # of all ways: x, y (m), way from the beginning (m)
    point_starts: Numbers
    kerbs_m: Array  # way to where people wait
    ons_m: Array  # to where the carriageway begins
    offs_m: Array  # to where it ends
    widths_m: Array  # of the crossing
    left: Array  # left of the way on the crossing, a unit vector [ways, 2]: along the road
    crossings: Numbers  # which one the way leads over
    strips: Numbers  # that the way leads over, in its order
    strip_starts: Numbers
    lows_m: Array  # of the same: way to where the strip begins and ends
    highs_m: Array
    near_m: Array  # of strips: way along their lane to the crossing
    over_m: Array  # of strips: how wide the crossing is along the lane
    over: Numbers  # strips of each lane of the map
    over_starts: Numbers
    reach_lanes: Numbers  # lanes from which vehicles come to a strip
    reach_m: Array  # way from the beginning of the lane to the crossing
    reach_starts: Numbers


def footways(road_map: RoadMap, crossings: Sequence[Crossing]) -> Footways:
    """Return the ways over the crossings of a map, two for each, one in each direction."""
    all_strips = [strip for crossing in crossings for strip in crossing.strips]
    first = np.concatenate(((0,), np.cumsum([len(crossing.strips) for crossing in crossings], dtype=np.int64)))
    lines, kerbs, ons, offs, left, own = [], [], [], [], [], []
    for number, crossing in enumerate(crossings):
        ends = [_pavement(road_map, crossing, end) for end in (0, -1)]
        for forth in (True, False):
            before, after = ends if forth else ends[::-1]
            walked = crossing.line if forth else crossing.line[::-1]
            line = np.vstack((before[::-1], walked, after))
            way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
            on = float(way[len(before)])
            lines.append(np.column_stack((line, way)))
            kerbs.append(on - KERB_M)
            ons.append(on)
            offs.append(on + crossing.length_m)
            across = walked[-1] - walked[0]
            left.append((-across[1], across[0]) / np.hypot(*across))
            own.append(sorted(_along(crossing, int(first[number]), on, forth)))
    by_lane: dict[int, list[int]] = defaultdict(list)
    for place, strip in enumerate(all_strips):
        by_lane[strip.lane].append(place)
    reach = _reaches(road_map, all_strips)
    over, over_starts = _rows([by_lane[lane] for lane in range(len(road_map.lanes))])
    strips, strip_starts = _rows([[place for _, _, place in some] for some in own])
    reach_lanes, reach_starts = _rows([list(some) for some in reach])
    return Footways(
        points=np.vstack(lines) if lines else np.zeros((0, 3)),
        point_starts=_starts([len(line) for line in lines]),
        kerbs_m=np.array(kerbs),
        ons_m=np.array(ons),
        offs_m=np.array(offs),
        widths_m=np.array([crossing.width_m for crossing in crossings for _ in range(2)]),
        left=np.array(left).reshape(-1, 2),
        crossings=np.array([number for number in range(len(crossings)) for _ in range(2)], np.int64),
        strips=strips,
        strip_starts=strip_starts,
        lows_m=np.array([low for some in own for low, _, _ in some]),
        highs_m=np.array([high for some in own for _, high, _ in some]),
        near_m=np.array([strip.near_m for strip in all_strips]),
        over_m=np.array([strip.far_m - strip.near_m for strip in all_strips]),
        over=over,
        over_starts=over_starts,
        reach_lanes=reach_lanes,
        reach_m=np.array([way for some in reach for way in some.values()]),
        reach_starts=reach_starts,
    )


def _along(crossing: Crossing, first: int, on_m: float, forth: bool) -> Iterator[tuple[float, float, int]]:
    """Yield where each strip begins and ends on a way, and its number."""
    for place, strip in enumerate(crossing.strips, first):
        low, high = strip.low_m, strip.high_m
        if not forth:
            low, high = crossing.length_m - high, crossing.length_m - low
        yield on_m + low, on_m + high, place


def _pavement(road_map: RoadMap, crossing: Crossing, end: int) -> Array:
    """Return the way from one end of a crossing on: to where people wait, and along the pavement that begins there."""
    x, y = crossing.line[end].tolist()
    inner = crossing.line[1 if end == 0 else -2]
    dx, dy = x - float(inner[0]), y - float(inner[1])
    length = math.hypot(dx, dy)
    dx, dy = dx / length, dy / length
    waiting = np.array(((x + KERB_M * dx, y + KERB_M * dy),))
    best, line = _NEAR_M, np.array(((x + _OUT_M * dx, y + _OUT_M * dy),))
    for edge in road_map.edges[crossing.edge].crossed:
        if road_map.edges[edge].function != ROAD:
            continue
        for place in road_map.edges[edge].lanes:
            lane = road_map.lanes[place]
            if lane.drivable:
                continue
            for pavement in (lane.line[:, :2], lane.line[::-1, :2]):
                away = math.hypot(float(pavement[0, 0]) - x, float(pavement[0, 1]) - y)
                if away < best:
                    best, line = away, _first(pavement)
    return np.vstack((waiting, line))


def _first(line: Array) -> Array:
    """Return the first PAVEMENT_M of a line."""
    way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    end = min(PAVEMENT_M, float(way[-1]))
    last = [[float(np.interp(end, way, line[:, axis])) for axis in (0, 1)]]
    return np.vstack((line[way < end], last))


def _reaches(road_map: RoadMap, strips: Sequence[Strip]) -> list[dict[int, float]]:
    """Return for each strip the lanes that lead there within SEEN_M, each with its way from its beginning."""
    before: dict[int, list[int]] = defaultdict(list)
    for one in road_map.connections:
        if road_map.lanes[one.from_lane].drivable:
            chain = (one.from_lane, *one.via, one.to_lane)
            for lane, following in pairwise(chain):
                if lane not in before[following]:
                    before[following].append(lane)
    found = []
    for strip in strips:
        reach = {strip.lane: strip.near_m}
        todo = [strip.lane]
        while todo:
            lane = todo.pop()
            for other in before[lane] if reach[lane] < SEEN_M else ():
                way = reach[lane] + road_map.lanes[other].length_m
                if way < reach.get(other, math.inf):
                    reach[other] = way
                    todo.append(other)
        found.append(reach)
    return found


def _starts(counts: Sequence[int]) -> Numbers:
    return np.concatenate(((0,), np.cumsum(counts, dtype=np.int64))).astype(np.int64)


def _rows(some: Sequence[Sequence[int]]) -> tuple[Numbers, Numbers]:
    return np.array([value for one in some for value in one], np.int64), _starts([len(one) for one in some])
