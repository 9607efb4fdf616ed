"""Where odometry has had a robot over the last seconds: its pose at any time between two messages."""

from collections import deque
from typing import Final

import numpy as np
from numpy.typing import NDArray

from simconsole.drivers.robots.slam.planar import wrapped
from simconsole.values.platform import Pose

Array = NDArray[np.float64]

KEPT_S: Final = 5.0


class OdometryTrack:
    """Poses of the last KEPT_S, in the order of their times."""

    def __init__(self) -> None:
        """Start without a pose."""
        self._poses: deque[tuple[float, float, float, float]] = deque()

    @property
    def newest_s(self) -> float:
        """Time of the newest pose; minus infinity without one."""
        return self._poses[-1][0] if self._poses else -np.inf

    @property
    def oldest_s(self) -> float:
        """Time of the oldest pose that is kept; infinity without one."""
        return self._poses[0][0] if self._poses else np.inf

    def add(self, time_s: float, pose: Pose) -> None:
        """Take a pose; one that is not newer than the newest is passed over."""
        if time_s <= self.newest_s:
            return
        turn = self._poses[-1][3] if self._poses else pose.yaw_rad
        self._poses.append((time_s, pose.x_m, pose.y_m, turn + wrapped(pose.yaw_rad - turn)))
        while self._poses[0][0] < time_s - KEPT_S:
            self._poses.popleft()

    def at(self, times_s: Array) -> Array:
        """Return x, y, yaw [N, 3] at these times, the nearest pose for those outside; yaw has no jumps.

        Raises:
            ValueError: there is no pose.
        """
        if not self._poses:
            raise ValueError("no odometry yet")
        known = np.array(self._poses)
        return np.column_stack([np.interp(times_s, known[:, 0], known[:, column]) for column in (1, 2, 3)])
