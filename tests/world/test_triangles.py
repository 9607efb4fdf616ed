import numpy as np
import pytest

from simconsole.world.triangles import Array, triangulate


def areas(polygon: Array) -> tuple[float, float]:
    """The polygon's own area, and that of all its triangles together."""
    x, y = polygon.T
    own = 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))
    a, b, c = (polygon[triangulate(polygon)[:, corner]] for corner in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    return own, float(0.5 * np.abs(ux * vy - uy * vx).sum())


SHAPES = {
    "square": [(0, 0), (2, 0), (2, 2), (0, 2)],
    "clockwise": [(0, 0), (0, 2), (2, 2), (2, 0)],
    "closed twice": [(0, 0), (2, 0), (2, 2), (0, 2), (0, 0)],
    "straight sides": [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1)],
    "L": [(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)],
    "U": [(0, 0), (5, 0), (5, 5), (4, 5), (4, 1), (1, 1), (1, 5), (0, 5)],
    "comb": [(0, 0), (9, 0), (9, 5), (8, 5), (8, 1), (6, 1), (6, 5), (5, 5), (5, 1), (3, 1), (3, 5), (2, 5), (2, 1)],
    "arrow": [(0, 0), (4, 2), (0, 4), (1, 2)],
}  # fmt: skip


@pytest.mark.parametrize("name", SHAPES)
def test_triangles_cover_the_polygon_once(name: str) -> None:
    own, covered = areas(np.array(SHAPES[name], dtype=float))
    assert covered == pytest.approx(own)


def test_random_stars_are_covered_once() -> None:
    rng = np.random.default_rng(5)
    for count in (3, 4, 7, 40, 200):
        angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
        if np.diff(angle, append=angle[0] + 2.0 * np.pi).max() > np.pi:
            angle = np.linspace(0.0, 6.0, count)
        star = np.column_stack((np.cos(angle), np.sin(angle))) * rng.uniform(0.2, 3.0, (count, 1))
        own, covered = areas(star)
        assert covered == pytest.approx(own), f"seed 5, {count}"


def test_a_ring_cut_open_is_covered_once() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 120)
    circle = np.column_stack((np.cos(angle), np.sin(angle)))
    own, covered = areas(np.vstack((18.0 * circle, 12.0 * circle[::-1])))
    assert covered == pytest.approx(own)


def test_a_degenerate_polygon_ends() -> None:
    assert triangulate(np.zeros((0, 2))).shape == (0, 3)
    assert len(triangulate(np.array(((0.0, 0.0), (1.0, 0.0))))) == 0
    bow_tie = np.array(((0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)))
    assert len(triangulate(bow_tie)) <= 2
    assert len(triangulate(np.zeros((9, 2)))) <= 1
