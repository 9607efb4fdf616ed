"""A robot's scans as points for the operators. Pure arrays, no rerun."""

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.scene.entities import Array, Colour
from simconsole.values.layout import read
from simconsole.values.trigonometry import wrap_angle
from simconsole.values.units import NS_PER_S
from simconsole.vehicle.turtlebot.robot_state import ROBOT, RobotState, others_of
from simconsole.world.arena.laser_scan import LaserScanner
from simconsole.world.arena.lidar import TWO_PI

ECHO: Final[Colour] = (255, 92, 92)
SCANS: Final = "platform.gauges.scans"


class LidarShapes(NamedTuple):
    """The echoes of several turns of the lidar, one turn after the other, in `map`."""

    times_ns: NDArray[np.int64]  # [turns]
    counts: list[int]  # how many echoes each has
    points: Array  # [echoes, 3] m


class LidarPoints:
    """Follows a robot's lidar through a drive."""

    def __init__(self, scanner: LaserScanner, columns: Sequence[str], tick_hz: int) -> None:
        """Make the points of `scanner` from whole state vectors with `columns`."""
        self._scanner = scanner
        self._scans = list(columns).index(SCANS)
        self._tick_hz = tick_hz
        self._seen = 0.0

    def of(self, vectors: Array, ticks: NDArray[np.int64]) -> LidarShapes | None:
        """Return the turns that have ended in some ticks, None if none has."""
        numbers = vectors[:, self._scans]
        ended = np.flatnonzero(np.diff(numbers, prepend=self._seen) != 0.0)
        self._seen = float(numbers[-1])
        found = [
            (int(ticks[row]), self._echoes(read(vectors[row], ROBOT), others_of(vectors[row])))
            for row in ended.tolist()
        ]
        if not found:
            return None
        return LidarShapes(
            times_ns=np.array([tick * NS_PER_S // self._tick_hz for tick, _ in found], np.int64),
            counts=[len(points) for _, points in found],
            points=np.concatenate([points for _, points in found]),
        )

    def _echoes(self, state: RobotState, others: Array) -> Array:
        scan, lidar = self._scanner.scan(state, others), self._scanner.profile
        if scan is None:
            return np.zeros((0, 3))
        begin, end = state.scan_from, state.scan_to
        hit = np.flatnonzero(scan.ranges_m > 0.0)
        share = hit / len(scan.ranges_m)
        # Straight from one end of the turn to the other: 0.2 s of a small robot's way.
        yaw = begin.yaw_rad + share * wrap_angle(end.yaw_rad - begin.yaw_rad)
        x = begin.x_m + share * (end.x_m - begin.x_m) + lidar.x_m * np.cos(yaw)
        y = begin.y_m + share * (end.y_m - begin.y_m) + lidar.x_m * np.sin(yaw)
        angle, range_m = yaw + share * TWO_PI, scan.ranges_m[hit]
        return np.column_stack((x + range_m * np.cos(angle), y + range_m * np.sin(angle), np.full(len(hit), lidar.z_m)))
