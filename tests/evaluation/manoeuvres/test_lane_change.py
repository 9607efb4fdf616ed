"""Double lane change, on drives whose answer is known."""

import math

import numpy as np
import pytest

from simconsole.drivers.manoeuvre_driver.lane_changer import course_of
from simconsole.evaluation.manoeuvres.lane_change import least_room_m
from tests.evaluation.manoeuvres.driven import CAR, HZ, drive


@pytest.mark.parametrize(("aside_m", "room_m"), [(0.0, 0.2145), (0.1, 0.1145), (0.4, -0.1855)])
def test_room_is_that_of_the_nearest_corner(aside_m: float, room_m: float) -> None:
    course = course_of("iso_3888_2", 1.79)._replace(lanes=course_of("iso_3888_2", 1.79).lanes[:1])
    x = np.linspace(-10.0, 20.0, HZ)
    straight = drive(1.0, vehicle__x_m=x, vehicle__y_m=np.array(aside_m), vehicle__yaw_rad=np.array(0.0))
    assert least_room_m(straight, course, CAR) == pytest.approx(room_m)
    short = drive(1.0, vehicle__x_m=x - 20.0, vehicle__y_m=np.array(0.0), vehicle__yaw_rad=np.array(0.0))
    assert least_room_m(short, course, CAR) == -math.inf, "it never got through"
