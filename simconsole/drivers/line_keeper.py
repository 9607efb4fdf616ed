"""Steering along a straight line: where a car stands beside it, and two laws that lead back. Pure.

Pure pursuit aims at a point of the line ahead and needs only the pose: the simulated person uses it. State feedback
also takes the yaw rate, so that it damps a car that is braked hard: the test driver uses it. Both return a road-wheel
angle. Drivers of a course use a preview of its bends instead: `path_tracker` and `manoeuvre_driver.lane_changer`.
"""

import math
from typing import Final, NamedTuple

# State feedback of the offset LINE_AHEAD_M further on, the heading, and the yaw rate (damping).
LINE_GAIN_RADPM: Final = 0.12
LINE_AHEAD_M: Final = 1.3
HEADING_GAIN: Final = 0.9
YAW_RATE_GAIN_S: Final = 0.25
MOST_ROAD_WHEEL_RAD: Final = 0.5


class Deviation(NamedTuple):
    """Where a car is beside a line, and how far it has turned left from its direction."""

    offset_m: float  # to the left
    heading_rad: float  # -pi to pi


class Line(NamedTuple):
    """The straight through a pose."""

    x_m: float
    y_m: float
    yaw_rad: float

    def deviation(self, x_m: float, y_m: float, yaw_rad: float) -> Deviation:
        """Return where a pose is beside the line."""
        dx, dy = x_m - self.x_m, y_m - self.y_m
        offset_m = dy * math.cos(self.yaw_rad) - dx * math.sin(self.yaw_rad)
        return Deviation(offset_m, math.remainder(yaw_rad - self.yaw_rad, math.tau))


X_AXIS: Final = Line(0.0, 0.0, 0.0)


def pure_pursuit(beside: Deviation, ahead_m: float, wheelbase_m: float) -> float:
    """Return the road-wheel angle in rad of the arc to the point of the line that is `ahead_m` on.

    Coulter, Implementation of the Pure Pursuit Path Tracking Algorithm, CMU-RI-TR-92-01, by the Ackermann angle.
    """
    angle_rad = math.atan2(-beside.offset_m, ahead_m) - beside.heading_rad
    curvature_per_m = 2.0 * math.sin(angle_rad) / math.hypot(ahead_m, beside.offset_m)
    return math.atan(wheelbase_m * curvature_per_m)


def state_feedback(beside: Deviation, yaw_rate_radps: float) -> float:
    """Return the road-wheel angle in rad that leads back to the line, within MOST_ROAD_WHEEL_RAD."""
    wanted = -LINE_GAIN_RADPM * (beside.offset_m + LINE_AHEAD_M * beside.heading_rad)
    wanted -= HEADING_GAIN * beside.heading_rad + YAW_RATE_GAIN_S * yaw_rate_radps
    return min(MOST_ROAD_WHEEL_RAD, max(-MOST_ROAD_WHEEL_RAD, wanted))
