"""What others see of the car."""

import math

import numpy as np
import pytest

from simconsole.values.ground import GROUND, ground_row
from simconsole.values.layout import Part, read
from simconsole.values.platform import Ground, Pose
from simconsole.values.units import STANDARD_GRAVITY_MPS2
from simconsole.vehicle.car.ground import on_base, on_plane
from simconsole.vehicle.car.outputs import RoadAndWind, pedals, road_and_wind
from simconsole.vehicle.car.state import Car
from tests.vehicle.driving import LEVEL, Drive, platform
from tests.vehicle.parts import CAR

DRY = on_base(CAR, read(ground_row(LEVEL), GROUND.plane))


def test_the_plane_tells_height_and_both_angles() -> None:
    """A car that stands across a slope of two directions: the normal of its plane is that of the ground."""
    for slope_x, slope_y, yaw in ((0.2, 0.0, 0.0), (0.1, -0.2, 0.9), (0.0, 0.3, -2.0)):
        drive = Drive(platform(ground=Ground(1.0, slope_x, slope_y), pose=Pose(30.0, -20.0, yaw)))
        seen = drive.vehicle.initial_vehicle
        normal = math.sqrt(1.0 + slope_x**2 + slope_y**2)
        assert seen.z_m == pytest.approx((slope_x * 30.0 - slope_y * 20.0) / normal, rel=1e-12)
        pitch_rad = seen.pitch_rad - drive.state.pitch_rad  # without the lean of springs that carry less on a slope
        assert -math.sin(pitch_rad) == pytest.approx(
            (slope_x * math.cos(yaw) + slope_y * math.sin(yaw)) / normal, rel=1e-6, abs=1e-12
        )
        assert math.cos(pitch_rad) * math.cos(seen.roll_rad) == pytest.approx(1.0 / normal, rel=1e-6)
        assert math.copysign(1.0, seen.roll_rad) == math.copysign(
            1.0, slope_y * math.cos(yaw) - slope_x * math.sin(yaw)
        )


def lying(yaw_rad: float, vx_mps: float = 0.0) -> Car:
    level = platform()
    car = read(np.array(level.initial_state), Part(Car))
    spin = vx_mps / CAR.front.radius_m
    wheels = {name: getattr(car, name)._replace(radps=spin) for name in ("fl", "fr", "rl", "rr")}
    return car._replace(body=car.body._replace(yaw_rad=yaw_rad, vx_mps=vx_mps), **wheels)


def test_wind_along_the_car_is_that_of_its_heading() -> None:
    ground = ground_row(Ground(1.0, 0.1, 0.0, wind_x_mps=3.0, wind_y_mps=-4.0))
    under = on_plane(lying(0.0), CAR, ground), read(ground, GROUND.plane)
    assert road_and_wind(*under, 0.0).wind_mps == pytest.approx(3.0)
    assert road_and_wind(*under, math.pi / 2.0).wind_mps == pytest.approx(-4.0)
    assert road_and_wind(*under, math.pi).slope_along == pytest.approx(-0.1)
    assert road_and_wind(*under, math.pi).up_rad == pytest.approx(-math.atan(0.1))
    assert road_and_wind(*under, math.pi / 2.0).left_up_rad == pytest.approx(-math.atan(0.1))


@pytest.mark.parametrize("automatic", [0.0, 1.0])
def test_forecasts_of_a_car_in_reverse_are_turned_round(automatic: float) -> None:
    """Along the body, positive forwards: in a forward gear throttle drives and the brake slows; in reverse not."""
    level = RoadAndWind(0.0, 0.0, 0.0, 0.0)
    for gear, way in ((1.0, 1.0), (-1.0, -1.0)):
        car = lying(0.0, way * 2.0)
        car = car._replace(box=car.box._replace(gear=gear, wanted_gear=gear))
        found = pedals(car, CAR, level, DRY, STANDARD_GRAVITY_MPS2, automatic)
        assert way * found.full_brake_mps2 < way * found.coast_mps2 < 0.0 < way * found.full_throttle_mps2


def test_forecasts_stay_on_what_the_ground_holds_and_feel_the_hill() -> None:
    car = lying(0.0)
    car = car._replace(box=car.box._replace(gear=1.0))
    up, level = (
        pedals(car, CAR, RoadAndWind(slope, 0.0, 0.0, 0.0), DRY, STANDARD_GRAVITY_MPS2, 0.0) for slope in (0.2, 0.0)
    )
    assert level.coast_mps2 == 0.0, "a standing car on the level"
    share = CAR.body.mass_kg / CAR.body.moving_kg
    for steep, flat in zip(up, level, strict=True):
        assert steep - flat == pytest.approx(-0.2 * STANDARD_GRAVITY_MPS2 * share, rel=0.05)
    held_n = 2.0 * (CAR.front.friction * CAR.front.static_n + CAR.rear.friction * CAR.rear.static_n)
    assert -level.full_brake_mps2 <= held_n / CAR.body.mass_kg
