"""Demand for SUMO on a road map of the console's, drawn from a seed: who drives and walks where. Pure."""

from collections import defaultdict
from collections.abc import Iterator
from typing import Final, NamedTuple
from xml.sax.saxutils import quoteattr

import numpy as np

from simconsole.world.roads.road_map import ROAD, Array, RoadMap
from simconsole.world.sumo_traffic.walks import pavements_of, walks

VAN_SHARE: Final = 0.15
_SPEED_SHARE: Final = 0.6  # of the limit, that a vehicle makes on its way on average
_FASTEST_SHARE: Final = 1.3  # and at most, where no light is red: SUMO's drivers differ by a speedDev of 0.1
_TYPES: Final = (
    '    <vType id="car" length="4.60" width="1.80" height="1.50"/>\n'
    '    <vType id="van" vClass="delivery" length="5.40" width="2.00" height="2.30" accel="2.2"/>\n'
)


class _Trip(NamedTuple):
    depart_s: float
    number: int
    text: str


class _Roads(NamedTuple):
    """The roads that cars use: each with its length times its lanes, the time it takes, and what follows it."""

    edges: list[int]
    weights: Array
    times_s: dict[int, float]
    following: dict[int, list[int]]
    entries: list[int]  # where those come from who come later: no road leads there, or any road where there is none


def demand(road_map: RoadMap, *, vehicles: int, pedestrians: int, seed: int, horizon_s: float) -> str:
    """Return a routes file: so many vehicles at a time, each on a random walk over the map until it ends.

    Where a road leads nowhere a vehicle leaves, and another comes. Equal arguments give equal texts.

    Args:
        road_map: the roads.
        vehicles: how many drive at the beginning, and about as many later.
        pedestrians: how many walk, along pavements and over crossings.
        seed: of all chance.
        horizon_s: for so long (s) there is somebody on the road.
    """
    rng = np.random.default_rng(seed)
    roads = _roads(road_map)
    names = [edge.id for edge in road_map.edges]
    trips: list[_Trip] = []
    for _ in range(vehicles if roads.edges else 0):
        at_s, first = 0.0, True
        while at_s < horizon_s:
            way, took_s = _walk(roads, rng, horizon_s - at_s, anywhere=first)
            kind = "van" if rng.random() < VAN_SHARE else "car"
            begin = 'departPos="random_free"' if first else 'departPos="base" departSpeed="avg"'
            text = (
                f'    <vehicle id="vehicle{len(trips)}" type="{kind}" depart="{at_s:.2f}" departLane="best" {begin}>'
                f"<route edges={quoteattr(' '.join(names[edge] for edge in way))}/></vehicle>\n"
            )
            trips.append(_Trip(at_s, len(trips), text))
            at_s, first = round(at_s + took_s, 2), False
    trips += _people(road_map, pedestrians, rng, horizon_s)
    return f"<routes>\n{_TYPES}{''.join(trip.text for trip in sorted(trips))}</routes>\n"


def _roads(road_map: RoadMap) -> _Roads:
    lanes = road_map.lanes
    driven = {
        place: [lane for lane in edge.lanes if lanes[lane].drivable]
        for place, edge in enumerate(road_map.edges)
        if edge.function == ROAD
    }
    edges = [place for place, own in driven.items() if own]
    following: dict[int, set[int]] = defaultdict(set)
    for one in road_map.connections:
        if lanes[one.from_lane].drivable and lanes[one.to_lane].drivable:
            following[lanes[one.from_lane].edge].add(lanes[one.to_lane].edge)
    weights = np.array([len(driven[place]) * lanes[driven[place][0]].length_m for place in edges])
    times_s = {
        place: lanes[driven[place][0]].length_m / (_SPEED_SHARE * lanes[driven[place][0]].limit_mps) for place in edges
    }
    reached = {edge for some in following.values() for edge in some}
    return _Roads(
        edges=edges,
        weights=weights / max(float(weights.sum()), 1e-9),
        times_s=times_s,
        following={key: sorted(some) for key, some in following.items()},
        entries=[edge for edge in edges if edge not in reached] or edges,
    )


def _walk(roads: _Roads, rng: np.random.Generator, for_s: float, *, anywhere: bool) -> tuple[list[int], float]:
    """Return a way from a random road on, and how long it takes: until the map ends, or so long that it has no end.

    SUMO removes a vehicle where its way ends; in the middle of the map people would see it vanish.
    """
    if anywhere:
        way = [roads.edges[int(rng.choice(len(roads.edges), p=roads.weights))]]
    else:
        way = [roads.entries[int(rng.integers(len(roads.entries)))]]
    took_s = roads.times_s[way[0]]
    while took_s * _SPEED_SHARE < for_s * _FASTEST_SHARE and (choice := roads.following.get(way[-1])):
        way.append(choice[int(rng.integers(len(choice)))])
        took_s += roads.times_s[way[-1]]
    return way, took_s


def _people(road_map: RoadMap, count: int, rng: np.random.Generator, horizon_s: float) -> Iterator[_Trip]:
    """Yield people who walk along pavements and over crossings."""
    if not count:
        return
    ways = pavements_of(road_map)
    if not ways.pavements:
        return
    for number in range(count):
        legs = "".join(
            f"<walk edges={quoteattr(' '.join(road_map.edges[edge].id for edge in walk.edges))}"
            f' arrivalPos="{-0.01 if walk.ends_at_end else 0}"/>'
            for walk in walks(ways, rng, horizon_s)
        )
        yield _Trip(
            0.0,
            1_000_000 + number,
            f'    <person id="person{number}" depart="0.00" departPos="random">{legs}</person>\n',
        )
