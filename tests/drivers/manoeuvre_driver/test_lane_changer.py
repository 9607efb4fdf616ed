"""The courses of cones and the way through them."""

import numpy as np
import pytest

from simconsole.drivers.manoeuvre_driver.lane_changer import course_of, path_at
from tests.evaluation.manoeuvres.driven import CAR


def test_the_courses_have_their_lengths_and_widths() -> None:
    long, short = course_of("iso_3888_1", 1.8), course_of("iso_3888_2", 1.8)
    assert long.lanes[-1].to_m == 125.0
    assert short.lanes[-1].to_m == 61.0
    assert [lane.width_m for lane in short.lanes] == pytest.approx([2.23, 2.8, 3.0])
    first, second = short.lanes[:2]
    assert second.middle_m - 0.5 * second.width_m - (first.middle_m + 0.5 * first.width_m) == pytest.approx(1.0)


@pytest.mark.parametrize("name", ["iso_3888_1", "iso_3888_2"])
def test_the_path_has_the_slope_and_curvature_that_it_says(name: str) -> None:
    course = course_of(name, CAR.width_m)
    for s_m in np.arange(-10.0, 130.0, 0.7):
        before, (side, slope, curvature), after = (path_at(course, s_m + step) for step in (-1e-4, 0.0, 1e-4))
        assert (after[0] - before[0]) / 2e-4 == pytest.approx(slope, abs=1e-5)
        assert (after[1] - before[1]) / 2e-4 == pytest.approx(curvature, abs=1e-3)
        for lane in course.lanes:
            if lane.from_m + 2.0 < s_m < lane.to_m - 2.0:
                assert abs(side - lane.middle_m) < 0.5 * lane.width_m
