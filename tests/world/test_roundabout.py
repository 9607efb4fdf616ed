"""The roundabout of the shipped course."""

import math

import numpy as np
import pytest

from simconsole.world.course import Course
from simconsole.world.drawing import Drawing


def area(polygon: np.ndarray) -> float:
    x, y = polygon.T
    return 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))


def test_roundabout_has_one_island_and_a_closed_outline(course: Course, drawn: Drawing) -> None:
    ring = course.world.roundabouts[0]
    assert len(drawn.islands) == 1
    assert area(drawn.islands[0]) == pytest.approx(math.pi * (18.0 - 1.75) ** 2, rel=0.01)
    assert drawn.islands[0].mean(axis=0) == pytest.approx((ring.x_m, ring.y_m), abs=0.5)
    for edge in drawn.edges:  # the roads' mouths are open
        distance = np.hypot(*(edge - (ring.x_m, ring.y_m)).T)
        assert distance.min() > 18.0 - 1.75 - 0.01
