import math

import numpy as np
import pytest
from msgspec.structs import replace

from simconsole.hud.driver_view.camera import Viewport, to_pixels
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.hud.driver_view.views import Look, looks
from simconsole.profiles.view import DriverViewProfile, ViewScreen

SIZE = Size(3.99, 1.75, 1.45, 0.75, 2.5)
HERE = ShownVehicle(x_m=50.0, y_m=20.0, yaw_rad=0.6)
WINDOW = Viewport(0.0, 0.3, 1.0, 0.7)


def of(profile: DriverViewProfile, size: Size = SIZE) -> list[Look]:
    return looks(profile, HERE, size, WINDOW, 1400, 1050)


def seen_at(look: Look, ahead_m: float, left_m: float, up_m: float) -> np.ndarray:
    """Where a point beside the car lands in the look's own picture, in shares of it from its upper left corner."""
    cosine, sine = math.cos(HERE.yaw_rad), math.sin(HERE.yaw_rad)
    point = (HERE.x_m + ahead_m * cosine - left_m * sine, HERE.y_m + ahead_m * sine + left_m * cosine, up_m)
    return np.asarray(to_pixels(np.array([point]), look.camera, look.lens, 1, 1)[0])


def test_the_driver_looks_ahead_and_into_three_mirrors() -> None:
    front, left, inner, right = of(DriverViewProfile())
    assert front.from_seat
    assert seen_at(front, 60.0, 0.0, 1.2)[0] == pytest.approx(0.5, abs=0.02)
    assert [look.is_mirror for look in (left, inner, right)] == [True] * 3
    for look, side_m in ((left, 3.5), (right, -3.5)):
        x, y = seen_at(look, -15.0, side_m, 0.8)
        assert 0.0 < x < 1.0
        assert 0.0 < y < 1.0
        assert np.isnan(seen_at(look, 30.0, side_m, 0.8)).all()


def test_in_a_mirror_what_is_left_stays_left() -> None:
    inner = of(DriverViewProfile())[2]
    left, right = seen_at(inner, -30.0, 3.0, 1.0), seen_at(inner, -30.0, -3.0, 1.0)
    assert left[0] < right[0]


def test_screens_side_by_side_show_one_scene_without_a_step() -> None:
    third = 1.0 / 3.0
    screens = tuple(
        ViewScreen(yaw_deg=yaw, horizontal_fov_deg=40.0, left=index * third, width=third)
        for index, yaw in enumerate((40.0, 0.0, -40.0))
    )
    left, middle, _ = of(DriverViewProfile(mirrors=False, screens=screens))
    eye = SIZE.eye_m
    border = (eye[0] + 50.0 * math.cos(math.radians(20.0)), eye[1] + 50.0 * math.sin(math.radians(20.0)), eye[2])
    assert seen_at(left, *border)[0] == pytest.approx(1.0, abs=1e-6)
    assert seen_at(middle, *border)[0] == pytest.approx(0.0, abs=1e-6)
    assert seen_at(left, *border)[1] == pytest.approx(seen_at(middle, *border)[1], abs=1e-6)


def test_a_ball_is_seen_from_behind() -> None:
    ball = Size(0.5, 0.5, 0.5, 0.25, 0.5)
    (look,) = of(DriverViewProfile(), ball)
    assert not look.from_seat
    assert (seen_at(look, 0.0, 0.0, 0.25) > 0.0).all()
    assert (seen_at(look, 0.0, 0.0, 0.25) < 1.0).all()


@pytest.mark.parametrize("camera", ["chase", "bird"])
def test_other_cameras_have_the_vehicle_in_the_picture(camera: str) -> None:
    (look,) = of(replace(DriverViewProfile(), camera=camera))
    corners = [seen_at(look, x, y, z) for x in (-0.7, 3.2) for y in (-0.8, 0.8) for z in (0.0, 1.4)]
    assert all((corner > 0.0).all() and (corner < 1.0).all() for corner in corners)


def test_every_picture_stays_in_the_part_of_the_window_that_shows_the_road() -> None:
    for look in of(DriverViewProfile()):
        left, bottom, width, height = look.viewport.pixels(1400, 1050)
        assert left >= 0
        assert left + width <= 1400
        assert bottom >= round(0.3 * 1050)
        assert bottom + height <= 1050
