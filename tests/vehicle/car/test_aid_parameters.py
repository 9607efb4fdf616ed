"""What the driver aids know of each car."""

import msgspec
import pytest

from simconsole.profiles.files.loader import load, profiles_folder
from simconsole.profiles.tyre import TirTyre, parse_tir
from simconsole.profiles.vehicle import CarProfile
from simconsole.vehicle.car.aid_parameters import slip_stiffness
from simconsole.vehicle.car.car_platform import car_parameters
from tests.vehicle.altered import HATCHBACK, altered, rolling_car


@pytest.mark.parametrize("name", ["hatchback", "light_van"])
def test_stability_control_expects_the_yaw_rate_that_the_car_settles_at(name: str) -> None:
    """Of each car, from its own tyres and steering; with another reference it would brake a steady bend."""
    profile = load("vehicles", name, CarProfile)
    drive = rolling_car(profile, 25.0)
    seen = drive.hold(1.5, clutch=1.0, road_wheel_rad=0.01)
    speed = seen.vx_mps
    k = car_parameters(profile).aids.understeer_per_square_mps
    expected = speed * 0.01 / (drive.vehicle.wheelbase_m * (1.0 + k * speed**2))
    print(f"{name}: {seen.yaw_rate_radps:.4f} rad/s, expected {expected:.4f}")
    assert seen.yaw_rate_radps == pytest.approx(expected, rel=0.08)


def test_a_named_characteristic_speed_is_taken_and_a_neutral_car_counts_as_understeering_a_little() -> None:
    named = altered(aids={"characteristic_speed_kmh": 144.0})
    assert car_parameters(named).aids.understeer_per_square_mps == pytest.approx(1.0 / 40.0**2)
    neutral = load("vehicles", "commonroad_bmw320i", CarProfile)
    assert car_parameters(neutral).aids.understeer_per_square_mps == pytest.approx((3.6 / 250.0) ** 2)


def test_a_tyre_file_says_how_stiff_its_tyre_is_along_the_road() -> None:
    assert slip_stiffness(HATCHBACK, HATCHBACK.front) == HATCHBACK.front.slip_stiffness
    path = profiles_folder() / "vehicles" / "tyres" / "example.tir"
    given = parse_tir(path.read_text(), path.name) | {"PKX1": 22.0, "LKX": 0.9}
    measured = msgspec.structs.replace(HATCHBACK, tyre=TirTyre(tir=path.name, coefficients=given))
    assert slip_stiffness(measured, measured.front) == pytest.approx(19.8)
