"""Ways over a road map, lane by lane: by their edges, the quickest from edge to edge, or drawn from a seed."""

import heapq
import math
from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Final, NamedTuple

import numpy as np

from simconsole.world.roads.road_map import ROAD, Connection, RoadMap

CHANGE_M: Final = 40.0
"""Way that a change to the next lane takes."""
OFF_M: Final = 40.0
"""Room to drive off on: where the map has such a lane, a drawn way begins on one at least as long."""
_CHANGE_S: Final = 4.0  # what a change costs in the search: nobody changes lanes to win a second
_SLOWEST_MPS: Final = 0.5
_TRIES: Final = 40
_TURN_ROUND: Final = "t"
"""Direction of connections that nobody drives here: their lanes turn on the spot."""


class Leg(NamedTuple):
    """One edge of a way: the lanes driven on it, changing from one to the next, and what follows in the junction."""

    lanes: tuple[int, ...]
    connection: Connection | None  # None: the way ends on this edge


class LaneGraph:
    """The lanes of a map on which a car gets from edge to edge, but for connections that are `closed`."""

    def __init__(self, road_map: RoadMap, closed: Collection[Connection] = ()) -> None:
        self.road_map = road_map
        lanes, edges = road_map.lanes, road_map.edges
        self._driven = [lane.drivable and edges[lane.edge].function == ROAD for lane in lanes]
        self._out: list[list[Connection]] = [[] for _ in lanes]
        for one in road_map.connections:
            usable = self._driven[one.from_lane] and self._driven[one.to_lane] and one.direction != _TURN_ROUND
            if usable and one not in closed and all(lanes[place].drivable for place in one.via):
                self._out[one.from_lane].append(one)
        self._lengths = [lane.length_m for lane in lanes]

    def entries(self, edge: int) -> list[int]:
        """Return the lanes of an edge that a car may use, from the right."""
        return [lane for lane in self.road_map.edges[edge].lanes if self._driven[lane]]

    def out(self, lane: int) -> list[Connection]:
        """Return the connections by which a car leaves a lane."""
        return self._out[lane]

    def by_edges(self, edges: Sequence[int]) -> list[Leg] | None:
        """Return the quickest way over these edges, one after the other; None where a car cannot go so."""
        return self._search(
            self.entries(edges[0]),
            lambda done, connection: self.road_map.lanes[connection.to_lane].edge == edges[done],
            len(edges),
        )

    def between(self, start: int, goal: int) -> list[Leg] | None:
        """Return the quickest way from one edge to another; None where there is none."""
        return self._search(self.entries(start), lambda done, connection: True, None, goal)

    def drawn(self, seed: int, length_m: float) -> list[Leg]:
        """Return a random way of at least `length_m`, no edge twice; the longest found where none is long enough."""
        rng = np.random.default_rng(seed)
        driven = [lane for lane, usable in enumerate(self._driven) if usable]
        starts = [lane for lane in driven if self._out[lane]] or driven
        starts = [lane for lane in starts if self._lengths[lane] >= OFF_M] or starts
        best: list[Leg] = []
        best_m = -1.0
        for _ in range(_TRIES if starts else 0):
            legs, way_m = self._wander(rng, starts[int(rng.integers(len(starts)))], length_m)
            if way_m > best_m:
                best, best_m = legs, way_m
            if best_m >= length_m:
                break
        return best

    def _wander(self, rng: np.random.Generator, start: int, length_m: float) -> tuple[list[Leg], float]:
        legs: list[Leg] = []
        seen: set[int] = set()
        entry, way_m = start, 0.0
        while True:
            seen.add(self.road_map.lanes[entry].edge)
            way_m += self._lengths[entry]
            choices = [
                one
                for lane in self._within_reach(entry)
                for one in self._out[lane]
                if self.road_map.lanes[one.to_lane].edge not in seen
            ]
            if not choices or way_m >= length_m:
                return [*legs, Leg((entry,), None)], way_m
            one = choices[int(rng.integers(len(choices)))]
            legs.append(Leg(_from_to(entry, one.from_lane), one))
            way_m += sum(self._lengths[lane] for lane in one.via)
            entry = one.to_lane

    def _within_reach(self, lane: int) -> Iterable[int]:
        """Yield the lanes of the same edge that its length lets a car change to, all between them usable too."""
        own = self.entries(self.road_map.lanes[lane].edge)
        most = int(self._lengths[lane] / CHANGE_M)
        for other in own:
            if abs(other - lane) <= most and all(self._driven[between] for between in _from_to(lane, other)):
                yield other

    def _search(
        self,
        entries: Sequence[int],
        allowed: Callable[[int, Connection], bool],
        edge_count: int | None,
        goal: int | None = None,
    ) -> list[Leg] | None:
        """Dijkstra over (lane entered, edges done); a lane change belongs to the step that leaves the edge."""
        queue: list[tuple[float, int, int]] = [(0.0, 1, lane) for lane in entries]
        before: dict[tuple[int, int], tuple[tuple[int, int], Leg] | None] = {(1, lane): None for lane in entries}
        known = {(1, lane): 0.0 for lane in entries}
        closed: set[tuple[int, int]] = set()
        counted = edge_count is not None
        while queue:
            cost, done, lane = heapq.heappop(queue)
            here = (done, lane)
            if here in closed:
                continue
            closed.add(here)
            if done == edge_count or self.road_map.lanes[lane].edge == goal:
                return self._walked(before, here)
            for exit_lane in self._within_reach(lane):
                for one in self._out[exit_lane]:
                    if not allowed(done, one):
                        continue
                    there = (done + 1 if counted else 1, one.to_lane)
                    if there in closed:
                        continue
                    after = cost + self._cost_s(lane, exit_lane, one)
                    if after < known.get(there, math.inf):
                        known[there] = after
                        before[there] = (here, Leg(_from_to(lane, exit_lane), one))
                        heapq.heappush(queue, (after, *there))
        return None

    def _cost_s(self, lane: int, exit_lane: int, connection: Connection) -> float:
        driven = (lane, *connection.via)
        time_s = sum(self._lengths[one] / max(self.road_map.lanes[one].limit_mps, _SLOWEST_MPS) for one in driven)
        return time_s + _CHANGE_S * abs(exit_lane - lane)

    def _walked(
        self, before: dict[tuple[int, int], tuple[tuple[int, int], Leg] | None], last: tuple[int, int]
    ) -> list[Leg]:
        legs = [Leg((last[1],), None)]
        step = before[last]
        while step is not None:
            here, leg = step
            legs.append(leg)
            step = before[here]
        return legs[::-1]


def _from_to(lane: int, other: int) -> tuple[int, ...]:
    return tuple(range(lane, other + 1)) if other >= lane else tuple(range(lane, other - 1, -1))
