import pytest
from msgspec.structs import replace

from simconsole.profiles.parts.depth_camera import DepthCameraProfile

CAMERA = DepthCameraProfile(
    width_px=640, height_px=480, horizontal_fov_deg=90.0, min_m=0.3, max_m=3.0, x_m=0.0, z_m=0.2
)


def test_the_edge_of_a_picture_lies_at_half_the_angle_of_view() -> None:
    assert CAMERA.focal_px == pytest.approx(320.0), "at 45 degrees as far aside as ahead"
    assert replace(CAMERA, horizontal_fov_deg=60.0).focal_px == pytest.approx(320.0 * 3.0**0.5)


def test_depths_out_of_order_are_refused() -> None:
    with pytest.raises(ValueError, match=r"^min_m 3\.0 must be below max_m 3\.0$"):
        replace(CAMERA, min_m=3.0)
