import math

import numpy as np
import pytest

from simconsole.hud.driver_view.camera import Camera, Lens, Viewport, rotation, to_pixels

WIDTH_PX, HEIGHT_PX = 800, 500


def pinhole(point: tuple[float, float, float], eye: tuple[float, float, float], fov_rad: float) -> tuple[float, float]:
    """The pixel of a point ahead of a camera that looks along +x, by similar triangles."""
    ahead, left, up = (p - e for p, e in zip(point, eye, strict=True))
    focal_px = 0.5 * WIDTH_PX / math.tan(0.5 * fov_rad)
    return 0.5 * WIDTH_PX - focal_px * left / ahead, 0.5 * HEIGHT_PX - focal_px * up / ahead


@pytest.mark.parametrize("point", [(20.0, 0.0, 1.0), (8.0, 3.0, 0.0), (55.0, -20.0, 7.0), (1.0, 0.2, 1.1)])
def test_a_point_lands_where_similar_triangles_say(point: tuple[float, float, float]) -> None:
    eye, fov = (0.5, 0.3, 1.2), math.radians(62.0)
    camera, lens = Camera(np.array(eye), rotation(0.0)), Lens(fov, WIDTH_PX / HEIGHT_PX)
    found = to_pixels(np.array([point]), camera, lens, WIDTH_PX, HEIGHT_PX)[0]
    assert found == pytest.approx(pinhole(point, eye, fov), abs=1e-6)


def test_what_is_left_is_left_and_what_is_up_is_up() -> None:
    camera, lens = Camera(np.zeros(3), rotation(0.7)), Lens(1.0, 1.6)
    ahead = rotation(0.7) @ np.array(((10.0, 10.0, 10.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    middle, left, up = to_pixels(ahead.T, camera, lens, WIDTH_PX, HEIGHT_PX)
    assert middle == pytest.approx((400.0, 250.0))
    assert left[0] < middle[0]
    assert left[1] == pytest.approx(middle[1])
    assert up[1] < middle[1]


def test_a_mirror_changes_sides_and_nothing_else() -> None:
    points = np.array(((12.0, 2.0, 0.5), (30.0, -4.0, 2.0)))
    camera = Camera(np.zeros(3), rotation(0.0))
    straight = to_pixels(points, camera, Lens(0.6, 1.6), WIDTH_PX, HEIGHT_PX)
    mirrored = to_pixels(points, camera, Lens(0.6, 1.6, is_mirror=True), WIDTH_PX, HEIGHT_PX)
    assert mirrored[:, 0] == pytest.approx(WIDTH_PX - straight[:, 0])
    assert mirrored[:, 1] == pytest.approx(straight[:, 1])


def test_the_horizon_stands_where_the_lens_says_and_uprights_stay_upright() -> None:
    camera, lens = Camera(np.array((0.0, 0.0, 1.2)), rotation(0.0)), Lens(1.0, 1.6, horizon=0.7)
    far, low, high = to_pixels(
        np.array(((1e6, 0.0, 1.2), (9.0, 3.0, 0.0), (9.0, 3.0, 4.0))), camera, lens, WIDTH_PX, HEIGHT_PX
    )
    assert far[1] == pytest.approx(0.3 * HEIGHT_PX, abs=0.01)
    assert low[0] == pytest.approx(high[0])


def test_pitch_is_nose_down_and_roll_is_right_side_down() -> None:
    forward = rotation(0.0, 0.1) @ np.array((1.0, 0.0, 0.0))
    left = rotation(0.0, 0.0, 0.1) @ np.array((0.0, 1.0, 0.0))
    assert forward[2] == pytest.approx(-math.sin(0.1))
    assert left[2] == pytest.approx(math.sin(0.1))
    turned = rotation(0.4, -0.2, 0.3)
    assert turned @ turned.T == pytest.approx(np.eye(3))
    assert np.linalg.det(turned) == pytest.approx(1.0)


def test_what_is_behind_lands_nowhere() -> None:
    camera = Camera(np.zeros(3), rotation(0.0))
    assert np.isnan(to_pixels(np.array([(-5.0, 0.0, 0.0)]), camera, Lens(1.0, 1.0), 10, 10)).all()


def test_viewports_side_by_side_meet_without_a_gap() -> None:
    for width in (1400, 1401, 1366, 77):
        edges = [Viewport(i / 3.0, 0.0, 1.0 / 3.0, 1.0).pixels(width, 40) for i in range(3)]
        assert edges[0][0] == 0
        assert [left + wide for left, _, wide, _ in edges] == [edges[1][0], edges[2][0], width]
