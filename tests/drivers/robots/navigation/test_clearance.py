import math

import numpy as np
import pytest

from simconsole.drivers.robots.navigation.clearance import Arc, room_along
from simconsole.values.host.jit import compiled, plain

BODY_X_M = -0.032


def test_room_is_that_of_the_body_along_the_arc() -> None:
    points = np.array([(1.0, 0.1), (0.0, 2.0)])
    room = compiled(room_along)(points, BODY_X_M, Arc(0.2, 0.0, 2.0))
    assert room.first_m == pytest.approx(math.hypot(1.032, 0.1))
    assert room.last_m == room.least_m == pytest.approx(math.hypot(0.632, 0.1))


def test_a_turn_on_the_spot_swings_the_body() -> None:
    points = np.array([(0.0, 0.2)])
    room = compiled(room_along)(points, BODY_X_M, Arc(0.0, -math.pi, 1.0))
    assert room.least_m == pytest.approx(0.2 - 0.032, abs=1e-3), "halfway round it is nearest"
    assert room.last_m == pytest.approx(math.hypot(0.032, 0.2))


def test_a_bend_goes_round_its_middle() -> None:
    room = plain(room_along)(np.array([(0.0, 0.5)]), 0.0, Arc(0.2, 0.4, 3.0))
    assert (room.first_m, room.least_m, room.last_m) == pytest.approx((0.5, 0.5, 0.5))


def test_both_executions_agree_and_without_points_there_is_room() -> None:
    points = np.random.default_rng(1).uniform(-2.0, 2.0, (50, 2))
    arc = Arc(0.15, 0.7, 1.2)
    assert plain(room_along)(points, BODY_X_M, arc) == compiled(room_along)(points, BODY_X_M, arc)
    assert compiled(room_along)(np.empty((0, 2)), BODY_X_M, arc).least_m > 1e5
