"""Advice along the route of a world."""

import math
from functools import cache

from simconsole.drivers.autopilot.route_advice import OFF_ROUTE_M, RouteAdvice
from simconsole.drivers.path_tracker.signal_stops import Light
from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.files.world_files import load_world
from simconsole.values.signals import SignalState
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.approaches import StopLine, stop_lines
from simconsole.world.rules.speed_advice import NO_ADVICE, Advised
from simconsole.world.world import World

CAR = load_vehicle("hatchback")


@cache
def town() -> tuple[World, StopLine, str]:
    """The world, the one line of its route, and the name of its light."""
    world = open_world(load_world("urban_signals"))
    roads = roads_of(world)
    assert roads is not None
    (line,) = stop_lines(roads.road_map, roads.legs, world.route)
    return world, line, roads.road_map.signals[line.signal].id


def at(before_m: float, speed_mps: float, beside_m: float = 0.0, turned_rad: float = 0.0) -> VehicleMotion:
    """Base_link so far before the line."""
    world, line, _ = town()
    place = world.route.at(line.s_m - before_m)
    x, y = place.x_m - beside_m * math.sin(place.yaw_rad), place.y_m + beside_m * math.cos(place.yaw_rad)
    return VehicleMotion(x, y, place.yaw_rad + turned_rad, speed_mps, 0.0, 0.0)


def advising(*greens_s: tuple[float, float]) -> RouteAdvice:
    world, line, name = town()
    advice = RouteAdvice(world, CAR)
    advice.see({(name, line.link): Light(SignalState.STOP_AND_REMAIN, 6, greens_s[0][0], 0.0, greens_s)})
    return advice


def test_the_light_of_the_route_is_advised_on_within_the_limit_of_the_way() -> None:
    advice = advising((20.0, 40.0)).advise(at(200.0, 12.0), 0.1)
    assert advice.kind is Advised.SPEED
    assert advice.high_mps <= town()[0].route.speed_limit_mps
    assert (200.0 - 4.0) / 24.0 < advice.target_mps < 200.0 / 18.0
    assert advising((60.0, 90.0)).advise(at(150.0, 12.0), 0.1).kind is Advised.STOP


def test_nothing_is_advised_beside_the_route_against_it_and_behind_the_last_light() -> None:
    advice = advising((20.0, 40.0))
    assert advice.advise(at(200.0, 12.0, beside_m=OFF_ROUTE_M + 1.0), 0.1) == NO_ADVICE
    assert advice.advise(at(200.0, 12.0, turned_rad=math.pi), 0.1) == NO_ADVICE
    assert advice.advise(at(-20.0, 12.0), 0.1) == NO_ADVICE
    assert RouteAdvice(town()[0], CAR).advise(at(200.0, 12.0), 0.1) == NO_ADVICE, "nobody has told of the light"
    without = RouteAdvice(open_world(load_world("urban")), CAR)
    assert without.advise(at(200.0, 12.0), 0.1) == NO_ADVICE


def test_who_has_left_the_route_is_advised_anew() -> None:
    advice = advising((0.0, 30.0))
    near = at(12.0, 12.0)
    shown = advice.advise(near, 0.1)
    assert shown.kind is Advised.SPEED
    _, line, name = town()
    advice.see({(name, line.link): Light(SignalState.STOP_AND_REMAIN, 6, 20.0, 0.2, ((20.0, 40.0),))})
    assert advice.advise(near, 0.2) == shown, "so near nobody reads any more"
    assert advice.advise(at(12.0, 12.0, beside_m=OFF_ROUTE_M + 1.0), 0.3) == NO_ADVICE
    assert advice.advise(near, 0.4).kind is Advised.STOP
