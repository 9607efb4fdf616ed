"""What the autopilot knows of traffic lights: where they stand on its route, and what they are told to show. Pure."""

import math
from typing import Any

from simconsole.drivers.path_tracker.signal_stops import Light, SignalStops
from simconsole.profiles.vehicle import CarProfile, VehicleProfile
from simconsole.values.units import NS_PER_S
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.approaches import stop_lines
from simconsole.world.world import World

SIGNALS = "/traffic_signals"
SIGNALS_TYPE = "simconsole_msgs/TrafficSignals"


def signal_stops(world: World, vehicle: VehicleProfile) -> SignalStops | None:
    """Return the lights on the route of a world, None where there are none."""
    roads = roads_of(world)
    if roads is None:
        return None
    lines = stop_lines(roads.road_map, roads.legs, world.route)
    if not lines:
        return None
    front_m = 0.0
    if isinstance(vehicle, CarProfile):
        front_m = vehicle.body.length_m - vehicle.body.rear_overhang_m
    return SignalStops(lines, [signal.id for signal in roads.road_map.signals], front_m)


def lights_of(message: Any) -> dict[tuple[str, int], Light]:
    """Return what a simconsole_msgs/TrafficSignals tells, by the signal's name and link."""
    stamp_s = message.header.stamp.sec + message.header.stamp.nanosec / NS_PER_S
    return {
        (signal.id, link): Light(state, following, change_s, stamp_s, _greens(signal, link))
        for signal in message.signals
        for link, (state, following, change_s) in enumerate(
            zip(signal.states, signal.next_states, signal.time_to_change, strict=False)
        )
    }


def _greens(signal: Any, link: int) -> tuple[tuple[float, float], ...]:
    """Return the times of green that a signal tells of one of its links; others' messages may not have them."""
    told = ((signal.green_from, signal.green_to), (signal.later_green_from, signal.later_green_to))
    return tuple(
        (begins[link], math.inf if link >= len(ends) or ends[link] < 0.0 else ends[link])
        for begins, ends in told
        if link < len(begins) and begins[link] >= 0.0
    )
