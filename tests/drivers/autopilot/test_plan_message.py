import math

import numpy as np
import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.drivers.autopilot.plan_message import PlanMessages
from simconsole.drivers.path_tracker.plan import Place
from simconsole.profiles.files.world_files import load_world
from simconsole.values.height_field import spline_at
from simconsole.world.kinds.worlds import open_world

REGISTRY = standard_registry()
PLACES = [Place(0.01, 1.0, 2.0, 0.5), Place(0.26, 3.0, 4.0, -0.5)]


def stamp(sec: int, nanosec: int = 0) -> object:
    return REGISTRY.struct("builtin_interfaces/Time")(sec=sec, nanosec=nanosec)


def test_a_plan_is_due_some_times_a_second_of_what_is_answered_and_anew_when_time_begins_anew() -> None:
    plans = PlanMessages(REGISTRY, 5.0)
    due = [step for step in range(50) if plans.is_due(0.02 * step)]
    assert due == [0, 10, 20, 30, 40]
    assert plans.is_due(0.0)
    assert not plans.is_due(0.02)


def test_without_a_rate_none_is() -> None:
    plans = PlanMessages(REGISTRY, 0.0)
    assert not any(plans.is_due(float(step)) for step in range(5))


def test_each_place_is_a_pose_in_map_with_the_time_at_which_it_is_meant() -> None:
    message = PlanMessages(REGISTRY, 5.0).message(stamp(7, 900_000_000), PLACES)
    assert (message.header.frame_id, message.header.stamp.sec) == ("map", 7)
    first, last = message.poses
    assert [(pose.header.frame_id, pose.header.stamp.sec, pose.header.stamp.nanosec) for pose in message.poses] == [
        ("map", 7, 910_000_000),
        ("map", 8, 160_000_000),
    ]
    assert (first.pose.position.x, first.pose.position.y, first.pose.position.z) == (1.0, 2.0, 0.0)
    assert 2.0 * math.atan2(last.pose.orientation.z, last.pose.orientation.w) == pytest.approx(-0.5)


def test_no_plan_is_a_path_without_places() -> None:
    assert PlanMessages(REGISTRY, 5.0).message(stamp(1), ()).poses == []


def test_on_hilly_ground_places_lie_on_it() -> None:
    world = open_world(load_world("country"))
    assert world.ground is not None
    at = world.route.at(200.0)
    message = PlanMessages(REGISTRY, 5.0, world.ground).message(stamp(1), [Place(0.0, at.x_m, at.y_m, at.yaw_rad)])
    expected = float(spline_at(world.ground, 0, np.array([at.x_m]), np.array([at.y_m]))[0])
    assert message.poses[0].pose.position.z == pytest.approx(expected)
    assert abs(expected) > 0.1
