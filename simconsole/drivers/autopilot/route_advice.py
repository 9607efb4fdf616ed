"""Speed advice for whoever drives along the route of a world, from what topics tell. Pure."""

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from simconsole.drivers.autopilot.lights import signal_stops
from simconsole.drivers.path_tracker.signal_stops import Approach, Light
from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.world.rules.speed_advice import NO_ADVICE, Advice, SpeedAdvisor
from simconsole.world.world import World

OFF_ROUTE_M: Final = 6.0
"""Whoever is further beside the route does not follow it: the next light there is not theirs."""
_AGAINST_RAD: Final = math.pi / 2
_LIMIT_EVERY_M: Final = 5.0


class RouteAdvice:
    """Advises a person, who takes a second to react."""

    def __init__(self, world: World, vehicle: VehicleProfile) -> None:
        """Advise along the route of `world`; without lights on it, nothing."""
        self._route, self._lights, self._advisor = world.route, signal_stops(world, vehicle), SpeedAdvisor()

    def see(self, lights: Mapping[tuple[str, int], Light]) -> None:
        """Take what traffic lights show (`lights.lights_of`)."""
        if self._lights is not None:
            self._lights.see(lights)

    def advise(self, seen: VehicleMotion, now_s: float) -> Advice:
        """Return what to drive now."""
        approach, limit_mps = self._approach(seen)
        if approach is None:
            self._advisor.reset()
            return NO_ADVICE
        left_m, line = approach.left_m, approach.line_m
        return self._advisor.advise(left_m, seen.vx_mps, limit_mps, approach.greens, now_s, line=line)

    def _approach(self, seen: VehicleMotion) -> tuple[Approach | None, float]:
        """Return the way to the next line and its limit (m/s); None: there is none, or it is not theirs."""
        if self._lights is None:
            return None, 0.0
        place = self._route.project(seen.x_m, seen.y_m)
        beside = abs(place.lateral_m) > OFF_ROUTE_M
        if beside or abs(math.remainder(seen.yaw_rad - self._route.at(place.s_m).yaw_rad, math.tau)) > _AGAINST_RAD:
            return None, 0.0
        approach = self._lights.approach(place.s_m)
        if approach is None:
            return None, 0.0
        way_m = np.arange(place.s_m, max(approach.line_m, place.s_m + 1.0), _LIMIT_EVERY_M)
        return approach, float(self._route.limits_at(way_m).min())
