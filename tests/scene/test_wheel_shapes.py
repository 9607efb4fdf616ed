import numpy as np
import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.scene.wheel_shapes import CORNERS, WHEEL_COLUMNS, WheelShapes, wheel_shapes
from simconsole.session.scene_worker import shown_wheels
from simconsole.vehicle.car.car_platform import car_parameters
from tests.vehicle.driving import Drive
from tests.vehicle.rolling import rolling

HATCHBACK = load("vehicles", "hatchback", CarProfile)
MASS_KG = car_parameters(HATCHBACK).body.mass_kg


def shapes(drive: Drive) -> WheelShapes:
    state = drive.state._asdict()
    table = {"vehicle.road_wheel_rad": np.array([drive.seen.road_wheel_rad])}
    table |= {name: np.array([state[name.removeprefix("platform.")]]) for name in WHEEL_COLUMNS[1:]}
    return wheel_shapes(table, shown_wheels(HATCHBACK))


def total_n(found: WheelShapes) -> np.ndarray:
    summed: np.ndarray = found.forces_n[0].sum(axis=0)
    return summed


def test_wheels_stand_on_the_ground_where_the_car_has_them() -> None:
    found = shapes(rolling(0.0))
    assert found.centres.shape == (1, len(CORNERS), 3)
    assert np.sign(found.centres[0, :, 1]).tolist() == [1.0, -1.0, 1.0, -1.0]
    assert found.centres[0, :, 0] == pytest.approx([HATCHBACK.body.wheelbase_m] * 2 + [0.0] * 2)
    assert found.centres[0, :, 2] == pytest.approx([HATCHBACK.front.wheel_radius_m] * 4, abs=0.02)
    assert (found.patches[0, :, 2] < 0.1).all()


def test_in_a_bend_the_tyres_pull_inwards_as_much_as_the_car_turns() -> None:
    drive = rolling(15.0)
    seen = drive.hold(3.0, road_wheel_rad=0.04, automatic=1.0, throttle=0.12)
    along, left, _ = total_n(shapes(drive))
    assert left == pytest.approx(MASS_KG * seen.ay_mps2, rel=0.05)
    assert left > 3000.0
    assert abs(along) < 0.3 * left


def test_braking_pulls_back_on_all_four() -> None:
    drive = rolling(20.0)
    seen = drive.hold(0.6, brake=0.4, automatic=1.0)
    found = shapes(drive)
    assert (found.forces_n[0, :, 0] < -300.0).all()
    assert total_n(found)[0] == pytest.approx(MASS_KG * seen.ax_mps2, rel=0.1)


def test_a_steered_wheels_axle_turns_with_it() -> None:
    drive = rolling(5.0)
    drive.hold(1.0, road_wheel_rad=0.3, automatic=1.0)
    x, y, z, w = shapes(drive).quaternions[0, 0]
    axle = np.array((2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)))
    angle = drive.seen.road_wheel_rad
    assert np.abs(axle) == pytest.approx(np.abs((np.sin(angle), np.cos(angle), 0.0)), abs=1e-9)
    assert np.linalg.norm((x, y, z, w)) == pytest.approx(1.0)
