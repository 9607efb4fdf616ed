"""Where vehicles come onto the road: anywhere at the beginning, later where roads come into the map."""

from typing import Final

import numpy as np

from simconsole.world import traffic_columns as at
from simconsole.world.roads.road_map import Array
from simconsole.world.traffic.network import Network, Numbers
from simconsole.world.traffic.paths import middle_at

CLEAR_M: Final = 16.0
"""As far apart are vehicles at least when one of them comes onto the road."""
_TRIES: Final = 40  # at the beginning; later one in each step, until there is room
_FROM_START_M: Final = 8.0
_FROM_END_M: Final = 25.0
_START_SHARE: Final = 0.5  # of the limit, at which a vehicle begins


class Placement:
    """Puts vehicles onto lanes, drawn from a generator."""

    def __init__(self, net: Network, rng: np.random.Generator) -> None:
        self._net = net
        self._rng = rng
        begins = np.diff(net.out_starts) > 0
        long_enough = net.lengths_m > _FROM_START_M + _FROM_END_M
        arrived = np.zeros(len(net.lengths_m), np.bool_)
        arrived[net.goals[net.out]] = True
        self._anywhere = np.flatnonzero(begins & long_enough)
        entries = np.flatnonzero(begins & long_enough & ~arrived)
        self._entries = entries if len(entries) else self._anywhere

    def place(self, values: Array, path: Numbers, taken: Array, *, anywhere: bool) -> bool:
        """Put a new vehicle onto a lane, as far from others as `taken` [N, 3] says; return whether there was room."""
        lanes, rng, net = self._anywhere if anywhere else self._entries, self._rng, self._net
        for _ in range((_TRIES if anywhere else 1) if len(lanes) else 0):
            lane = int(lanes[rng.integers(len(lanes))])
            room = float(net.lengths_m[lane]) - _FROM_START_M - _FROM_END_M
            s = _FROM_START_M + (room * float(rng.random()) if anywhere else 0.0)
            path[:] = 0
            path[at.COUNT], path[at.LANES], path[at.CONNECTIONS] = 1, lane, -1
            place = middle_at(net, path, s)
            if (np.hypot(taken[:, 0] - place.x_m, taken[:, 1] - place.y_m) < taken[:, 2]).any():
                continue
            path[at.DRAW] = int(rng.integers(1, 2**31 - 1))
            self._draw_vehicle(values)
            values[at.X : at.SINE + 1] = place
            values[at.LANE : at.ALONG + 1] = lane, s
            values[at.S] = s
            values[at.SPEED] = _START_SHARE * float(net.limits_mps[lane])
            return True
        values[at.LENGTH] = 0.0
        return False

    def _draw_vehicle(self, values: Array) -> None:
        """Draw a vehicle and its driver: size, share of the limit, time gap."""
        rng = self._rng
        values[:] = 0.0
        van = rng.random() < 0.15
        values[at.LENGTH] = rng.uniform(5.3, 6.0) if van else rng.uniform(3.8, 4.9)
        values[at.WIDTH] = 2.0 if van else rng.uniform(1.7, 1.85)
        values[at.SPEED_SHARE] = rng.uniform(0.85, 1.05)
        values[at.TIME_GAP] = rng.uniform(1.0, 1.6)
        values[at.CHANGED] = 1.0
