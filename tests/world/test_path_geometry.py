import math

import pytest

from simconsole.values.platform import Pose
from simconsole.world.path_geometry import Piece, centre, travel, travel_all


def test_line_goes_straight_on() -> None:
    assert travel(Pose(1.0, 2.0, 0.0), Piece(10.0, 0.0, 0.0)) == pytest.approx((11.0, 2.0, 0.0))


@pytest.mark.parametrize("radius", [12.0, -40.0, 100.0])
def test_arc_ends_where_the_circle_says(radius: float) -> None:
    start = Pose(3.0, -1.0, 0.7)
    end = travel(start, Piece(abs(radius) * 2.0, 1.0 / radius, 1.0 / radius))
    x, y = centre(start, radius)
    assert math.hypot(end.x_m - x, end.y_m - y) == pytest.approx(abs(radius), abs=1e-12)
    assert end.yaw_rad == pytest.approx(0.7 + math.copysign(2.0, radius), abs=1e-12)


def test_clothoid_agrees_with_the_fresnel_integrals() -> None:
    # C(1) and S(1), Abramowitz and Stegun, table 7.7: heading pi/2 u^2, so curvature pi u.
    end = travel(Pose(0.0, 0.0, 0.0), Piece(1.0, 0.0, math.pi))
    assert (end.x_m, end.y_m) == pytest.approx((0.7798934003768228, 0.4382591473903548), abs=1e-13)


def test_travel_in_parts_equals_travel_at_once() -> None:
    piece = Piece(30.0, -0.04, 0.08)
    start = Pose(5.0, 5.0, 1.0)
    first = Piece(12.0, -0.04, -0.04 + 0.12 * 12.0 / 30.0)
    second = Piece(18.0, first.curvature_end_1pm, 0.08)
    assert travel_all(start, (first, second)) == pytest.approx(travel(start, piece), abs=1e-12)
    assert travel(start, piece, 12.0) == pytest.approx(travel(start, first), abs=1e-12)


def test_mirrored_piece_turns_as_much() -> None:
    piece = Piece(9.0, 0.0, 0.05)
    assert piece.mirrored.turn_rad == piece.turn_rad == pytest.approx(0.225)
    assert piece.mirrored.curvature_start_1pm == 0.05
