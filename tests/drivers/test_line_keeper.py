import math
import random

import pytest

from simconsole.drivers.line_keeper import X_AXIS, Line, pure_pursuit, state_feedback


def test_deviation_is_left_positive_and_wraps() -> None:
    line = Line(1.0, 2.0, math.pi / 2.0)
    assert line.deviation(0.0, 5.0, math.pi / 2.0) == pytest.approx((1.0, 0.0))
    assert line.deviation(1.0, 5.0, -math.pi + 0.1).heading_rad == pytest.approx(math.pi / 2.0 + 0.1)


def test_on_the_x_axis_the_deviation_is_the_pose_itself() -> None:
    dice = random.Random(20261122)
    for _ in range(1000):
        x, y, yaw = dice.uniform(-9e3, 9e3), dice.uniform(-9.0, 9.0), dice.uniform(-math.pi, math.pi)
        assert X_AXIS.deviation(x, y, yaw) == (y, yaw)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_both_laws_lead_back(side: float) -> None:
    beside, turned = X_AXIS.deviation(5.0, side, 0.0), X_AXIS.deviation(5.0, 0.0, 0.2 * side)
    for deviation in (beside, turned):
        assert side * pure_pursuit(deviation, 8.0, 2.6) < 0.0
        assert side * state_feedback(deviation, 0.0) < 0.0
    assert side * state_feedback(X_AXIS.deviation(0.0, 0.0, 0.0), side) < 0.0
    assert abs(state_feedback(X_AXIS.deviation(0.0, 99.0 * side, 0.0), 0.0)) == 0.5
