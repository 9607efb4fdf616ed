"""Pure pursuit of a route: the speed and the yaw rate that bring a car to it and keep it there. No ROS here."""

import math
from collections.abc import Sequence

LOOKAHEAD_S = 0.7
MIN_LOOKAHEAD_M = 3.5
PREVIEW_M = 20.0
"""Stretch of the route ahead whose sharpest bend limits the speed."""
WINDOW = 30
"""Points of the route beyond the last nearest one among which the next nearest one is looked for."""

Point = tuple[float, float]


class Pursuit:
    """Follows one lap of a route, again and again."""

    def __init__(self, route_m: Sequence[Point], speed_mps: float, lateral_accel_mps2: float) -> None:
        """Take a route.

        Args:
            route_m: x and y of points in driving order, the last one near the first one.
            speed_mps: on straight road.
            lateral_accel_mps2: what the car may have of it in a bend.

        Raises:
            ValueError: the route has less than three points.
        """
        if len(route_m) < 3:
            raise ValueError(f"a route of {len(route_m)} points cannot be followed")
        self._route_m = list(route_m)
        self._speed_mps = speed_mps
        self._lateral_accel_mps2 = lateral_accel_mps2
        self._nearest: int | None = None

    def command(self, x_m: float, y_m: float, yaw_rad: float) -> tuple[float, float]:
        """Return the speed in m/s and the yaw rate in rad/s for a car at this pose."""
        nearest = self._find_nearest(x_m, y_m)
        speed_mps = min(self._speed_mps, math.sqrt(self._lateral_accel_mps2 / self._sharpest_1pm(nearest)))
        target_x_m, target_y_m = self._point_ahead(nearest, max(MIN_LOOKAHEAD_M, LOOKAHEAD_S * speed_mps))
        angle_rad = math.atan2(target_y_m - y_m, target_x_m - x_m) - yaw_rad
        distance_m = math.hypot(target_x_m - x_m, target_y_m - y_m)
        return speed_mps, speed_mps * 2.0 * math.sin(angle_rad) / max(distance_m, MIN_LOOKAHEAD_M)

    def _find_nearest(self, x_m: float, y_m: float) -> int:
        count = len(self._route_m)
        first = 0 if self._nearest is None else self._nearest
        window = range(first, first + (count if self._nearest is None else min(WINDOW, count)))
        self._nearest = min(window, key=lambda index: math.dist((x_m, y_m), self._route_m[index % count])) % count
        return self._nearest

    def _point_ahead(self, index: int, distance_m: float) -> Point:
        """Return the point of the route that lies a distance beyond one of its points."""
        while True:
            here, there = self._at(index), self._at(index + 1)
            step_m = math.dist(here, there)
            if step_m >= distance_m:
                share = distance_m / step_m
                return here[0] + share * (there[0] - here[0]), here[1] + share * (there[1] - here[1])
            distance_m -= step_m
            index += 1

    def _sharpest_1pm(self, index: int) -> float:
        """Return the greatest curvature within the preview."""
        sharpest_1pm, ahead_m = 1e-6, 0.0
        while ahead_m < PREVIEW_M:
            before, here, after = self._at(index - 1), self._at(index), self._at(index + 1)
            turn_rad = math.atan2(after[1] - here[1], after[0] - here[0])
            turn_rad -= math.atan2(here[1] - before[1], here[0] - before[0])
            step_m = max(math.dist(here, after), 1e-3)
            sharpest_1pm = max(sharpest_1pm, abs(math.remainder(turn_rad, math.tau)) / step_m)
            ahead_m += step_m
            index += 1
        return sharpest_1pm

    def _at(self, index: int) -> Point:
        return self._route_m[index % len(self._route_m)]
