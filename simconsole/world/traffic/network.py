"""A road map as the flat arrays that traffic's kernels walk over."""

from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.kernels import kernel
from simconsole.world.roads.lane_graph import LaneGraph
from simconsole.world.roads.road_map import Array, Connection, RoadMap

Numbers = NDArray[np.int64]

_SIDES: Final = {"l": 1, "t": 1, "r": -1}  # by SUMO's directions
CHANGING_M: Final = 120.0
"""A lane that ends is used only if it is this long: time to find a gap in the lane beside it."""


class Network(NamedTuple):
    """Lanes and connections by their places in the map; rows of several of one begin at `..._starts[place]`."""

    points: Array  # of all lanes: x, y (m), way from the lane's beginning (m)
    point_starts: Numbers
    lengths_m: Array
    limits_mps: Array
    widths_m: Array
    left: Numbers  # the lane beside it that leads the same way, -1 for none
    right: Numbers
    leaves: Numbers  # 1: nothing follows any lane of this edge, vehicles leave the map there
    out: Numbers  # connections that begin on a lane
    out_starts: Numbers
    goals: Numbers  # of connections: the lane that they lead to
    via: Numbers  # the lanes inside the junction
    via_starts: Numbers
    ways_m: Array  # how long a connection is inside the junction
    foes: Numbers  # connections in whose way it is
    foe_starts: Numbers
    firsts: Numbers  # those of them that go first
    first_starts: Numbers
    origins: Numbers  # the lane that a connection begins on
    turns: Numbers  # to which side vehicles indicate: 1 left, -1 right


def network(road_map: RoadMap) -> Network:
    """Return the network of a road map: its lanes for cars, and the connections between them."""
    graph = LaneGraph(road_map)
    lanes, connections = road_map.lanes, road_map.connections
    points, point_starts = _rows([_points(lane.line) for lane in lanes])
    ways = [graph.out(place) for place in range(len(lanes))]
    leaves = [not any(ways[other] for other in road_map.edges[lane.edge].lanes) for lane in lanes]
    own = _without_traps(graph, road_map, ways, leaves)
    by_lane: dict[int, list[int]] = {}
    for place, one in enumerate(connections):
        for lane in one.via:
            by_lane.setdefault(lane, []).append(place)
    places = {id(one): place for place, one in enumerate(connections)}
    lengths = np.array([lane.length_m for lane in lanes])
    out, out_starts = _lists([[places[id(one)] for one in some] for some in own])
    via, via_starts = _lists([one.via for one in connections])
    foes, foe_starts = _lists([_users(by_lane, one.foes) for one in connections])
    firsts, first_starts = _lists([_users(by_lane, one.yields_to) for one in connections])
    left, right = _beside(graph, road_map, 1), _beside(graph, road_map, -1)
    return Network(
        points=points.reshape(-1, 3),
        point_starts=point_starts,
        lengths_m=lengths,
        limits_mps=np.array([lane.limit_mps for lane in lanes]),
        widths_m=np.array([lane.width_m for lane in lanes]),
        left=left,
        right=right,
        leaves=np.array(leaves, np.int64),
        out=out,
        out_starts=out_starts,
        goals=np.array([one.to_lane for one in connections], np.int64),
        via=via,
        via_starts=via_starts,
        ways_m=np.array([sum(lengths[lane] for lane in one.via) for one in connections], np.float64),
        foes=foes,
        foe_starts=foe_starts,
        firsts=firsts,
        first_starts=first_starts,
        origins=np.array([one.from_lane for one in connections], np.int64),
        turns=_turns(road_map),
    )


def _turns(road_map: RoadMap) -> Numbers:
    """Return to which side vehicles indicate on each connection: on a roundabout only who leaves it does, to the right.

    Straßenverkehrs-Ordnung, sections 8 and 9.
    """
    rings = {edge for ring in road_map.roundabouts for edge in ring}
    found = np.zeros(len(road_map.connections), np.int64)
    for place, one in enumerate(road_map.connections):
        if road_map.lanes[one.to_lane].edge in rings:
            continue
        leaves = road_map.lanes[one.from_lane].edge in rings
        found[place] = -1 if leaves else _SIDES.get(one.direction.lower(), 0)
    return found


@kernel
def segment_to(net: Network, lane: int, first: int, s_m: float) -> int:
    """Return the first segment of a lane, from row `first` of its points on, that ends at `s_m` or behind it.

    It is the lane's last one where none does.
    """
    low, high = first, net.point_starts[lane + 1] - 2
    while low < high:
        middle = (low + high) // 2
        if net.points[middle + 1, 2] < s_m:
            low = middle + 1
        else:
            high = middle
    return int(low)


def _without_traps(
    graph: LaneGraph, road_map: RoadMap, ways: list[list[Connection]], leaves: Sequence[bool]
) -> list[list[Connection]]:
    """Return the connections of each lane without those to lanes that nobody gets on from, nor can leave in time."""
    while True:
        good = [
            bool(own) or leaves[lane] or _left_in_time(graph, road_map, ways, lane) for lane, own in enumerate(ways)
        ]
        kept = [[one for one in own if good[one.to_lane]] for own in ways]
        if kept == ways:
            return kept
        ways = kept


def _left_in_time(graph: LaneGraph, road_map: RoadMap, ways: list[list[Connection]], lane: int) -> bool:
    entries = graph.entries(road_map.lanes[lane].edge)
    beside = any(other in entries and ways[other] for other in (lane - 1, lane + 1))
    return beside and road_map.lanes[lane].length_m >= CHANGING_M


def _points(line: Array) -> Array:
    way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T))))
    return np.column_stack((line[:, :2], way))


def _users(by_lane: dict[int, list[int]], lanes: Iterable[int]) -> list[int]:
    return sorted({place for lane in lanes for place in by_lane.get(lane, ())})


def _beside(graph: LaneGraph, road_map: RoadMap, step: int) -> Numbers:
    found = np.full(len(road_map.lanes), -1, np.int64)
    for edge in range(len(road_map.edges)):
        entries = graph.entries(edge)
        for lane in entries:
            if lane + step in entries:
                found[lane] = lane + step
    return found


def _lists(some: Sequence[Sequence[int]]) -> tuple[Numbers, Numbers]:
    starts = np.concatenate(((0,), np.cumsum([len(one) for one in some], dtype=np.int64))).astype(np.int64)
    return np.array([value for one in some for value in one], np.int64), starts


def _rows(some: Sequence[Array]) -> tuple[Array, Numbers]:
    starts = np.concatenate(((0,), np.cumsum([len(one) for one in some], dtype=np.int64))).astype(np.int64)
    return (np.vstack(some) if some else np.zeros((0, 3))), starts
