"""A vehicle of the console's as one of SUMO's: put there before every step, and taken off the road at the end.

Left alone for one step SUMO would drive it off, and take it from the road at the end of its route (eclipse-sumo/sumo
issues 3993, 2401). Where it comes all at once, whoever is near is taken off the road: others need room to stop.
"""

import math
from collections.abc import Sequence
from typing import Any, Final

from simconsole.world.roads.lane_graph import Leg
from simconsole.world.roads.road_map import ROAD, RoadMap
from simconsole.world.sumo_traffic.places import Bumper, bumper_of
from simconsole.world.sumo_traffic.subscriptions import OF_PEOPLE, OF_VEHICLES, PERSON_FIELDS, VEHICLE_FIELDS
from simconsole.world.traffic.road_users import Box

EGO: Final = "simconsole.ego"
"""The console's vehicle in SUMO: its name, that of its type, of its route, and of the point round which people are.
Of several the second is `simconsole.ego1`, and so on."""
CLEAR_M: Final = 30.0
"""Who is as near as this to where the vehicle comes all at once is taken off the road."""
LONG_M: Final = 100_000.0
"""So long the vehicle's route is, where the world's route is a loop."""
JUMP_MPS: Final = 20.0
"""Who comes on by so much faster than it says has jumped: set back to the start, or by steps that were left out."""
NO_CHECKS: Final = 0
"""Speed mode and lane change mode of whom SUMO does not steer."""
_EXACTLY: Final = 2  # keepRoute of moveToXY: at this place, on a lane or not


class Ego:
    """Puts it where it is."""

    def __init__(self, sumo: Any, road_map: RoadMap, legs: Sequence[Leg], radius_m: float, number: int = 0) -> None:
        """Take `legs` as its route; vehicles and people within `radius_m` are asked for. `number`: of several."""
        self.name: Final = f"{EGO}{number}" if number else EGO
        self._sumo, self._radius_m, self._moved_m = sumo, radius_m, road_map.moved_m
        self._route = route_of(road_map, legs)
        self._before: Box | None = None  # as it was put last

    def begin(self, ego: Box) -> None:
        """Put it on the road for the first time."""
        sumo = self._sumo
        sumo.vehicletype.copy("DEFAULT_VEHTYPE", self.name)
        sumo.vehicletype.setLength(self.name, ego.length_m)
        sumo.vehicletype.setWidth(self.name, ego.width_m)
        sumo.route.add(self.name, self._route)
        self._enter(ego)

    def put(self, ego: Box, period_s: float) -> Bumper:
        """Put it where it is, `period_s` after where it was; return that, as SUMO knows it."""
        if self._before is not None and has_jumped(self._before, ego, period_s):
            self.leave()
            self._enter(ego)
        self._before, place = ego, bumper_of(ego, self._moved_m)
        self._move(place)
        self._sumo.poi.setPosition(self.name, place.x_m, place.y_m)
        return place

    def leave(self) -> None:
        """Take it off the road."""
        sumo = self._sumo
        # First: a subscription of somebody who is gone makes the next step fail.
        sumo.vehicle.unsubscribeContext(self.name, OF_VEHICLES, self._radius_m)
        sumo.poi.unsubscribeContext(self.name, OF_PEOPLE, self._radius_m)
        sumo.poi.remove(self.name)
        sumo.vehicle.remove(self.name)

    def _enter(self, ego: Box) -> None:
        sumo, place = self._sumo, bumper_of(ego, self._moved_m)
        self._clear(place)
        sumo.vehicle.add(self.name, self.name, typeID=self.name)
        sumo.vehicle.setSpeedMode(self.name, NO_CHECKS)
        sumo.vehicle.setLaneChangeMode(self.name, NO_CHECKS)
        self._move(place)
        sumo.vehicle.subscribeContext(self.name, OF_VEHICLES, self._radius_m, VEHICLE_FIELDS)
        # People round a point that goes with the ego: vehicles and people of one name stay apart.
        sumo.poi.add(self.name, place.x_m, place.y_m, (0, 0, 0, 0))
        sumo.poi.subscribeContext(self.name, OF_PEOPLE, self._radius_m, PERSON_FIELDS)

    def _move(self, place: Bumper) -> None:
        self._sumo.vehicle.moveToXY(self.name, "", -1, place.x_m, place.y_m, place.angle_deg, _EXACTLY)

    def _clear(self, place: Bumper) -> None:
        """Take off the road whom its sudden coming would surprise."""
        vehicles = self._sumo.vehicle
        for name in vehicles.getIDList():
            if is_ours(name):
                continue
            x_m, y_m = vehicles.getPosition(name)
            if math.hypot(x_m - place.x_m, y_m - place.y_m) < CLEAR_M:
                vehicles.remove(name)


def is_ours(name: str) -> bool:
    """Return whether a vehicle of SUMO's is one of the console's."""
    return name.startswith(EGO)


def has_jumped(before: Box, now: Box, period_s: float) -> bool:
    """Return whether the way of a period is not one that was driven."""
    fastest_mps = max(abs(before.speed_mps), abs(now.speed_mps)) + JUMP_MPS
    return math.hypot(now.x_m - before.x_m, now.y_m - before.y_m) > fastest_mps * period_s


def route_of(road_map: RoadMap, legs: Sequence[Leg]) -> list[str]:
    """Return the edges of the world's route, again and again where it is a loop."""
    lanes, edges = road_map.lanes, road_map.edges
    once = [edges[lanes[leg.lanes[-1]].edge].id for leg in legs]
    if not once:
        return [next(edge.id for edge in edges if edge.function == ROAD and lanes[edge.lanes[-1]].drivable)]
    first, last = lanes[legs[0].lanes[0]].edge, lanes[legs[-1].lanes[-1]].edge
    closed = any(lanes[one.from_lane].edge == last and lanes[one.to_lane].edge == first for one in road_map.connections)
    if not closed or first == last:
        return once
    length_m = sum(lanes[leg.lanes[-1]].length_m for leg in legs)
    return once * math.ceil(LONG_M / max(length_m, 1.0))
