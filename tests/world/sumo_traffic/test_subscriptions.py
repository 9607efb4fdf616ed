"""SUMO's values as road users."""

import math

import pytest

from simconsole.world.sumo_traffic.subscriptions import Numbers, road_users
from simconsole.world.traffic.road_users import CAPACITY, RoadUserKind, users

Values = dict[int, object]


def vehicle(x_m: float, length_m: float = 4.6, kind: str = "passenger", signals: int = 0) -> Values:
    return {
        0x39: (x_m, 2.0, 0.5), 0x40: 7.0, 0x43: 90.0, 0x44: length_m, 0x4D: 1.8, 0xBC: 1.5, 0x49: kind, 0x5B: signals
    }  # fmt: skip


def test_vehicle_is_a_box_by_its_middle_and_a_person_stands_where_it_is() -> None:
    person: Values = {0x39: (5.0, 1.0, 0.0), 0x40: 1.3, 0x43: 0.0}
    table = road_users({"a": vehicle(10.0)}, {"a": person}, Numbers(), (1.0, 1.0), (0.0, 0.0))
    car, walker = users(table)
    assert (car.x_m, car.y_m, car.yaw_rad, car.z_m) == pytest.approx((10.0 - 2.3 - 1.0, 1.0, 0.0, 0.5))
    assert (walker.x_m, walker.y_m, walker.yaw_rad) == pytest.approx((4.0, 0.0, 0.5 * math.pi))
    assert (car.kind, walker.kind) == (RoadUserKind.CAR, RoadUserKind.PEDESTRIAN)
    assert car.id != walker.id


def test_kinds_and_indicators() -> None:
    some = {
        "bike": vehicle(0.0, 1.6, "bicycle"),
        "left": vehicle(20.0, signals=0b10),
        "right": vehicle(40.0, signals=0b1),
        "truck": vehicle(60.0, 7.1, "truck", 0b11),
    }
    bike, left, right, truck = users(road_users(some, {}, Numbers(), (0.0, 0.0), (0.0, 0.0)))
    assert bike.kind == RoadUserKind.PEDESTRIAN
    assert truck.kind == RoadUserKind.VAN
    assert (left.turn_indicators, right.turn_indicators, truck.turn_indicators) == (1.0, -1.0, 0.0)


def test_of_too_many_the_nearest_stay_and_keep_their_numbers() -> None:
    some = {f"v{number:04d}": vehicle(10.0 * number) for number in range(CAPACITY + 40)}
    numbers = Numbers()
    first = road_users(some, {}, numbers, (0.0, 0.0), (0.0, 0.0))
    assert len(first) == CAPACITY
    assert first[:, 2].max() < 10.0 * CAPACITY
    last = road_users(some, {}, numbers, (0.0, 0.0), (10.0 * (CAPACITY + 40), 0.0))
    assert last[:, 2].min() > 300.0
    by_number = {user.id: user.x_m for user in users(first)}
    assert all(by_number[user.id] == user.x_m for user in users(last) if user.id in by_number)
    assert numbers.name(first[0, 0]) == (False, "v0000")


def test_who_has_not_set_out_is_nowhere() -> None:
    assert len(road_users({}, {"p": {0x40: 0.0}}, Numbers(), (0.0, 0.0), (0.0, 0.0))) == 0
