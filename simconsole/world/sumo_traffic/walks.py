"""Where SUMO's people walk: along pavements, and from one to another over the crossings of a junction. Pure.

A walking area that is laid over lanes for cars (netconvert does so at roundabouts without crossings, and where a road
ends) is no way: people would walk on the carriageway there, and SUMO's look at no vehicle. Nor is any way taken between
two pavements that meet at such an area: by which of their ends they get there is SUMO's choice.
"""

from collections import defaultdict
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.world.roads.road_map import CROSSING, ROAD, WALKING_AREA, Array, RoadMap

FASTEST_MPS: Final = 2.0
"""Nobody walks faster: SUMO's people make 1.39 m/s, with a deviation of a tenth."""
_MEETS_M: Final = 0.5  # pavements and crossings end at the outline of the walking area that they lead to
_ON_LANE_M: Final = 0.9  # an area that comes nearer than this to the middle of a lane lies on it
_STEP_M: Final = 1.0


class Pavement(NamedTuple):
    """One pavement, and which others it leads to: the number of a group that meets there, -1: none."""

    edge: int  # place in the map's edges
    length_m: float
    at_begin: int
    at_end: int
    on_lanes: frozenset[int]  # the areas on the carriageway that it leads to, by their numbers


class Met(NamedTuple):
    """A pavement of a group."""

    pavement: int  # place in `Pavements.pavements`
    at_end: bool  # it is its end that leads there


class Pavements(NamedTuple):
    """All pavements of a map, and the groups that meet at junctions."""

    pavements: tuple[Pavement, ...]
    groups: tuple[tuple[Met, ...], ...]


class Walk(NamedTuple):
    """Pavements, one after the other, as places in the map's edges."""

    edges: tuple[int, ...]
    ends_at_end: bool  # at which end of the last one


class _Areas(NamedTuple):
    """Walking areas by their numbers: outlines, and boxes a little larger than they are, float64 [areas, 2]."""

    outlines: list[Array]
    lows: Array
    highs: Array


def pavements_of(road_map: RoadMap) -> Pavements:
    """Return the pavements of a map beside roads, and where people get from one to another."""
    lanes = road_map.lanes
    beside, on_lanes = _walking_areas(road_map)
    joined = list(range(len(beside.outlines)))
    for edge in road_map.edges:
        if edge.function == CROSSING and edge.lanes:
            met = [area for end in (0, -1) for area in _meeting(lanes[edge.lanes[0]].line[end, :2], beside)[:1]]
            groups = {joined[area] for area in met}
            joined = [min(groups) if group in groups else group for group in joined]
    found: list[Pavement] = []
    groups_met: dict[int, list[Met]] = defaultdict(list)
    for place, edge in enumerate(road_map.edges):
        if edge.function != ROAD or not edge.lanes or lanes[edge.lanes[0]].drivable:
            continue
        lane = lanes[edge.lanes[0]]
        ends = [_meeting(lane.line[end, :2], beside) for end in (0, -1)]
        begin, end = (joined[areas[0]] if areas else -1 for areas in ends)
        for group, at_end in ((begin, False), (end, True)):
            if group >= 0:
                groups_met[group].append(Met(len(found), at_end))
        shared = frozenset(area for end in (0, -1) for area in _meeting(lane.line[end, :2], on_lanes))
        found.append(Pavement(place, lane.length_m, begin, end, shared))
    return Pavements(tuple(found), tuple(tuple(groups_met[group]) for group in range(len(beside.outlines))))


def walks(ways: Pavements, rng: np.random.Generator, for_s: float) -> list[Walk]:
    """Return random walks, one after the other, for at least `for_s`; where no way leads on people turn round.

    Nobody turns round else. There has to be a pavement; the first one is begun anywhere, even at its end.
    """
    own, to_end = int(rng.integers(len(ways.pavements))), bool(rng.random() < 0.5)
    found, edges, took_s = [], [ways.pavements[own].edge], 0.0
    while True:
        pavement = ways.pavements[own]
        group = pavement.at_end if to_end else pavement.at_begin
        others = [] if group < 0 else [met for met in ways.groups[group] if _leads(pavement, ways, met)]
        if took_s >= for_s or not others:
            found.append(Walk(tuple(edges), to_end))
            if took_s >= for_s:
                return found
            edges, to_end = [pavement.edge], not to_end
        else:
            met = others[int(rng.integers(len(others)))]
            own, to_end = met.pavement, not met.at_end
            edges.append(ways.pavements[own].edge)
        took_s += max(ways.pavements[own].length_m, _STEP_M) / FASTEST_MPS


def _leads(pavement: Pavement, ways: Pavements, met: Met) -> bool:
    """Return whether people get from a pavement to another of its group over crossings only."""
    other = ways.pavements[met.pavement]
    return other.edge != pavement.edge and not other.on_lanes & pavement.on_lanes


def _walking_areas(road_map: RoadMap) -> tuple[_Areas, _Areas]:
    """Return the outlines of walking areas: of those beside the carriageway, and of those on it."""
    driven = np.vstack([_points(lane.line[:, :2]) for lane in road_map.lanes if lane.drivable] or [np.zeros((0, 2))])
    places = [edge.lanes[0] for edge in road_map.edges if edge.function == WALKING_AREA and edge.lanes]
    every = _boxed([road_map.lanes[lane].line[:, :2] for lane in places])
    beside: list[Array] = []
    on_lanes: list[Array] = []
    for outline, low, high in zip(*every, strict=True):
        near = driven[((driven > low) & (driven < high)).all(axis=1)]
        lies_on_lanes = (_away_m(near, outline) < _ON_LANE_M).any()
        (on_lanes if lies_on_lanes else beside).append(outline)
    return _boxed(beside), _boxed(on_lanes)


def _boxed(outlines: list[Array]) -> _Areas:
    lows = np.array([outline.min(axis=0) for outline in outlines]).reshape(-1, 2) - 1.0
    highs = np.array([outline.max(axis=0) for outline in outlines]).reshape(-1, 2) + 1.0
    return _Areas(outlines, lows, highs)


def _meeting(end: Array, areas: _Areas) -> list[int]:
    """Return which areas a place is at, the nearest one first."""
    near = np.flatnonzero(((areas.lows < end) & (end < areas.highs)).all(axis=1)).tolist()
    away_m = {number: float(_away_m(end[None], areas.outlines[number])[0]) for number in near}
    return sorted((number for number in near if away_m[number] < _MEETS_M), key=away_m.__getitem__)


def _away_m(points: Array, outline: Array) -> Array:
    """Return how far each point is from what an outline encloses, float64 [points]; 0 within it."""
    begin, side = outline, np.roll(outline, -1, axis=0) - outline
    from_begin = points[:, None] - begin
    share = (from_begin * side).sum(axis=2) / np.maximum((side * side).sum(axis=1), 1e-12)
    off = from_begin - np.clip(share, 0.0, 1.0)[:, :, None] * side
    away: Array = np.where(_is_within(from_begin, side), 0.0, np.sqrt((off * off).sum(axis=2)).min(axis=1))
    return away


def _is_within(from_begin: Array, side: Array) -> NDArray[np.bool_]:
    """Return which points are within: a line from each to the right crosses an odd number of sides."""
    above, ends_above = from_begin[:, :, 1] < 0.0, from_begin[:, :, 1] < side[:, 1]
    upwards = np.where(side[:, 1] == 0.0, 1.0, side[:, 1])
    crosses = (above != ends_above) & (from_begin[:, :, 0] < from_begin[:, :, 1] * side[:, 0] / upwards)
    return np.asarray(crosses.sum(axis=1) % 2 == 1)


def _points(line: Array) -> Array:
    """Return a line as points at most _STEP_M apart."""
    way = np.concatenate(((0.0,), np.cumsum(np.sqrt((np.diff(line, axis=0) ** 2).sum(axis=1)))))
    at = np.linspace(0.0, way[-1], max(2, int(way[-1] / _STEP_M) + 2))
    return np.column_stack([np.interp(at, way, line[:, axis]) for axis in (0, 1)])
