"""Where the autopilot waits for others: people on crossings, and vehicles that go first at junctions. Pure.

From where road users were told to be and what lights were told to show (`world/rules/right_of_way.py`). The stop is
decided as one for a light is; who steps out late is braked for as hard as it takes. A front that has come a little
beyond the line meanwhile stops at once, for the ways of others begin further on; one that is through goes on.
"""

import math
from typing import Final

from simconsole.drivers.autopilot.others import OLD_S
from simconsole.drivers.path_tracker.signal_stops import GAP_M, GENTLE_MPS2, SignalStops, needed_mps2
from simconsole.drivers.path_tracker.speed_profile import Stop, stopping
from simconsole.profiles.vehicle import CarProfile, VehicleProfile
from simconsole.values.signals import FAR, SignalState
from simconsole.world.roads.road_map import Array
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.conflicts import Duties, duties
from simconsole.world.rules.right_of_way import Motion, RightOfWay
from simconsole.world.world import World

HARDEST_MPS2: Final = 6.0
_MORE_MPS2: Final = 0.5
_FASTER_MPS: Final = 0.3


class Yields:
    """Decides anew with each message about road users, and keeps to it until the next."""

    def __init__(self, owed_at: Duties, front_m: float, lights: SignalStops | None) -> None:
        """Give way where `owed_at` says, in a car whose front is `front_m` ahead of base_link."""
        self._right_of_way, self._front_m, self._lights = RightOfWay(owed_at), front_m, lights
        self._told: tuple[Array, float] | None = None
        self._stamp_s = -math.inf
        self._line_m: float | None = None
        self._brake_mps2 = GENTLE_MPS2

    def see(self, users: Array, stamp_s: float) -> None:
        """Take the road users as they were at `stamp_s`, float64 [users, FIELDS]."""
        self._told, self._stamp_s = (users, stamp_s), stamp_s

    def stop(self, s_m: float, speed_mps: float, now_s: float) -> Stop | None:
        """Return where base_link is to stop, None to drive on, while it is at `s_m`."""
        if self._told is not None:
            users, stamp_s = self._told
            self._told = None
            front_m = s_m + self._front_m
            owed = self._right_of_way.owed(Motion(front_m, abs(speed_mps), stamp_s), users, self._light)
            line_m = front_m + owed.yield_m if -GAP_M < owed.yield_m < FAR else None
            if line_m is None or self._line_m is None or abs(line_m - self._line_m) > GAP_M:
                self._brake_mps2 = GENTLE_MPS2
            self._line_m = line_m
        if self._line_m is None or now_s - self._stamp_s > OLD_S:
            return None
        stop_m = self._line_m - self._front_m - GAP_M
        needed = min(needed_mps2(stop_m - s_m, speed_mps), HARDEST_MPS2)
        too_fast = speed_mps > stopping(stop_m - s_m, self._brake_mps2)[0] + _FASTER_MPS
        if (
            needed > self._brake_mps2 + _MORE_MPS2 and too_fast
        ):  # near the stop more is needed of a car that keeps to it
            self._brake_mps2 = needed
        return Stop(stop_m, self._brake_mps2)

    def _light(self, signal: int, link: int) -> int:
        return SignalState.UNAVAILABLE if self._lights is None else self._lights.state(signal, link)


def yields(world: World, vehicle: VehicleProfile, lights: SignalStops | None) -> Yields | None:
    """Return where a car gives way on the route of a world, None where nothing is known of that."""
    roads = roads_of(world)
    if roads is None:
        return None
    front_m = 0.0
    if isinstance(vehicle, CarProfile):
        front_m = vehicle.body.length_m - vehicle.body.rear_overhang_m
    return Yields(duties(roads.road_map, roads.legs, world.route), front_m, lights)
