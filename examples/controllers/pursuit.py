"""Pure pursuit, for both Python controllers: a turn rate from a pose and a route. Knows no ROS."""

import math

SPEED_MPS = 8.0
AHEAD_M = 7.0


class Pursuit:
    """Follows a route, a list of points (x, y) in m."""

    def __init__(self, route: list[tuple[float, float]]) -> None:
        self.route, self.at = route, 0

    def turn_rate(self, x_m: float, y_m: float, yaw_rad: float) -> float:
        """Return the turn rate in rad/s that leads through the point of the route 7 m ahead."""
        if not self.route:
            return 0.0  # not told yet
        while math.dist(self._point(self.at), (x_m, y_m)) > math.dist(self._point(self.at + 1), (x_m, y_m)):
            self.at += 1
        ahead = self.at
        while math.dist(self._point(ahead), (x_m, y_m)) < AHEAD_M:
            ahead += 1
        goal_x_m, goal_y_m = self._point(ahead)
        bearing_rad = math.atan2(goal_y_m - y_m, goal_x_m - x_m) - yaw_rad
        return SPEED_MPS * 2.0 * math.sin(bearing_rad) / AHEAD_M

    def _point(self, at: int) -> tuple[float, float]:
        return self.route[at % len(self.route)]
