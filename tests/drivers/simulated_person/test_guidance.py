"""Straight on: along a line from where one began, at the plan's speed, and on from where one takes over."""

import math

import pytest

from simconsole.drivers.line_keeper import Line
from simconsole.drivers.simulated_person.guidance import Pace, StraightOn, steer_along
from simconsole.drivers.simulated_person.view import View
from simconsole.profiles.person import Habits, PersonPlan
from simconsole.values.signals import Mode
from simconsole.values.units import MPS_PER_KMH

STANDING = View(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 84.0, 1.0, 0.0, float(Mode.MANUAL))


@pytest.mark.parametrize("offset_m", [-2.0, -0.1, 0.1, 2.0])
def test_steering_leads_back_to_the_line(offset_m: float) -> None:
    line = Line(10.0, 20.0, 1.0)
    beside = STANDING._replace(
        x_m=10.0 - offset_m * math.sin(1.0), y_m=20.0 + offset_m * math.cos(1.0), yaw_rad=1.0, speed_mps=8.0
    )
    assert steer_along(line, beside, Habits()) * offset_m < 0.0
    turned = STANDING._replace(x_m=10.0, y_m=20.0, yaw_rad=1.0 + 0.1 * offset_m + math.tau, speed_mps=8.0)
    assert steer_along(line, turned, Habits()) * offset_m < 0.0


def test_on_the_line_the_wheel_is_straight() -> None:
    on_line = STANDING._replace(x_m=3.0, y_m=3.0, yaw_rad=math.pi / 4)
    assert steer_along(Line(0.0, 0.0, math.pi / 4), on_line, Habits()) == pytest.approx(0.0)


def test_the_line_is_that_of_the_first_look_until_somebody_else_has_driven() -> None:
    guidance = StraightOn(PersonPlan(cruise_kmh=36.0))
    guidance.look(STANDING)
    aside = STANDING._replace(y_m=1.0, speed_mps=10.0)
    guidance.look(aside)
    assert guidance.steer(aside) < 0.0
    guidance.begin(aside, 0.3)
    assert guidance.steer(aside) == 0.3, "the wheel is held until the console lets go"
    guidance.settle(aside)
    assert guidance.steer(aside) == pytest.approx(0.0)
    assert guidance.pace(aside) == Pace(36.0 * MPS_PER_KMH, 0.0)
    assert not guidance.arrived(aside._replace(distance_m=1e6))
