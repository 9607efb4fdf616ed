"""The scripted lead vehicle: on the world's route, by speeds over time, looking at nobody."""

from typing import Final

from simconsole.profiles.traffic import LeadVehicle
from simconsole.values.kernels import approach
from simconsole.values.units import MPS_PER_KMH
from simconsole.world.route import Route
from simconsole.world.traffic.road_users import Box

LENGTH_M: Final = 4.5
WIDTH_M: Final = 1.8


class LeadDriver:
    """Drives a lead vehicle along a route, to the end of it at most."""

    def __init__(self, profile: LeadVehicle, route: Route, start_m: float) -> None:
        """Begin `gap_m` after `start_m` on the route."""
        self._profile = profile
        self._route = route
        self._s_m = start_m + profile.gap_m
        self._speed_mps = 0.0
        self._time_s = 0.0
        self._crashed = False

    def crash(self, change_mps: float) -> None:
        """Change its speed by a collision; from now on it only comes to rest."""
        self._speed_mps = max(0.0, self._speed_mps + change_mps)
        self._crashed = True

    def step(self, period_s: float) -> Box:
        """Drive on for a period; return where the vehicle is then."""
        wanted = 0.0
        for one in self._profile.speeds:
            if self._time_s >= one.from_s:
                wanted = one.speed_kmh * MPS_PER_KMH
        if self._crashed:
            wanted = 0.0
        if not self._route.closed and self._s_m >= self._route.length_m:
            wanted = 0.0
        before = self._speed_mps
        self._speed_mps = approach(before, wanted, self._profile.acceleration_mps2 * period_s)
        self._s_m += 0.5 * (before + self._speed_mps) * period_s
        self._time_s += period_s
        place = self._route.at(self._s_m)
        return Box(
            x_m=place.x_m,
            y_m=place.y_m,
            yaw_rad=place.yaw_rad,
            speed_mps=self._speed_mps,
            length_m=LENGTH_M,
            width_m=WIDTH_M,
        )
