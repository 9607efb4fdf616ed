"""The autopilot's plan as nav_msgs/Path in `map`: what it would do in the next seconds, now and then. Pure."""

import math
from collections.abc import Iterable
from typing import Any, Final

import numpy as np

from simconsole.bridge.messages import Registry
from simconsole.drivers.path_tracker.plan import Place
from simconsole.values.height_field import HeightField, spline_at
from simconsole.values.units import NS_PER_S

PLAN: Final = "/autopilot/plan"
PLAN_TYPE: Final = "nav_msgs/Path"
MAP_FRAME: Final = "map"
_ROUNDING_S: Final = 1e-6


class PlanMessages:
    """Says when a plan is due, by the stamps of what is answered, and writes it down.

    Attributes:
        hz: how often a second; 0: never.
    """

    def __init__(self, registry: Registry, rate_hz: float, ground: HeightField | None = None) -> None:
        """Plan `rate_hz` times a second, never for 0; places lie on `ground`, without one at height 0."""
        self._path, self._pose = registry.struct(PLAN_TYPE), registry.struct("geometry_msgs/PoseStamped")
        self.hz = rate_hz
        self._period_s = 1.0 / rate_hz if rate_hz > 0.0 else math.inf
        self._ground = ground
        self._newest_s = -math.inf

    def is_due(self, stamp_s: float) -> bool:
        """Return whether a plan is due with what has this stamp; then it counts as made."""
        if self._period_s == math.inf or self._newest_s <= stamp_s < self._newest_s + self._period_s - _ROUNDING_S:
            return False
        self._newest_s = stamp_s
        return True

    def message(self, stamp: Any, places: Iterable[Place]) -> Any:
        """Return a nav_msgs/Path with the stamp of what was answered; each place has the stamp at which it is meant."""
        path = self._path()
        path.header.stamp, path.header.frame_id = stamp, MAP_FRAME
        seen_ns = stamp.sec * NS_PER_S + stamp.nanosec
        planned = list(places)
        for place, z_m in zip(planned, self._heights(planned), strict=True):
            pose = self._pose()
            then = pose.header.stamp
            then.sec, then.nanosec = divmod(seen_ns + round(place.after_s * NS_PER_S), NS_PER_S)
            pose.header.frame_id = MAP_FRAME
            at, turn = pose.pose.position, pose.pose.orientation
            at.x, at.y, at.z = place.x_m, place.y_m, z_m
            turn.z, turn.w = math.sin(0.5 * place.yaw_rad), math.cos(0.5 * place.yaw_rad)
            path.poses.append(pose)
        return path

    def _heights(self, places: list[Place]) -> list[float]:
        if self._ground is None or not places:
            return [0.0] * len(places)
        x_m, y_m = np.array([(place.x_m, place.y_m) for place in places]).T
        heights: list[float] = spline_at(self._ground, 0, x_m, y_m).tolist()
        return heights
