import math

import numpy as np
import pytest
from msgspec.structs import replace

from simconsole.hud.driver_view.camera import Viewport, to_pixels
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.hud.driver_view.views import Look, RoadParts, looks
from simconsole.profiles.view import DriverViewProfile, ViewScreen

SIZE = Size(3.99, 1.75, 1.45, 0.75, 2.5)
ROBOT = Size(0.138, 0.178, 0.192, 0.101, 0.160)
HERE = ShownVehicle(x_m=50.0, y_m=20.0, yaw_rad=0.6)
WINDOW = Viewport(0.0, 0.3, 1.0, 0.7)


def of(profile: DriverViewProfile, size: Size = SIZE, parts: RoadParts | None = None) -> list[Look]:
    return looks(profile, HERE, size, parts or RoadParts({None: WINDOW}, WINDOW), 1400, 1050)


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


def test_a_robot_is_seen_from_behind_and_small_enough_to_see_where_it_goes() -> None:
    (look,) = of(DriverViewProfile(), ROBOT)
    assert not look.from_seat
    left, right = (seen_at(look, 0.0, side * 0.5 * ROBOT.width_m, 0.0)[0] for side in (1.0, -1.0))
    assert 0.05 < right - left < 0.35


@pytest.mark.parametrize("camera", ["chase", "bird"])
@pytest.mark.parametrize("size", [SIZE, ROBOT, Size(1.0, 1.0, 1.0, 0.5, 1.0)], ids=["car", "robot", "ball"])
def test_other_cameras_have_the_vehicle_in_the_picture(camera: str, size: Size) -> None:
    (look,) = of(replace(DriverViewProfile(), camera=camera), size)
    half = 0.5 * size.width_m
    ends = (-size.rear_overhang_m, size.front_m)
    corners = [seen_at(look, x, y, z) for x in ends for y in (-half, half) for z in (0.0, size.height_m)]
    assert all((corner > 0.0).all() and (corner < 1.0).all() for corner in corners)
    wide = max(corner[0] for corner in corners) - min(corner[0] for corner in corners)
    assert wide > 0.02


def test_every_picture_stays_in_the_part_of_the_window_that_shows_the_road() -> None:
    for look in of(DriverViewProfile()):
        left, bottom, width, height = look.viewport.pixels(1400, 1050)
        assert left >= 0
        assert left + width <= 1400
        assert bottom >= round(0.3 * 1050)
        assert bottom + height <= 1050


def test_mirrors_are_before_the_driver_and_below_messages() -> None:
    front = Viewport(1.0 / 3.0, 0.3, 1.0 / 3.0, 0.7)
    for below in (1.0, 0.8, 0.7):
        mirrors = of(DriverViewProfile(), parts=RoadParts({None: WINDOW}, front, below))[1:]
        assert len(mirrors) == 3
        for look in mirrors:
            assert look.viewport.left > front.left
            assert look.viewport.left + look.viewport.width < front.left + front.width
            assert look.viewport.bottom > front.bottom
            assert look.viewport.bottom + look.viewport.height < front.bottom + below * front.height


def test_a_screen_stands_on_the_display_that_it_names() -> None:
    screens = (ViewScreen(yaw_deg=50.0, display=2), ViewScreen(), ViewScreen(yaw_deg=-50.0, display=1))
    left, middle, right = Viewport(0.0, 0.3, 0.3, 0.7), Viewport(0.3, 0.3, 0.4, 0.7), Viewport(0.7, 0.3, 0.3, 0.7)
    profile = DriverViewProfile(mirrors=False, screens=screens)
    seen = of(profile, parts=RoadParts({None: middle, 0: middle, 1: right, 2: left}, middle))
    assert [look.viewport for look in seen] == [left, middle, right]
    alone = of(profile, parts=RoadParts({None: WINDOW, 0: WINDOW}, WINDOW))
    assert [look.viewport for look in alone] == [WINDOW]
