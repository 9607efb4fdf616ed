"""Where a route gives way: lines before crossings and junctions, and the ways of those who may have to be let pass."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import accumulate
from typing import Final, NamedTuple

import numpy as np

from simconsole.world.people.crossings import Crossing, Strip, crossings_of
from simconsole.world.roads.lane_graph import Leg
from simconsole.world.roads.road_map import Array, Connection, RoadMap
from simconsole.world.route import Route

SEEN_M: Final = 90.0
"""Vehicles whose way to the junction is longer are not looked at."""
ZONE_M: Final = 2.6
"""Two ways meet where their centre lines are nearer to each other than this."""
MERGED_M: Final = 6.0
"""Who is further than this on a common way is a vehicle ahead."""
_STEP_M: Final = 1.0
_INSIDE_M: Final = 2.0
"""A place to wait inside a junction is further behind the junction's line than this."""
_ONCOMING: Final = -0.7  # cosine of the angle between two lanes that lead to a junction from opposite sides

LEFT_FROM_MAJOR_S: Final = 4.1
CRITICAL_S: Final = {"r": 6.2, "s": 6.5, "l": 7.1}
"""Critical headways: the gap between two vehicles with the right of way that half of all drivers drive into.

Highway Capacity Manual 2010, exhibit 19-10 (two-lane major street: right turn, through and left turn from the minor
street, left turn from the major one, which is also what a green light without an arrow asks for), and chapter 21 for
roundabouts with one lane."""
ROUNDABOUT_S: Final = 5.19


class Foot(NamedTuple):
    """A crossing on the route."""

    line_m: float  # along the route: where it begins
    crossing: Crossing
    low_m: float  # along the crossing: the strip that the route takes
    high_m: float


class Watched(NamedTuple):
    """The ways of others to where they meet the route, as points; float64 [points] each."""

    x_m: Array
    y_m: Array
    cosine: Array
    sine: Array
    to_m: Array  # way to where they meet the route
    past_m: Array  # to where they have left it
    first: Array  # 1: who comes there goes first; 0: who is there already is let out
    inside: Array  # 1: behind their own line, whatever their light shows
    signal: Array  # that holds them back before it, -1: none
    link: Array
    ring: Array  # 1: on a roundabout before the meeting: who indicates to the right leaves it there
    line_m: Array  # way from the signal's line to where they meet the route


class Entry(NamedTuple):
    """A junction on the route at which somebody may have to be let pass.

    Who turns to the left may wait inside it, too, before the ways of oncoming vehicles (StVO, section 9, paragraph 4).
    """

    line_m: float  # along the route
    connection: Connection
    critical_s: float
    watched: Watched
    inside: bool = False  # where who has passed the junction's line waits


class Duties(NamedTuple):
    """Where a route gives way, in its order."""

    crossings: tuple[Foot, ...]
    entries: tuple[Entry, ...]


def duties(road_map: RoadMap, legs: Sequence[Leg], route: Route) -> Duties:
    """Return where a way over a map gives way, by its route."""
    driven = [leg.connection for leg in legs if leg.connection is not None]
    own = {lane for one in driven for lane in one.via}
    feet = [
        Foot(_on_route(road_map, route, strip), crossing, strip.low_m, strip.high_m)
        for crossing in crossings_of(road_map, own)
        for strip in crossing.strips
    ]
    ways = _Ways(road_map)
    entries = []
    for one in driven:
        watched = ways.watched(one)
        if watched is not None:
            x, y = road_map.lanes[one.from_lane].line[-1, :2].tolist()
            entry = Entry(route.project(x, y).s_m, one, ways.critical_s(one), watched)
            entries.append(entry)
            waiting = ways.oncoming(one) if entry.critical_s == LEFT_FROM_MAJOR_S else None
            if waiting is not None:
                (x, y), watched = waiting
                entries.append(entry._replace(line_m=route.project(x, y).s_m, watched=watched, inside=True))
    return Duties(tuple(sorted(feet, key=lambda foot: foot.line_m)), tuple(entries))


def _on_route(road_map: RoadMap, route: Route, strip: Strip) -> float:
    """Return where on the route the crossing of a strip begins."""
    line = road_map.lanes[strip.lane].line[:, :2]
    way = _way(line)
    middle = 0.5 * (strip.near_m + strip.far_m)
    x, y = (float(np.interp(middle, way, line[:, axis])) for axis in (0, 1))
    return route.project(x, y).s_m - 0.5 * (strip.far_m - strip.near_m)


class _Ways:
    """The ways that vehicles take over a map."""

    def __init__(self, road_map: RoadMap) -> None:
        self._map = road_map
        self._by_lane: dict[int, list[Connection]] = defaultdict(list)
        self._to: dict[int, list[Connection]] = defaultdict(list)
        lanes = road_map.lanes
        for one in road_map.connections:
            if lanes[one.from_lane].drivable and lanes[one.to_lane].drivable:
                self._to[one.to_lane].append(one)
                for lane in one.via:
                    self._by_lane[lane].append(one)
        self._rings = {edge for ring in road_map.roundabouts for edge in ring}

    def critical_s(self, own: Connection) -> float:
        """Return the critical headway of a movement."""
        lanes = self._map.lanes
        if lanes[own.to_lane].edge in self._rings and lanes[own.from_lane].edge not in self._rings:
            return ROUNDABOUT_S
        if own.signal >= 0:
            return LEFT_FROM_MAJOR_S
        edge = lanes[own.from_lane].edge
        straight = [
            one
            for one in self._map.connections
            if one.direction == "s" and lanes[one.from_lane].edge == edge and lanes[one.from_lane].drivable
        ]
        is_major = straight and not any(lane in self._by_lane for one in straight for lane in one.yields_to)
        if is_major:
            return LEFT_FROM_MAJOR_S
        return CRITICAL_S.get(own.direction, CRITICAL_S["l"])

    def watched(self, own: Connection) -> Watched | None:
        """Return the ways that meet a movement; None where none does."""
        line, firsts = self._driven(own), self._users(own.yields_to)
        others = {id(one): one for lane in own.foes for one in self._by_lane.get(lane, ())}
        parts = [
            part
            for key, one in others.items()
            if one.from_lane != own.from_lane and (part := self._part(one, line, key in firsts)) is not None
        ]
        return Watched(*np.concatenate(parts, axis=1)) if parts else None

    def oncoming(self, own: Connection) -> tuple[tuple[float, float], Watched] | None:
        """Return where a movement waits inside for oncoming vehicles that go first, and their ways; None: nowhere.

        That is before the first of those ways, where who waits is in nobody's way: others wait for them, or are stopped
        by lights. Maps of SUMO's tell where vehicles wait, between the lanes of a movement: who has passed that place
        goes on, for all others, and they wait for it.
        """
        line, looks = self._driven(own), self._looks(own)
        met, parts = [], []
        for one in self._users(own.yields_to).values():
            if float(looks @ self._looks(one)) > _ONCOMING:
                continue
            part, apart_m = self._part(one, line, True), _apart(line, self._crossed(one))
            if part is not None:
                met.append(int(np.flatnonzero(apart_m < ZONE_M)[0]))
                parts.append(part)
        if not parts:
            return None
        place = min((*met, *self._waits(own)))
        if place * _STEP_M < _INSIDE_M:
            return None
        x, y = line[place].tolist()
        return (x, y), Watched(*np.concatenate(parts, axis=1))

    def _waits(self, own: Connection) -> list[int]:
        """Return the last points before places inside the junction where vehicles wait, as the map has them."""
        lengths_m = accumulate(self._map.lanes[lane].length_m for lane in own.via[:-1])
        return [int(length_m / _STEP_M) for length_m in lengths_m if length_m >= _INSIDE_M + _STEP_M]

    def _looks(self, one: Connection) -> Array:
        """Return the direction in which a movement's lane comes to the junction, float64 [2]."""
        ends = self._map.lanes[one.from_lane].line[-2:, :2]
        return np.asarray((ends[1] - ends[0]) / np.hypot(*(ends[1] - ends[0])))

    def _driven(self, own: Connection) -> Array:
        """Return the points of a movement on the route, until others on it are vehicles ahead."""
        line = _points(np.vstack([self._map.lanes[lane].line[:, :2] for lane in (*own.via, own.to_lane)]))
        inside = float(sum(self._map.lanes[lane].length_m for lane in own.via))
        return line[: max(2, round((inside + MERGED_M) / _STEP_M))]

    def _users(self, lanes: Sequence[int]) -> Mapping[int, Connection]:
        return {id(one): one for lane in lanes for one in self._by_lane.get(lane, ())}

    def _part(self, other: Connection, own: Array, goes_first: bool) -> Array | None:
        """Return the points of another movement, float64 [fields of Watched, points]."""
        ahead = self._crossed(other)
        apart = _apart(ahead, own)
        met = np.flatnonzero(apart < ZONE_M)
        if not len(met):
            return None
        begins, ends = float(met[0]) * _STEP_M, float(met[-1] + 1) * _STEP_M
        found = [_rows(ahead, begins, ends - begins, (goes_first, 1.0, -1.0, -1.0, 0.0, begins))]
        if goes_first:
            held = (1.0, 0.0, float(other.signal), float(other.link))
            found += self._behind(other.from_lane, begins, ends - begins, held)
        return np.concatenate(found, axis=1)

    def _crossed(self, other: Connection) -> Array:
        """Return the points of another movement from its line on, until who is on it is a vehicle ahead."""
        lanes = self._map.lanes
        ahead = _points(np.vstack([lanes[lane].line[:, :2] for lane in (*other.via, other.to_lane)]))
        within = float(sum(lanes[lane].length_m for lane in other.via)) + MERGED_M
        return ahead[: max(2, round(within / _STEP_M))]

    def _behind(self, lane: int, to_m: float, zone_m: float, held: tuple[float, ...]) -> list[Array]:
        """Return the points of a lane that ends `to_m` before the meeting, and of those that lead there."""
        found, todo, seen, lanes, line_m = [], [(lane, to_m)], {lane}, self._map.lanes, to_m
        while todo:
            lane, end_m = todo.pop()
            points = _points(self._map.lanes[lane].line[:, :2])
            length = self._map.lanes[lane].length_m
            on_ring = (float(lanes[lane].edge in self._rings), line_m)
            found.append(_rows(points, end_m + length, zone_m, held + on_ring))
            if end_m + length < SEEN_M:
                for one in self._to[lane]:
                    chain, on_ring = end_m + length, (float(lanes[one.from_lane].edge in self._rings), line_m)
                    for via in reversed(one.via):
                        inside = _points(self._map.lanes[via].line[:, :2])
                        way = self._map.lanes[via].length_m
                        found.append(_rows(inside, chain + way, zone_m, held + on_ring))
                        chain += way
                    if one.from_lane not in seen and one.signal < 0:
                        seen.add(one.from_lane)
                        todo.append((one.from_lane, chain))
        return found


def _rows(points: Array, begins_m: float, zone_m: float, held: tuple[float, ...]) -> Array:
    """Return points as rows of Watched; the first of them is `begins_m` before the meeting."""
    to_m = begins_m - _STEP_M * np.arange(len(points), dtype=np.float64)
    direction = np.diff(points, axis=0, append=points[-1:])
    direction[-1] = direction[-2]
    length = np.maximum(np.hypot(*direction.T), 1e-9)
    count = len(points)
    told = [np.full(count, float(value)) for value in held]
    table = np.stack((points[:, 0], points[:, 1], *(direction.T / length), to_m, to_m + zone_m, *told))
    return table[:, (to_m < SEEN_M) & (to_m + zone_m > -MERGED_M)]


def _apart(points: Array, others: Array) -> Array:
    """Return how far each point is from the nearest of the others, float64 [points]."""
    return np.asarray(np.hypot(*(points[:, None, axis] - others[None, :, axis] for axis in (0, 1))).min(axis=1))


def _points(line: Array) -> Array:
    """Return a line as points every _STEP_M, at least two."""
    way = _way(line)
    at = np.arange(0.0, max(float(way[-1]), 2.0 * _STEP_M - 0.01), _STEP_M)
    return np.column_stack([np.interp(at, way, line[:, axis]) for axis in (0, 1)])


def _way(line: Array) -> Array:
    return np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
