"""What the autopilot knows of other road users: where they were told to be, and whom it follows. Pure."""

import math
from typing import Any, Final

from simconsole.drivers.path_tracker.speed_control import Leader
from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.profiles.vehicle import CarProfile, VehicleProfile
from simconsole.values.signals import FAR
from simconsole.values.units import NS_PER_S
from simconsole.world.roads.road_map import Array
from simconsole.world.route import Route
from simconsole.world.traffic.leader import Execution, Leaders
from simconsole.world.traffic.road_users import NOBODY, Box, RoadUser, table

ROAD_USERS: Final = "/road_users"
ROAD_USERS_TYPE: Final = "simconsole_msgs/RoadUsers"
OLD_S: Final = 1.0
"""Road users of which nothing was heard for longer count as gone: the car cannot wait for a place that nobody keeps."""


class Others:
    """Finds whom the car follows among the road users that were told last."""

    def __init__(self, route: Route, vehicle: VehicleProfile, execution: Execution | None = None) -> None:
        """Follow `route` in `vehicle`; `execution` is how the search runs, plain without it."""
        self._leaders = Leaders(route, execution)
        self._length_m = self._width_m = self._rear_m = 0.0
        if isinstance(vehicle, CarProfile):
            body = vehicle.body
            self._length_m, self._width_m, self._rear_m = body.length_m, body.width_m, body.rear_overhang_m
        self._users: Array = NOBODY
        self._stamp_s = -math.inf

    def see(self, users: Array, stamp_s: float) -> None:
        """Take the road users as they were at `stamp_s`, float64 [users, FIELDS]."""
        self._users, self._stamp_s = users, stamp_s

    def leader(self, seen: VehicleMotion, now_s: float) -> Leader | None:
        """Return whom the car at `seen` follows, None where nobody is ahead."""
        if now_s - self._stamp_s > OLD_S:
            return None
        ahead_m = 0.5 * self._length_m - self._rear_m
        ego = Box(
            x_m=seen.x_m + ahead_m * math.cos(seen.yaw_rad),
            y_m=seen.y_m + ahead_m * math.sin(seen.yaw_rad),
            yaw_rad=seen.yaw_rad,
            speed_mps=seen.vx_mps,
            length_m=self._length_m,
            width_m=self._width_m,
        )
        found = self._leaders.find(ego, self._users)
        if found.lead_gap_m >= FAR:
            return None
        late_s = max(0.0, now_s - self._stamp_s)
        return Leader(found.lead_gap_m + late_s * found.lead_speed_mps, found.lead_speed_mps)


def road_users_of(message: Any) -> tuple[Array, float]:
    """Return what a simconsole_msgs/RoadUsers tells, float64 [users, FIELDS], and its stamp in s."""
    stamp = message.header.stamp
    told = [
        RoadUser(
            id=float(user.id),
            kind=float(user.kind),
            x_m=user.pose.position.x,
            y_m=user.pose.position.y,
            yaw_rad=2.0 * math.atan2(user.pose.orientation.z, user.pose.orientation.w),
            speed_mps=user.twist.linear.x,
            length_m=user.size.x,
            width_m=user.size.y,
            height_m=user.size.z,
            z_m=user.pose.position.z,
            turn_indicators=float(user.turn_indicators),
        )
        for user in message.users
    ]
    rows = table([user for user in told if all(map(math.isfinite, user))])
    return rows, stamp.sec + stamp.nanosec / NS_PER_S
