"""What the console's vehicle owes others on the world's route, as everybody can see: its true place, all lights."""

from collections.abc import Callable, Sequence
from typing import Final

from simconsole.values.signals import SignalState
from simconsole.world.roads.lane_graph import Leg
from simconsole.world.roads.road_map import Array, RoadMap
from simconsole.world.route import Route
from simconsole.world.rules.conflicts import duties
from simconsole.world.rules.right_of_way import NOTHING_OWED, Motion, Owed, RightOfWay
from simconsole.world.rules.timetable import Signals
from simconsole.world.traffic.road_users import Box

ShownAt = Callable[[int, int, int], SignalState]
"""What a signal shows: by its place in the map, its link and the tick."""
BESIDE_M: Final = 5.0
"""Who is further beside the route goes another way, of which nothing is known."""
TURNED_RAD: Final = 1.0


class Owing:
    """Looks at road users after each step of traffic."""

    def __init__(
        self, road_map: RoadMap, legs: Sequence[Leg], route: Route, tick_hz: int, state: ShownAt | None = None
    ) -> None:
        """Take the way of the vehicle over a map, whose signals run their own programs unless `state` tells."""
        self._route, self._tick_hz = route, tick_hz
        self._right_of_way = RightOfWay(duties(road_map, legs, route))
        self._state = state or Signals(road_map.signals, tick_hz).state
        self._s_m: float | None = None

    def owed(self, ego: Box, users: Array, tick: int) -> Owed:
        """Return what the vehicle owes others; nothing where it is not on its route."""
        place = self._route.project(ego.x_m, ego.y_m, self._s_m, ego.yaw_rad)
        if abs(place.lateral_m) > BESIDE_M or abs(place.heading_error_rad) > TURNED_RAD:
            self._s_m = None
            return NOTHING_OWED
        self._s_m = place.s_m
        own = Motion(place.s_m + 0.5 * ego.length_m, abs(ego.speed_mps), tick / self._tick_hz)
        return self._right_of_way.owed(own, users, lambda signal, link: self._state(signal, link, tick))
