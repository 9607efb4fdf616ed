"""Local control: speeds that follow a path, and keep away from what the lidar sees.

Regulated pure pursuit (Macenski et al., Autonomous Robots 2023): towards a point a little ahead on the path, slower in
bends, near obstacles and before the goal; on the spot where the path leads sideways. Where its arc leaves too little
room, the arc that ends best of those that leave enough is driven in its place.
"""

import math
from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.drivers.robots.navigation.clearance import Arc, Room, room_along
from simconsole.drivers.robots.navigation.planner import KEEP_M
from simconsole.drivers.robots.navigation.robot_shape import RobotShape
from simconsole.drivers.robots.slam.mapper import Execution
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.drivers.robots.slam.planar import wrapped
from simconsole.values.platform import Pose


class Speeds(NamedTuple):
    """What a robot is told: a geometry_msgs/Twist's two."""

    speed_mps: float
    yaw_rate_radps: float


STOP: Final = Speeds(0.0, 0.0)
AHEAD_M: Final = 0.25
MARGIN_M: Final = 0.02
"""Beside KEEP_M: for the errors of ranges, and for what lies between two rays."""
_TURN_RADPS: Final = 1.2
_SIDEWAYS_RAD: Final = 0.7
_FORESIGHT_S: Final = 1.2
_NEAR_M: Final = 0.12
_SLOWEST: Final = 0.35  # of the speed, beside an obstacle or in a bend
_SHARES: Final = (1.0, 0.6, 0.3, 0.0, -0.3)
_RATES: Final = (0.0, 0.25, -0.25, 0.5, -0.5, 0.9, -0.9, 1.4, -1.4)
_HEADING_M: Final = 0.15  # what a radian of heading counts as
_BACKWARDS_M: Final = 0.1


class PathFollower:
    """Follows paths with one robot."""

    def __init__(self, shape: RobotShape, execution: Execution) -> None:
        """Drive a robot of this shape."""
        self._shape = shape
        self._room: Callable[..., Any] = execution(room_along)
        self.least_m = shape.radius_m + KEEP_M + MARGIN_M
        """From the middle of the body to what is seen."""

    def follow(self, path_m: Array, pose: Pose, points_m: Array) -> Speeds:
        """Return the speeds to drive now.

        Args:
            path_m: [N, 2], in map, from about the robot on.
            pose: of the robot's base, in map.
            points_m: [N, 2]: what the lidar sees, in the frame of the base.
        """
        x, y = _seen(pose, _ahead(path_m, pose))
        left_m = math.hypot(path_m[-1, 0] - pose.x_m, path_m[-1, 1] - pose.y_m)
        wanted = self._pursued(x, y, left_m, points_m)
        if self.is_free(wanted, points_m):
            return wanted
        return self._aside(x, y, points_m)

    def turn(self, to_rad: float, pose: Pose, points_m: Array) -> Speeds:
        """Return the speeds that turn on the spot to a heading in map; the other way round where there is no room."""
        away = wrapped(to_rad - pose.yaw_rad)
        wanted = Speeds(0.0, self._turn_rate(away))
        if self.is_free(wanted, points_m):
            return wanted
        other = Speeds(0.0, -math.copysign(_TURN_RADPS, away))
        return other if self.is_free(other, points_m) else STOP

    def is_free(self, speeds: Speeds, points_m: Array) -> bool:
        """Return whether driving on like this leaves enough room, or gets out of where there is too little."""
        arc = Arc(speeds.speed_mps, speeds.yaw_rate_radps, _FORESIGHT_S)
        room: Room = self._room(points_m, self._shape.body_x_m, arc)
        if room.first_m >= self.least_m:
            return room.least_m >= self.least_m
        return room.least_m >= room.first_m - 1e-3 and room.last_m > room.first_m + 0.01

    def _pursued(self, x: float, y: float, left_m: float, points_m: Array) -> Speeds:
        shape = self._shape
        angle = math.atan2(y, x)
        if abs(angle) > _SIDEWAYS_RAD:
            return Speeds(0.0, self._turn_rate(angle))
        bend = 2.0 * y / max(x * x + y * y, 1e-6)
        nearest = float(np.hypot(points_m[:, 0] - shape.body_x_m, points_m[:, 1]).min()) if len(points_m) else 9.0
        room = min(1.0, max(_SLOWEST, (nearest - self.least_m) / _NEAR_M))
        speed = shape.speed_mps * room * max(_SLOWEST, 1.0 - 0.1 * abs(bend))
        speed = min(speed, 0.05 + 2.0 * left_m, shape.wheel_mps / (1.0 + 0.5 * abs(bend) * shape.wheels_apart_m))
        return Speeds(speed, speed * bend)

    def _aside(self, x: float, y: float, points_m: Array) -> Speeds:
        """Return the free speeds whose arc ends best, seen from the point on the path; STOP is one of them."""
        best, least = STOP, math.hypot(x, y) + _HEADING_M * abs(math.atan2(y, x))
        shape = self._shape
        for share in _SHARES:
            for rate in _RATES:
                speed = share * max(0.0, min(shape.speed_mps, shape.wheel_mps - 0.5 * abs(rate) * shape.wheels_apart_m))
                at = _after(speed, rate)
                to_x, to_y = _seen(at, (x, y))
                cost = math.hypot(to_x, to_y) + _HEADING_M * abs(math.atan2(to_y, to_x))
                cost += _BACKWARDS_M if share < 0.0 else 0.0
                if cost < least - 0.01 and self.is_free(Speeds(speed, rate), points_m):
                    best, least = Speeds(speed, rate), cost
        return best

    def _turn_rate(self, away_rad: float) -> float:
        most = min(_TURN_RADPS, 0.9 * self._shape.yaw_rate_radps)
        return min(most, max(-most, 2.5 * away_rad))


def _after(speed_mps: float, rate_radps: float) -> Pose:
    """Return the pose at the end of an arc, from that at its beginning."""
    turn = rate_radps * _FORESIGHT_S
    if abs(turn) < 1e-6:
        return Pose(speed_mps * _FORESIGHT_S, 0.0, 0.0)
    radius = speed_mps / rate_radps
    return Pose(radius * math.sin(turn), radius * (1.0 - math.cos(turn)), turn)


def _ahead(path_m: Array, pose: Pose) -> tuple[float, float]:
    """Return the first point of a path, behind that nearest to the robot, that is AHEAD_M away; else its last."""
    away = np.hypot(path_m[:, 0] - pose.x_m, path_m[:, 1] - pose.y_m)
    nearest = int(np.argmin(away))
    far = np.flatnonzero(away[nearest:] >= AHEAD_M)
    x, y = path_m[nearest + int(far[0]) if len(far) else -1].tolist()
    return x, y


def _seen(pose: Pose, place: tuple[float, float]) -> tuple[float, float]:
    """Return a place in the frame of a pose."""
    cosine, sine = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
    away_x, away_y = place[0] - pose.x_m, place[1] - pose.y_m
    return cosine * away_x + sine * away_y, cosine * away_y - sine * away_x
