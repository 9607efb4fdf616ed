"""Frames of the road, and what is drawn in them."""

import numpy as np
import pytest

from simconsole.world.course import Course
from simconsole.world.drawing import Drawing


def test_zebras_lie_across_the_road(course: Course, drawn: Drawing) -> None:
    assert len(drawn.zebras) == 7 * (len(course.world.crossings) + 4)  # each arm of the signalled intersection too
    for crossing in course.world.crossings:
        point = course.at(crossing.s_m)
        near = [z for z in drawn.zebras if np.hypot(*(z.mean(axis=0) - point[:2])) < 6.0]
        assert len(near) == 7
        middles = [z.mean(axis=0) for z in near]
        laterals = sorted(course.project(float(x), float(y), crossing.s_m).lateral_m for x, y in middles)
        assert laterals == pytest.approx([-1.25, -0.25, 0.75, 1.75, 2.75, 3.75, 4.75], abs=1e-6)
