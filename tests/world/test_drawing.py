import math

import numpy as np

from simconsole.world.course import Course
from simconsole.world.drawing import Drawing


def test_everything_is_finite_pairs(drawn: Drawing) -> None:
    assert np.isfinite([light[:3] for light in drawn.lights]).all()
    lines_of = {**drawn._asdict(), "path": (drawn.path,)}
    for name in ("lights", "ground", "walls"):  # there is neither a hill nor a wall
        del lines_of[name]
    assert drawn.ground is None
    assert drawn.walls == ()
    for name, lines in lines_of.items():
        assert lines, f"the urban course has {name}"
        for line in lines:
            assert line.ndim == 2
            assert line.shape[1] == 2
            assert len(line) >= 2
            assert np.isfinite(line).all()


def test_no_edge_lies_on_the_driven_lane(course: Course, drawn: Drawing) -> None:
    path = drawn.path
    for edge in drawn.edges:
        gaps = np.hypot(*(edge[:, None, :] - path[None, :, :]).transpose(2, 0, 1)).min(axis=1)
        assert gaps.min() > 0.5 * course.world.lane_width_m - 0.1


def test_driven_lane_is_paved_all_along(course: Course, drawn: Drawing) -> None:
    boxes = [(p, p.min(axis=0), p.max(axis=0)) for p in drawn.surfaces]
    for s in np.arange(0.37, course.length_m, 4.9).tolist():
        point = np.array(course.at(s)[:2])
        near = [p for p, low, high in boxes if (low <= point + 0.01).all() and (point - 0.01 <= high).all()]
        assert any(inside(p, point) for p in near), point


def inside(polygon: np.ndarray, point: np.ndarray) -> bool:
    # The winding angle of the polygon about the point.
    d = polygon - point
    angles = np.arctan2(d[:, 1], d[:, 0])
    turns = np.diff(np.append(angles, angles[0]))
    total = float(((turns + math.pi) % math.tau - math.pi).sum())
    return abs(total) > 3.0
