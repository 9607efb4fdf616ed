import numpy as np
import pytest

from simconsole.hud.driver_view.vehicle_body import Size, vehicle_meshes

CARS = {
    "hatchback": Size(3.99, 1.75, 1.45, 0.75, 2.5),
    "van": Size(5.3, 2.02, 1.98, 1.1, 3.3),
    "bmw": Size(4.5, 1.61, 1.4, 0.9, 2.58),
}
ROBOTS = {
    "burger": Size(0.138, 0.178, 0.192, 0.101, 0.160),
    "waffle": Size(0.281, 0.306, 0.141, 0.2045, 0.287),
}


@pytest.mark.parametrize("size", CARS.values(), ids=CARS)
def test_a_car_has_its_size_and_stands_on_the_ground(size: Size) -> None:
    meshes = vehicle_meshes(size)
    body = meshes.body["position"].astype(float)
    assert body[:, 0].min() == pytest.approx(-size.rear_overhang_m, abs=0.02)
    assert body[:, 0].max() == pytest.approx(size.front_m, abs=0.02)
    assert np.abs(body[:, 1]).max() == pytest.approx(0.5 * size.width_m)
    assert body[:, 2].max() == pytest.approx(size.height_m)
    assert body[:, 2].min() > 0.1
    assert meshes.wheel["position"][:, 2].min() == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("size", CARS.values(), ids=CARS)
def test_the_driver_sits_inside_behind_the_hand_wheel_and_sees_over_the_bonnet(size: Size) -> None:
    meshes, eye = vehicle_meshes(size), size.eye_m
    assert 0.0 < eye[1] < 0.5 * size.width_m
    assert eye[2] < size.height_m
    assert eye[0] < meshes.hand_wheel_place[0] < size.front_m
    bonnet = meshes.bonnet["position"].astype(float)
    paint = bonnet[bonnet[:, 0] > eye[0] + 0.9]
    assert (paint[:, 2] < eye[2]).all()


@pytest.mark.parametrize("size", ROBOTS.values(), ids=ROBOTS)
def test_a_robot_has_its_size_and_two_wheels_of_its_own_and_no_seat(size: Size) -> None:
    meshes = vehicle_meshes(size)
    body = meshes.body["position"].astype(float)
    assert body[:, 0].min() >= -size.rear_overhang_m - 1e-6
    assert body[:, 0].max() == pytest.approx(size.front_m, abs=0.01)
    assert np.abs(body[:, 1]).max() <= 0.5 * size.width_m + 1e-6
    assert body[:, 2].max() == pytest.approx(size.height_m)
    assert body[:, 2].min() > 0.0
    assert [y_m for _, y_m in meshes.wheel_places] == pytest.approx([0.5 * size.wheelbase_m, -0.5 * size.wheelbase_m])
    assert all(x_m == 0.0 for x_m, _ in meshes.wheel_places)
    assert meshes.wheel["position"][:, 2].max() == pytest.approx(2.0 * meshes.wheel_radius_m)
    assert meshes.wheel_radius_m == 0.033
    assert not size.has_seat
    assert len(meshes.bonnet) == len(meshes.hand_wheel) == len(meshes.brake_lamps) == 0


def test_the_front_of_a_robot_is_told_from_its_back() -> None:
    size = ROBOTS["burger"]
    body = vehicle_meshes(size).body
    ahead = body["position"][:, 0] > size.front_m - 0.5 * size.length_m
    colours = [{tuple(colour) for colour in body["colour"][part].tolist()} for part in (ahead, ~ahead)]
    assert colours[0] - colours[1]


def test_lamps_are_on_their_sides() -> None:
    meshes = vehicle_meshes(CARS["hatchback"])
    assert (meshes.left_indicators["position"][:, 1] > 0.0).all()
    assert (meshes.right_indicators["position"][:, 1] < 0.0).all()
    assert (meshes.brake_lamps["position"][:, 0] < 0.0).all()


def test_a_ball_is_round_and_has_neither_seat_nor_wheels() -> None:
    meshes = vehicle_meshes(Size(0.5, 0.5, 0.5, 0.25, 0.5))
    distance = np.linalg.norm(meshes.body["position"].astype(float) - (0.0, 0.0, 0.25), axis=1)
    assert distance == pytest.approx(np.full(len(distance), 0.25), abs=1e-5)
    assert meshes.wheel_places == ()
    assert len(meshes.bonnet) == 0
