import numpy as np
import pytest

from simconsole.evaluation.robots.clearances import Track, clearances, track_of
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.world.arena.outlines import Outlines

WALL = Outlines(np.array([(0.0, 0.0, 5.0, 0.0)]), np.array([(4.0, 2.0, 0.5)]))


def test_rims_are_held_against_walls_pillars_and_each_other_tick_by_tick() -> None:
    ticks = np.linspace(1.0, 2.0, 5)
    along = Track(np.column_stack((ticks, 0.3 + 0.1 * ticks)), 0.2)
    back = Track(np.column_stack((ticks[::-1], np.full(5, 2.0))), 0.1)
    first, second = clearances([along, back], WALL)
    assert first.wall_m == pytest.approx(0.4 - 0.2)
    assert second.wall_m == pytest.approx(2.0 - 0.5 - 0.1), "the pillar's rim"
    apart = np.hypot(ticks - ticks[::-1], 1.7 - 0.1 * ticks).min()
    assert first.robot_m == second.robot_m == pytest.approx(apart - 0.3), "where both were at one time"


def test_a_robot_alone_has_no_other_one_near_and_ticks_that_one_lacks_do_not_count() -> None:
    (alone,) = clearances([Track(np.array([(1.0, 1.0)]), 0.1)], WALL)
    assert alone.robot_m == float("inf")
    long, short = Track(np.array([(1.0, 1.0), (3.0, 1.0)]), 0.1), Track(np.array([(3.0, 1.5)]), 0.1)
    assert clearances([long, short], WALL)[0].robot_m == pytest.approx(np.hypot(2.0, 0.5) - 0.2)


def test_the_middle_of_a_body_lies_where_the_profile_says() -> None:
    waffle = load_vehicle("turtlebot3_waffle")
    assert isinstance(waffle, TurtlebotProfile)
    track = track_of(np.array([(1.0, 2.0, 0.5 * np.pi)]), waffle)
    assert track.middles_m[0] == pytest.approx((1.0, 2.0 + waffle.body_x_m))
    assert track.radius_m == waffle.body_radius_m
