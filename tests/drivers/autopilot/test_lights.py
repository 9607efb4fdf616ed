"""What the autopilot knows of traffic lights."""

import math

from simconsole.bridge.messages import standard_registry
from simconsole.drivers.autopilot.lights import SIGNALS, SIGNALS_TYPE, lights_of, signal_stops
from simconsole.drivers.path_tracker.signal_stops import GAP_M, Light
from simconsole.drivers.path_tracker.speed_profile import plan_speed
from simconsole.drivers.path_tracker.tracker_settings import COMFORT
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.files.world_files import load_world
from simconsole.values.signals import SignalState
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.approaches import stop_lines


def test_message_becomes_lights_by_name_and_link() -> None:
    registry = standard_registry()
    message = registry.struct(SIGNALS_TYPE)()
    message.header.stamp.sec, message.header.stamp.nanosec = 7, 500_000_000
    message.signals = [registry.struct("simconsole_msgs/TrafficSignal")("a", [3, 6], [6, 7], [12.5, -1.0])]
    assert lights_of(message) == {("a", 0): Light(3, 6, 12.5, 7.5), ("a", 1): Light(6, 7, -1.0, 7.5)}
    assert SIGNALS == "/traffic_signals"
    signal = registry.struct("simconsole_msgs/TrafficSignal")
    message.signals = [signal("a", [3, 6], [6, 7], [12.5, -1.0], [12.5, 0.0], [20.0, -1.0], [40.0, -1.0], [50.0, -1.0])]
    assert [one.greens_s for one in lights_of(message).values()] == [((12.5, 20.0), (40.0, 50.0)), ((0.0, math.inf),)]


def test_worlds_without_lights_on_their_route_have_none() -> None:
    car = load_vehicle("hatchback")
    assert signal_stops(open_world(load_world("urban")), car) is None
    assert signal_stops(open_world(load_world("skid_pad")), car) is None


def test_the_car_s_front_is_held_before_the_line() -> None:
    world, car = open_world(load_world("urban_signals")), load_vehicle("hatchback")
    found = signal_stops(world, car)
    assert found is not None
    roads = roads_of(world)
    assert roads is not None
    (line,) = stop_lines(roads.road_map, roads.legs, world.route)
    name = roads.road_map.signals[line.signal].id
    found.see({(name, line.link): Light(SignalState.STOP_AND_REMAIN, 6, 30.0, 0.0)})
    stop = found.stop(line.s_m - 60.0, 10.0, plan_speed(world.route, COMFORT), 0.0)
    assert stop is not None
    body = car.body  # type: ignore[union-attr]
    assert stop.s_m == line.s_m - GAP_M - (body.length_m - body.rear_overhang_m)
