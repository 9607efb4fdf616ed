"""What the autopilot answers, and what it says to people."""

import pytest

from simconsole.drivers.autopilot.answers import Answers, make_tracker
from simconsole.drivers.path_tracker.geometric import GeometricTracker
from simconsole.drivers.path_tracker.signal_stops import Light, SignalStops
from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.drivers.path_tracker.tracker import Tracker
from simconsole.drivers.path_tracker.tracker_settings import HATCHBACK, TRACKERS
from simconsole.profiles.course_plan import CoursePlan, Straight
from simconsole.values.signals import SignalState
from simconsole.world.course import Course
from simconsole.world.planning import solve
from simconsole.world.rules.approaches import StopLine


def straight() -> Course:
    plan = CoursePlan(schema=1, title="t", lane_width_m=3.5, speed_limit_kmh=50.0, elements=(Straight(length_m=100.0),))
    return Course(solve(plan, "t"))


def answers(said: list[str], name: str = "preview") -> Answers:
    return Answers(make_tracker(name, straight(), HATCHBACK, 0.04), said.append)


def at(x_m: float, y_m: float, speed_mps: float = 0.0) -> VehicleMotion:
    return VehicleMotion(x_m, y_m, 0.0, speed_mps, 0.0, 0.0)


def test_each_name_is_a_tracker() -> None:
    kinds = [type(make_tracker(name, straight(), HATCHBACK, 0.04)) for name in TRACKERS]
    assert kinds == [Tracker, GeometricTracker, GeometricTracker]


@pytest.mark.parametrize("name", TRACKERS)
def test_no_commands_too_far_away_and_it_says_so_once_each_way(name: str) -> None:
    said: list[str] = []
    asked = answers(said, name)
    given = [asked.answer(at(5.0, y_m), False, 0.02 * step) for step, y_m in enumerate((2.0, 2.0, 0.5, 0.5))]
    assert [command is None for command in given] == [True, True, False, False]
    assert said == [
        "gives no commands: the way back leads 2.0 m from the course, at most 1.3 m",
        "gives commands again",
    ]
    found = asked.statistics
    assert (found.withheld, found.commands) == (2, 2)


def test_a_car_on_its_way_back_is_driven_on_until_it_is_somewhere_else() -> None:
    said: list[str] = []
    asked = answers(said)
    assert asked.answer(at(5.0, 1.2, 3.0), False, 0.0) is not None
    assert asked.answer(at(5.06, 1.4, 3.0), True, 0.02) is not None
    assert said == []
    assert asked.answer(at(5.12, 3.1, 3.0), True, 0.04) is None
    assert said == ["gives no commands: the car is 3.1 m beside the course, at most 3 m"]


@pytest.mark.parametrize("name", TRACKERS)
def test_an_overtaken_odometry_is_not_answered(name: str) -> None:
    asked, plain = answers([], name), answers([], name)
    for step in range(1, 50):
        seen = at(5.0 + 0.1 * step, 0.2, 5.0), True, 0.02 * step
        if step % 5 == 0:
            assert asked.answer(at(5.0 + 0.1 * (step - 3), 0.5, 5.0), True, 0.02 * (step - 3) + 0.001) is None
        assert asked.answer(*seen) == plain.answer(*seen)
    assert (asked.statistics.skipped, asked.statistics.commands) == (9, 49)


@pytest.mark.parametrize("name", TRACKERS)
def test_where_time_begins_anew_so_does_the_tracker(name: str) -> None:
    asked, fresh = answers([], name), answers([], name)
    for step in range(100):
        asked.answer(at(60.0 + 0.1 * step, 0.2, 5.0), True, 100.0 + 0.02 * step)
    for step in range(50):
        seen = at(2.0 + 0.1 * step, 0.3, 5.0), step > 10, 0.02 * step
        again, first = asked.answer(*seen), fresh.answer(*seen)
        assert again is not None
        assert first is not None
        assert (again.road_wheel_rad, again.accel_mps2) == (first.road_wheel_rad, first.accel_mps2)


def test_the_end_is_told_once_and_only_where_the_autopilot_has_stopped_there() -> None:
    said: list[str] = []
    asked = answers(said)
    asked.answer(at(99.9, 0.0), False, 0.0)
    asked.answer(at(99.9, 0.0, 1.0), True, 0.02)
    assert not asked.statistics.at_end
    for step in (2, 3):
        command = asked.answer(at(99.9, 0.0), True, 0.02 * step)
        assert command is not None
    assert asked.statistics.at_end
    assert said == ["stands at the end of the course"]


def test_lights_are_obeyed_before_anything_is_asked_for() -> None:
    lights = SignalStops([StopLine(60.0, 0, 0)], ["light"], 3.4)
    said: list[str] = []
    asked = Answers(make_tracker("preview", straight(), HATCHBACK, 0.04), said.append, lights)
    asked.see({("light", 0): Light(SignalState.STOP_AND_REMAIN, SignalState.STOP_AND_REMAIN, -1.0, 0.0)})
    asked.answer(at(40.0, 0.0, 8.0), True, 0.0)
    command = asked.answer(at(40.16, 0.0, 8.0), True, 0.02)
    assert command is not None
    assert command.jerk_mps3 < 0.0
    assert command.speed_mps < 8.0
