"""Which signal lies ahead of each lane of a map, by the way that the route takes or, beside it, straight on."""

from collections import defaultdict
from collections.abc import Sequence
from typing import Final, NamedTuple

from simconsole.world.roads.lane_graph import Leg
from simconsole.world.roads.road_map import Connection, RoadMap
from simconsole.world.route import Route

AHEAD_M: Final = 300.0
"""A signal whose stop line is further than this beyond the end of the vehicle's lane is not looked for."""
_STRAIGHT: Final = "s"


class Approach(NamedTuple):
    """The movements that a stop line holds back."""

    signal: int  # place in the map's signals
    links: tuple[int, ...]  # of this signal: those that a vehicle here may follow


class Ahead(NamedTuple):
    """What lies ahead of a lane."""

    approach: Approach
    beyond_m: float  # from the lane's end to the stop line


class StopLine(NamedTuple):
    """A stop line on a route."""

    s_m: float
    signal: int
    link: int


def ahead_of_lanes(road_map: RoadMap, legs: Sequence[Leg]) -> list[Ahead | None]:
    """Return for each lane of the map the next signal ahead of it; None where there is none within AHEAD_M."""
    movements = _movements(road_map, legs)
    following = _following(movements)
    return [_next_signal(road_map, movements, following, lane) for lane in range(len(road_map.lanes))]


def stop_lines(road_map: RoadMap, legs: Sequence[Leg], route: Route) -> tuple[StopLine, ...]:
    """Return the stop lines of the signals on a way, in the route's order.

    That at the end of an open way is one of them: with base_link at the end, a car's front is beyond it.
    """
    found = []
    for leg in legs:
        movement = leg.connection or _onward(road_map, leg.lanes[-1])
        if movement is not None and movement.signal >= 0:
            x, y = road_map.lanes[movement.from_lane].line[-1, :2].tolist()
            found.append(StopLine(route.project(x, y).s_m, movement.signal, movement.link))
    return tuple(found)


def _onward(road_map: RoadMap, lane: int) -> Connection | None:
    """Return the movement that a car may take from a lane, straight on where there are several; None if it ends."""
    movements = [one for one in road_map.connections if one.from_lane == lane and _drivable(road_map, one)]
    return _straight(movements) if movements else None


def _straight(movements: Sequence[Connection]) -> Connection:
    return next((one for one in movements if one.direction == _STRAIGHT), movements[0])


def _drivable(road_map: RoadMap, movement: Connection) -> bool:
    return road_map.lanes[movement.from_lane].drivable and road_map.lanes[movement.to_lane].drivable


def _movements(road_map: RoadMap, legs: Sequence[Leg]) -> dict[int, list[Connection]]:
    """Return the connections that a car may take from each lane: the route's alone where the route uses the lane."""
    movements: dict[int, list[Connection]] = defaultdict(list)
    for one in road_map.connections:
        if _drivable(road_map, one):
            movements[one.from_lane].append(one)
    for leg in legs:
        if leg.connection is not None:
            for lane in leg.lanes:
                movements[lane] = [leg.connection]
    return movements


def _following(movements: dict[int, list[Connection]]) -> dict[int, int]:
    """Return the lane after each lane: along the movement straight on where there are several."""
    following: dict[int, int] = {}
    for lane, connections in movements.items():
        straight = _straight(connections)
        for one in connections:
            following |= dict(zip(one.via, (*one.via[1:], one.to_lane), strict=True))
        following[lane] = (*straight.via, straight.to_lane)[0]
    return following


def _next_signal(
    road_map: RoadMap, movements: dict[int, list[Connection]], following: dict[int, int], lane: int
) -> Ahead | None:
    beyond_m, passed = 0.0, {lane}
    while beyond_m <= AHEAD_M:
        held = [one for one in movements.get(lane, ()) if one.signal >= 0]
        if held:
            signal = held[0].signal
            return Ahead(Approach(signal, tuple(one.link for one in held if one.signal == signal)), beyond_m)
        if lane not in following or following[lane] in passed:
            return None
        lane = following[lane]
        passed.add(lane)
        beyond_m += road_map.lanes[lane].length_m
    return None
