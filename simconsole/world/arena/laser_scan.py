"""Scans of a robot's lidar, made from a state vector when somebody wants one: they are in no state.

The state holds the robot's pose at both ends of the lidar's last whole turn; ranges follow from them, the arena, and
errors drawn by the number of the turn. So a scan is the same in every run, whoever asks for it.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.profiles.parts.turtlebot import LidarProfile
from simconsole.values.draws import Channel, normals
from simconsole.values.kernels import Row
from simconsole.values.units import NS_PER_S
from simconsole.vehicle.turtlebot.robot_state import RobotState
from simconsole.world.arena.lidar import Beam, End, sweep
from simconsole.world.arena.raycast import RayGrid

Execution = Callable[[Callable[..., Any]], Callable[..., Any]]
"""How kernels run: `jit.compiled` or `jit.plain`; both give equal bits."""
NOBODY = np.empty((0, 3))


class Scan(NamedTuple):
    """One turn of the lidar."""

    number: int
    age_ns: int  # of its first ray
    ranges_m: NDArray[np.float64]  # anticlockwise from straight ahead; 0: no echo


class LaserScanner:
    """The lidar of one robot in an arena."""

    def __init__(self, profile: LidarProfile, grid: RayGrid, seed: int, execution: Execution) -> None:
        """Cast rays in what `grid` holds; `seed` is that of the errors."""
        self.profile = profile
        self._grid = grid
        self._seed = seed
        self._sweep = execution(sweep)
        self._beam = Beam(profile.x_m, profile.min_m, profile.max_m, profile.turn_s)

    def scan(self, state: RobotState, others: Row = NOBODY) -> Scan | None:
        """Return the last whole turn, None before the first.

        Args:
            state: of the robot.
            others: other robots: float64 [N, 3], x, y, radius in m of map.
        """
        number = int(state.gauges.scans)
        if number == 0:
            return None
        profile, count = self.profile, self.profile.samples
        noise = np.zeros(count)
        if profile.noise_m:
            noise = profile.noise_m * normals(self._seed, Channel.LIDAR, number * count, count)
        ranges = np.empty(count)
        self._sweep(End(*state.scan_from), End(*state.scan_to), self._beam, self._grid, others, noise, ranges)
        age_s = profile.turn_s + 0.001 * state.gauges.scan_ms
        return Scan(number, round(age_s * NS_PER_S), ranges)
