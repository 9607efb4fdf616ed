"""What others see of the car."""

import math

import pytest

from simconsole.values.platform import Ground, Pose
from tests.vehicle.driving import Drive, platform


def test_the_plane_tells_height_and_both_angles() -> None:
    """A car that stands across a slope of two directions: the normal of its plane is that of the ground."""
    for slope_x, slope_y, yaw in ((0.2, 0.0, 0.0), (0.1, -0.2, 0.9), (0.0, 0.3, -2.0)):
        drive = Drive(platform(ground=Ground(1.0, slope_x, slope_y), pose=Pose(30.0, -20.0, yaw)))
        seen = drive.vehicle.initial_vehicle
        normal = math.sqrt(1.0 + slope_x**2 + slope_y**2)
        assert seen.z_m == pytest.approx((slope_x * 30.0 - slope_y * 20.0) / normal, rel=1e-12)
        assert -math.sin(seen.pitch_rad) == pytest.approx(
            (slope_x * math.cos(yaw) + slope_y * math.sin(yaw)) / normal, rel=1e-6, abs=1e-12
        )
        assert math.cos(seen.pitch_rad) * math.cos(seen.roll_rad) == pytest.approx(1.0 / normal, rel=1e-6)
        assert math.copysign(1.0, seen.roll_rad) == math.copysign(
            1.0, slope_y * math.cos(yaw) - slope_x * math.sin(yaw)
        )
