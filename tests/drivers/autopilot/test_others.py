import math
from typing import Any

import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.drivers.autopilot.others import OLD_S, Others, road_users_of
from simconsole.drivers.path_tracker.speed_control import Leader
from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.world.roads.lane_graph import LaneGraph
from simconsole.world.roads.road_route import route_over
from simconsole.world.traffic.road_users import NOBODY, RoadUser, table
from tests.world.nets import straight_map

CAR = load_vehicle("hatchback")
FRONT_M = CAR.body.length_m - CAR.body.rear_overhang_m  # type: ignore[union-attr]
USER = RoadUser(
    id=1.0,
    kind=1.0,
    x_m=0.0,
    y_m=0.0,
    yaw_rad=0.0,
    speed_mps=5.0,
    length_m=4.0,
    width_m=1.8,
    height_m=1.5,
)


def on_the_road() -> tuple[Others, VehicleMotion, RoadUser]:
    """What the car knows, the car at the beginning of a straight road, and a vehicle 40 m further on."""
    road_map = straight_map()
    route = route_over(road_map, LaneGraph(road_map).drawn(1, 100.0))
    here, there = route.at(5.0), route.at(45.0)
    seen = VehicleMotion(here.x_m, here.y_m, here.yaw_rad, 10.0, 0.0, 0.0)
    return Others(route, CAR), seen, USER._replace(x_m=there.x_m, y_m=there.y_m, yaw_rad=there.yaw_rad)


def test_gap_is_from_front_to_rear_and_follows_the_leader_between_messages() -> None:
    others, seen, user = on_the_road()
    assert others.leader(seen, 10.0) is None, "nothing heard yet"
    others.see(table([user]), 10.0)
    gap_m = 40.0 - 2.0 - FRONT_M
    assert others.leader(seen, 10.0) == pytest.approx(Leader(gap_m, 5.0), abs=1e-6)
    assert others.leader(seen, 10.2) == pytest.approx(Leader(gap_m + 1.0, 5.0), abs=1e-6)


def test_road_users_who_are_no_longer_told_are_gone() -> None:
    others, seen, user = on_the_road()
    others.see(table([user]), 10.0)
    assert others.leader(seen, 10.0 + OLD_S) is not None
    assert others.leader(seen, 10.1 + OLD_S) is None
    others.see(NOBODY, 11.0)
    assert others.leader(seen, 11.0) is None


def message(**changes: Any) -> Any:
    registry = standard_registry()
    told = registry.struct("simconsole_msgs/RoadUser")()
    told.id, told.kind = 7, 2
    told.pose.position.x, told.pose.position.y, told.pose.position.z = 3.0, -4.0, 12.0
    told.turn_indicators = -1
    told.pose.orientation.z, told.pose.orientation.w = math.sin(-1.0), math.cos(-1.0)
    told.twist.linear.x = changes.get("speed_mps", 6.0)
    told.size.x, told.size.y, told.size.z = 5.0, 2.0, 1.9
    whole = registry.struct("simconsole_msgs/RoadUsers")()
    whole.header.stamp.sec, whole.header.stamp.nanosec = 12, 500_000_000
    whole.users = [told]
    return whole


def test_message_is_read_as_it_was_meant() -> None:
    rows, stamp_s = road_users_of(message())
    assert stamp_s == 12.5
    assert rows.tolist() == [pytest.approx([7.0, 2.0, 3.0, -4.0, -2.0, 6.0, 5.0, 2.0, 1.9, 12.0, -1.0])]


def test_values_that_are_no_numbers_are_nobody() -> None:
    assert len(road_users_of(message(speed_mps=math.nan))[0]) == 0
