"""Steering by two points: what leads where, what a bend needs, and where the wheel goes on from."""

import math

import pytest

from simconsole.drivers.simulated_person.two_point import (
    MOST_RAD,
    NEAREST_M,
    Points,
    TwoPointSteering,
    distances_m,
    wheel_to,
)
from simconsole.profiles.person import Habits, RoadHabits

HABITS, ROAD = Habits(), RoadHabits()
TICK_S = 0.004


def on_circle(radius_m: float, along_m: float) -> tuple[float, float]:
    return radius_m * math.sin(along_m / radius_m), radius_m * (1.0 - math.cos(along_m / radius_m))


@pytest.mark.parametrize("radius_m", [12.0, 50.0, -80.0])
@pytest.mark.parametrize("along_m", [5.0, 15.0])
def test_a_circle_needs_one_angle_wherever_on_it_one_looks(radius_m: float, along_m: float) -> None:
    """Slow, it is that of Ackermann: ratio times wheelbase over radius."""
    angle = wheel_to(*on_circle(radius_m, along_m), 0.0, HABITS, ROAD)
    assert angle == pytest.approx(HABITS.steering_ratio * HABITS.wheelbase_m / radius_m)


def test_faster_the_same_bend_needs_more_wheel() -> None:
    slow, fast = (wheel_to(20.0, 1.0, speed, HABITS, ROAD) for speed in (5.0, 25.0))
    assert fast / slow > 1.5


def test_points_are_further_ahead_the_faster_one_drives() -> None:
    assert distances_m(0.0, ROAD) == (NEAREST_M, NEAREST_M)
    near, far = distances_m(25.0, ROAD)
    assert (near, far) == (ROAD.near_m, pytest.approx(25.0 * ROAD.far_s))


def test_the_wheel_goes_on_from_where_it_was() -> None:
    steering = TwoPointSteering(ROAD, TICK_S)
    steering.begin(1.2)
    assert steering.turn(Points(1.2, 1.2), 10.0, 1.2) == pytest.approx(1.2)


def test_a_bend_that_both_points_show_is_steered_at_once_and_whole() -> None:
    steering = TwoPointSteering(ROAD, TICK_S)
    steering.turn(Points(0.0, 0.0), 20.0, 0.0)
    assert steering.turn(Points(0.5, 0.5), 20.0, 0.0) == pytest.approx(0.5, abs=1e-3)


def test_what_is_missing_at_the_wheel_is_made_up_for_slowly_and_not_at_rest() -> None:
    for speed, least, most in ((20.0, 0.03, 0.15), (0.0, 0.0, 0.0)):
        steering = TwoPointSteering(ROAD, TICK_S)
        for _ in range(round(1.0 / TICK_S)):
            angle = steering.turn(Points(1.0, 1.0), speed, 0.0)
        assert least <= angle <= most


def test_nobody_winds_the_wheel_up_for_ever() -> None:
    steering = TwoPointSteering(ROAD, TICK_S)
    for _ in range(5000):
        angle = steering.turn(Points(100.0, 0.0), 20.0, 0.0)
    assert angle == MOST_RAD
