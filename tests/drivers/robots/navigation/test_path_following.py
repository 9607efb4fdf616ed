import math

import numpy as np
import pytest

from simconsole.drivers.robots.navigation.path_following import STOP, PathFollower, Speeds
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from tests.drivers.robots.arena_robot import burger

AT_0 = Pose(0.0, 0.0, 0.0)
NOTHING = np.empty((0, 2))
AHEAD = np.column_stack((np.linspace(0.0, 3.0, 61), np.zeros(61)))


def follower() -> PathFollower:
    return PathFollower(burger(), compiled)


def wall(x: float) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    return np.column_stack((np.full(80, x), np.linspace(-1.0, 1.0, 80)))


def test_on_a_straight_path_it_drives_as_fast_as_its_wheels_turn() -> None:
    told = follower().follow(AHEAD, AT_0, NOTHING)
    assert told.speed_mps == pytest.approx(burger().wheel_mps)
    assert told.yaw_rate_radps == pytest.approx(0.0)


def test_beside_a_path_it_turns_towards_it() -> None:
    assert follower().follow(AHEAD, Pose(0.5, 0.1, 0.0), NOTHING).yaw_rate_radps < -0.05
    assert follower().follow(AHEAD, Pose(0.5, -0.1, 0.0), NOTHING).yaw_rate_radps > 0.05


def test_where_the_path_leads_back_it_turns_on_the_spot() -> None:
    told = follower().follow(AHEAD, Pose(0.5, 0.0, 2.5), NOTHING)
    assert told.speed_mps == 0.0
    assert told.yaw_rate_radps == pytest.approx(-1.2)


def test_before_a_wall_it_slows_down_and_stops_in_time() -> None:
    drive = follower()
    told = drive.follow(AHEAD, AT_0, wall(0.35))
    assert 0.0 < told.speed_mps < 0.2
    x, step_s = 0.0, 0.1
    for _ in range(200):
        x += step_s * drive.follow(AHEAD, Pose(x, 0.0, 0.0), wall(1.0 - x)).speed_mps
    assert 1.0 - (x + burger().body_x_m) >= burger().radius_m + 0.05
    assert x > 0.5


def test_it_goes_round_what_stands_on_its_path() -> None:
    drive, pose = follower(), AT_0
    thing = np.array([(1.0 + 0.08 * math.cos(a), 0.03 + 0.08 * math.sin(a)) for a in np.linspace(0.0, math.tau, 40)])
    nearest = math.inf
    for _ in range(300):
        cosine, sine = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
        seen = (thing - (pose.x_m, pose.y_m)) @ np.array(((cosine, -sine), (sine, cosine)))
        told = drive.follow(AHEAD, pose, seen)
        nearest = min(nearest, float(np.hypot(seen[:, 0] - burger().body_x_m, seen[:, 1]).min()))
        yaw = pose.yaw_rad + 0.1 * told.yaw_rate_radps
        pose = Pose(pose.x_m + 0.1 * told.speed_mps * cosine, pose.y_m + 0.1 * told.speed_mps * sine, yaw)
    assert nearest >= burger().radius_m + 0.05
    assert nearest < 0.4, "it came along there"


def test_who_is_too_near_may_only_get_away() -> None:
    drive = follower()
    assert not drive.is_free(Speeds(0.1, 0.0), wall(0.1))
    assert drive.is_free(Speeds(-0.1, 0.0), wall(0.1))


def test_it_turns_to_a_heading_the_way_that_there_is_room_for() -> None:
    drive = follower()
    assert drive.turn(0.5, AT_0, NOTHING).yaw_rate_radps > 0.5
    assert drive.turn(-0.5, AT_0, NOTHING).yaw_rate_radps < -0.5
    boxed = np.array([(-0.032 + 0.16 * math.cos(a), 0.16 * math.sin(a)) for a in np.linspace(0.0, math.tau, 60)])
    assert drive.turn(0.5, AT_0, boxed) == STOP
