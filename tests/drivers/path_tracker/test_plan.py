"""What a tracker says that it will do, against what it then does."""

import math
from collections.abc import Callable
from copy import copy
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from simconsole.drivers.autopilot.answers import make_tracker
from simconsole.drivers.path_tracker.plan import PLACES, STEP_S, Place, plan
from simconsole.drivers.path_tracker.speed_control import Leader
from simconsole.drivers.path_tracker.speed_profile import Stop
from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.drivers.path_tracker.tracker import Tracker
from simconsole.drivers.path_tracker.tracker_settings import HATCHBACK, TRACKERS
from simconsole.world.course import Course

Drive = Callable[..., Any]
DELAY_S = 0.04


def beside(course: Course, s_m: float, lateral_m: float, speed_mps: float) -> VehicleMotion:
    at = course.at(s_m)
    x_m, y_m = at.x_m - lateral_m * math.sin(at.yaw_rad), at.y_m + lateral_m * math.cos(at.yaw_rad)
    return VehicleMotion(x_m, y_m, at.yaw_rad, speed_mps, 0.0, speed_mps * at.curvature_1pm)


def planned(course: Course, seen: VehicleMotion, name: str = "preview") -> list[Place]:
    tracker = make_tracker(name, course, HATCHBACK, DELAY_S)
    tracker.step(seen, True, 0.0)
    return list(plan(tracker, seen.vx_mps))


def test_before_its_first_step_a_tracker_plans_nothing(course: Course) -> None:
    assert list(plan(Tracker(course), 0.0)) == []


@pytest.mark.parametrize("name", TRACKERS)
def test_places_are_on_the_course_one_after_the_other_at_the_planned_speed(course: Course, name: str) -> None:
    tracker = make_tracker(name, course, HATCHBACK, DELAY_S)
    speed_mps = tracker.along.profile.at(300.0)[0]
    places = planned(course, beside(course, 300.0, 0.0, speed_mps), name)
    assert len(places) == PLACES
    assert np.diff([place.after_s for place in places]) == pytest.approx(STEP_S)
    s_m = [course.project(place.x_m, place.y_m, 300.0).s_m for place in places]
    between = [0.5 * (a + b) for a, b in pairwise(s_m)]
    speeds = [tracker.along.profile.at(place)[0] for place in between]
    np.testing.assert_allclose(np.diff(s_m) / STEP_S, speeds, atol=0.3)


def test_from_beside_the_course_the_plan_is_the_way_back(course: Course) -> None:
    places = planned(course, beside(course, 30.0, 0.8, 8.0))
    lateral = [course.project(place.x_m, place.y_m, 30.0).lateral_m for place in places]
    assert lateral[0] == pytest.approx(0.8, abs=0.02)
    assert abs(lateral[-1]) < 0.05
    assert max(np.diff(np.abs(lateral))) < 0.01


def test_the_car_then_does_what_was_planned(course: Course, laps: Drive, nominal: Any) -> None:
    """Five seconds later it is where it said, in time and beside the course."""
    start = beside(course, 560.0, 0.4, 7.0)
    places = planned(course, start)
    tracker = make_tracker("preview", course, HATCHBACK, DELAY_S)
    trace = laps(tracker, nominal, 640.0, start)
    for place in places:
        s_m, lateral_m, _ = course.project(place.x_m, place.y_m, 560.0)
        then_s = place.after_s - DELAY_S  # a step's place is where its command takes effect
        assert np.interp(then_s, trace.time_s, trace.s_m) == pytest.approx(s_m, abs=1.0)
        assert np.interp(then_s, trace.time_s, trace.lateral_m) == pytest.approx(lateral_m, abs=0.1)


def test_a_stop_and_a_leader_are_planned_for_and_nothing_is_changed_by_it(course: Course) -> None:
    seen = beside(course, 300.0, 0.0, 8.0)
    tracker = Tracker(course)
    tracker.step(seen, True, 0.0)
    assert tracker.s_m is not None
    before, remembered = tracker.along.accel_mps2, copy(tracker.along.__dict__)
    free = list(plan(tracker, 8.0))
    tracker.along.stop = Stop(tracker.s_m + 15.0, 1.5)
    stopped = list(plan(tracker, 8.0))
    tracker.along.stop = None
    tracker.along.leader = Leader(12.0, 3.0)
    behind = list(plan(tracker, 8.0))
    ways_m = [
        course.project(places[-1].x_m, places[-1].y_m, 300.0).s_m - tracker.s_m for places in (free, stopped, behind)
    ]
    assert ways_m[1] < ways_m[0]
    assert ways_m[1] < 20.0
    assert 15.0 < ways_m[2] < 12.0 + 5.0 * 3.0
    assert tracker.along.accel_mps2 == before
    assert tracker.along.leader == Leader(12.0, 3.0)
    assert {**tracker.along.__dict__, "leader": None} == remembered
