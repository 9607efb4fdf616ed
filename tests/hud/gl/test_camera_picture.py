"""A camera's pictures are JPEG, show no instruments and no bonnet, and are those of a pinhole with its focal length."""

import io
import math

import numpy as np
import pygame
import pytest

from simconsole.hud.driver_view.mesh import Box, Material, box, joined
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.scene import pieces, view_scene
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.hud.gl.camera_picture import CameraPicture
from simconsole.profiles.bridge import CameraProfile
from tests.hud.gl.pictures import context

RED = (255, 0, 0)
EMPTY = view_scene(None, (), Size(3.99, 1.75, 1.45, 0.75, 2.5))
SHOWN = ShownVehicle(x_m=120.0, y_m=-40.0, yaw_rad=0.7)


def decoded(jpeg: bytes) -> np.ndarray:
    """Return a JPEG as [height, width, 3], rows from the top."""
    surface = pygame.image.load(io.BytesIO(jpeg), "camera.jpg")
    return np.frombuffer(pygame.image.tobytes(surface, "RGB"), np.uint8).reshape(surface.get_height(), -1, 3)


@pytest.mark.parametrize(
    "profile",
    [
        CameraProfile(),
        CameraProfile(width_px=800, height_px=300, horizontal_fov_deg=40.0, z_m=2.0, y_m=0.6),
        CameraProfile(yaw_deg=90.0, pitch_deg=8.0, horizontal_fov_deg=100.0),
    ],
)
def test_a_point_of_the_world_lands_within_a_pixel_of_where_the_pinhole_has_it(profile: CameraProfile) -> None:
    """The projection is written out here: rotations of the vehicle and the camera, then focal length over depth."""
    generator = np.random.Generator(np.random.PCG64(4))
    for _ in range(6):
        depth = generator.uniform(6.0, 30.0)
        half_width = math.tan(0.5 * math.radians(profile.horizontal_fov_deg))
        right, down = (
            depth * half_width * generator.uniform(-0.6, 0.6),
            depth * half_width * generator.uniform(-0.2, 0.2),
        )
        yaw, pitch = math.radians(profile.yaw_deg), math.radians(profile.pitch_deg)
        # Camera's axes in the vehicle's: forwards (cos, sin, 0) tilted down by the pitch.
        forwards = np.array((math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), -math.sin(pitch)))
        to_right = np.array((math.sin(yaw), -math.cos(yaw), 0.0))
        downwards = np.cross(forwards, to_right)
        local = np.array((profile.x_m, profile.y_m, profile.z_m)) + depth * forwards + right * to_right
        local += down * downwards
        turn = SHOWN.yaw_rad
        east = SHOWN.x_m + math.cos(turn) * local[0] - math.sin(turn) * local[1]
        north = SHOWN.y_m + math.sin(turn) * local[0] + math.cos(turn) * local[1]
        half = 0.012 * depth * half_width
        cube = box(Box(east, north, local[2] - half, half, half, 2.0 * half), RED, RED, Material.GLOWING)
        scene = EMPTY._replace(layers=(), solids=pieces(joined([cube])))
        picture = decoded(CameraPicture(context(), scene, profile).jpeg(SHOWN)).astype(int)
        assert picture.shape == (profile.height_px, profile.width_px, 3)
        rows, columns = np.nonzero((picture[..., 0] > 150) & (picture[..., 1] < 90) & (picture[..., 2] < 90))
        assert len(rows) > 4
        wanted = (
            profile.focal_px * right / depth + 0.5 * profile.width_px - 0.5,
            profile.focal_px * down / depth + 0.5 * profile.height_px - 0.5,
        )
        assert (columns.mean(), rows.mean()) == pytest.approx(wanted, abs=1.0)


def test_the_camera_does_not_see_the_vehicle_that_carries_it() -> None:
    profile = CameraProfile(pitch_deg=30.0)
    scene = EMPTY._replace(layers=())
    there = CameraPicture(context(), scene, profile).jpeg(SHOWN)
    nothing = scene.vehicle._replace(bonnet=scene.vehicle.bonnet[:0], hand_wheel=scene.vehicle.hand_wheel[:0])
    assert CameraPicture(context(), scene._replace(vehicle=nothing), profile).jpeg(SHOWN) == there


def test_night_is_darker() -> None:
    day, night = (
        decoded(CameraPicture(context(), EMPTY, CameraProfile(night=night)).jpeg(SHOWN)) for night in (False, True)
    )
    assert night[:100].mean() < 0.3 * day[:100].mean()
