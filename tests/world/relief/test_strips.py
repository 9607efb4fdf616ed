"""Roads as strips: vertical curves, banks, and points an even way apart."""

import numpy as np
import pytest

from simconsole.world.relief.strips import STEP_M, banks, evenly, rounded, strip, together


def test_a_change_of_grade_becomes_a_parabola_of_the_length_asked_for() -> None:
    """From 6 % up to 4 % down over 100 m: the textbook's curve lies A L / 8 below the corner, its grade is linear."""
    s = np.arange(0.0, 601.0, STEP_M)
    height = np.where(s < 300.0, 0.06 * s, 18.0 - 0.04 * (s - 300.0))
    found = rounded(height, 100.0)
    assert found[300] == pytest.approx(18.0 - 0.10 * 100.0 / 8.0, abs=0.02)
    grade = np.gradient(found, STEP_M)
    assert grade[270:331:10] == pytest.approx(0.06 - 0.10 * (s[270:331:10] - 250.0) / 100.0, abs=0.001)
    assert found[:240] == pytest.approx(height[:240], abs=1e-9)
    assert found[360:] == pytest.approx(height[360:], abs=1e-9)


def test_no_curve_at_all_and_one_longer_than_the_road_are_possible() -> None:
    height = np.array((0.0, 1.0, 0.0, 1.0))
    assert rounded(height, 0.0) is height
    assert len(rounded(height, 500.0)) == 4


def test_a_road_banks_into_its_bend_and_not_at_its_ends() -> None:
    angle = np.arange(0.0, 300.0) * STEP_M / 200.0
    left = np.stack((200.0 * np.sin(angle), 200.0 * (1.0 - np.cos(angle)), 0.0 * angle), axis=1)
    found = banks(left, 0.06, 100.0, 40.0)
    assert found[150] == pytest.approx(-0.03, abs=1e-3), "half as tight: half the bank; the inner side, left, is low"
    assert found[0] == found[-1] == 0.0
    assert banks(left * (1.0, -1.0, 1.0), 0.06, 400.0, 40.0)[150] == pytest.approx(0.06, abs=1e-9)


def test_points_are_an_even_way_apart_and_carry_their_heights() -> None:
    line = evenly(np.array(((0.0, 0.0, 5.0), (3.0, 4.0, 6.0), (3.0, 4.0, 6.0), (3.0, 104.0, 8.0))))
    assert np.hypot(*np.diff(line[:, :2], axis=0).T) == pytest.approx(1.0, abs=0.1)
    assert np.interp(55.0, line[5:, 1], line[5:, 2]) == pytest.approx(7.02, abs=0.01)


def test_a_strip_knows_its_direction_and_grade() -> None:
    line = np.stack((np.arange(5.0), 0.0 * np.arange(5.0), 0.1 * np.arange(5.0)), axis=1)
    one = strip(line, np.zeros(5), 3.0, 1.5)
    assert one.grade == pytest.approx(0.1)
    assert (one.forward_x[2], one.forward_y[2], one.left_m[0], one.right_m[0]) == (1.0, 0.0, 3.0, 1.5)
    assert len(together((one, one)).x_m) == 10
