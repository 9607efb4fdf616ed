"""The world of a road map: the route that its profile asks for, and the drawing of what lies round it."""

from collections.abc import Callable
from functools import partial
from typing import Final, NamedTuple

from simconsole.profiles.world import GroundProfile, RandomRoute, RoadsProfile, RouteByEdges
from simconsole.values.errors import ProfileError
from simconsole.world.roads.lane_graph import LaneGraph, Leg
from simconsole.world.roads.road_drawing import draw_roads
from simconsole.world.roads.road_map import Connection, RoadMap
from simconsole.world.roads.road_relief import road_field
from simconsole.world.roads.road_route import MAX_CURVATURE_1PM, route_over, too_tight
from simconsole.world.route import Route
from simconsole.world.world import World


class Roads(NamedTuple):
    """A road map, and the way that the world's route takes over it."""

    road_map: RoadMap
    legs: tuple[Leg, ...]


class RoadWorld(World):
    """The world of a road map."""

    def __init__(self, title: str, roads: Roads, route: Route, ground: GroundProfile | None = None) -> None:
        raise_ground = None if ground is None else partial(road_field, roads.road_map, route, ground)
        super().__init__(title, route, partial(draw_roads, roads.road_map, route), raise_ground)
        self.roads = roads


def roads_of(world: World) -> Roads | None:
    """Return the roads of a world; None: a course, whose rules nobody has written down."""
    return world.roads if isinstance(world, RoadWorld) else None


class Way(NamedTuple):
    """A way over the lanes of a map, and the route that follows it."""

    legs: tuple[Leg, ...]
    route: Route


SHORTEST_M: Final = 20.0
_TURNS: Final = 30
"""Turns that are too tight for a car are driven round: as many are looked for."""


def road_world(profile: RoadsProfile, road_map: RoadMap) -> RoadWorld:
    """Return the world of a profile with its map.

    Raises:
        ProfileError: no route that a car can drive leads over the map as the profile says.
    """
    way = planned(profile, road_map)
    return RoadWorld(profile.title, Roads(road_map, way.legs), way.route, profile.ground)


def planned(profile: RoadsProfile, road_map: RoadMap) -> Way:
    """Return the way of a profile.

    Raises:
        ProfileError: none that a car can drive leads over the map as the profile says.
    """
    wanted, key = profile.route, "route"
    if isinstance(wanted, RandomRoute):
        seed, length_m = wanted.seed, wanted.length_m
        return _drivable(profile, road_map, lambda graph: graph.drawn(seed, length_m), key)
    if isinstance(wanted, RouteByEdges):
        edges = [_edge(profile, road_map, f"route.edges[{place}]", edge) for place, edge in enumerate(wanted.edges)]
        return _drivable(profile, road_map, lambda graph: graph.by_edges(edges), "route.edges")
    start, goal = (_edge(profile, road_map, f"route.{end}", getattr(wanted, end)) for end in ("start", "goal"))
    return _drivable(profile, road_map, lambda graph: graph.between(start, goal), "route.goal")


def _drivable(profile: RoadsProfile, road_map: RoadMap, find: Callable[[LaneGraph], list[Leg] | None], key: str) -> Way:
    closed: list[Connection] = []
    problem = "no way for a car leads there"
    for _ in range(_TURNS):
        legs = find(LaneGraph(road_map, closed))
        if not legs:
            break
        if sum(road_map.lanes[lane].length_m for leg in legs for lane in leg.lanes[:1]) < SHORTEST_M:
            problem = f"a route of less than {SHORTEST_M:g} m"
            break
        route = route_over(road_map, legs)
        turn = too_tight(road_map, legs, route)
        if turn is None:
            return Way(tuple(legs), route)
        closed.append(turn)
        edges = [road_map.edges[road_map.lanes[lane].edge].id for lane in (turn.from_lane, turn.to_lane)]
        radius_m = 1.0 / MAX_CURVATURE_1PM
        problem = f"the turn from {edges[0]} to {edges[1]} is tighter than a radius of {radius_m:.1f} m"
    raise ProfileError(f"{profile.map.name}: {key}: {problem}: a route that a car can drive")


def _edge(profile: RoadsProfile, road_map: RoadMap, key: str, name: str) -> int:
    place = road_map.edge(name)
    if place is None or not any(road_map.lanes[lane].drivable for lane in road_map.edges[place].lanes):
        raise ProfileError(f"{profile.map.name}: {key}: value {name!a}: an edge of the map, open to cars")
    return place
