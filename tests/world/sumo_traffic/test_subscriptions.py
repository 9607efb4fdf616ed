"""SUMO's values as road users."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from simconsole.world.roads.road_map import Array
from simconsole.world.sumo_traffic.subscriptions import Numbers, VehicleReader, people_rows, road_users
from simconsole.world.traffic.road_users import CAPACITY, RoadUserKind, users

Values = dict[int, object]
NOBODY: Array = people_rows({}, Numbers())
TYPES = {
    "car": (4.6, "passenger", 1.8, 1.5),
    "bike": (1.6, "bicycle", 0.6, 1.7),
    "truck": (7.1, "truck", 2.4, 2.4),
}
"""Length, class, width and height."""


class Types:
    """SUMO's domain of types, that counts what it is asked."""

    def __init__(self) -> None:
        self.asked: list[str] = []

    def __getattr__(self, question: str) -> Any:
        place = ("getLength", "getVehicleClass", "getWidth", "getHeight").index(question)

        def answer(name: str) -> object:
            self.asked.append(question)
            return TYPES[name][place]

        return answer


def reader(numbers: Numbers | None = None) -> VehicleReader:
    return VehicleReader(SimpleNamespace(vehicletype=Types()), numbers or Numbers())


def vehicle(x_m: float, kind: str = "car", signals: int = 0) -> Values:
    return {0x39: (x_m, 2.0, 0.5), 0x40: 7.0, 0x43: 90.0, 0x4F: kind, 0x5B: signals}


def test_vehicle_is_a_box_by_its_middle_and_a_person_stands_where_it_is() -> None:
    numbers = Numbers()
    person: Values = {0x39: (5.0, 1.0, 0.0), 0x40: 1.3, 0x43: 0.0}
    rows = reader(numbers).rows({"a": vehicle(10.0)})
    car, walker = users(road_users(rows, people_rows({"a": person}, numbers), (1.0, 1.0), (0.0, 0.0)))
    assert (car.x_m, car.y_m, car.yaw_rad, car.z_m) == pytest.approx((10.0 - 2.3 - 1.0, 1.0, 0.0, 0.5))
    assert (car.speed_mps, car.length_m, car.width_m, car.height_m) == (7.0, 4.6, 1.8, 1.5)
    assert (walker.x_m, walker.y_m, walker.yaw_rad) == pytest.approx((4.0, 0.0, 0.5 * math.pi))
    assert (walker.speed_mps, walker.length_m, walker.width_m, walker.height_m) == (1.3, 0.5, 0.5, 1.75)
    assert (car.kind, walker.kind) == (RoadUserKind.CAR, RoadUserKind.PEDESTRIAN)
    assert car.id != walker.id


def test_kinds_and_indicators() -> None:
    some = {
        "bike": vehicle(0.0, "bike"),
        "left": vehicle(20.0, signals=0b10),
        "right": vehicle(40.0, signals=0b1),
        "truck": vehicle(60.0, "truck", 0b11),
    }
    bike, left, right, truck = users(road_users(reader().rows(some), NOBODY, (0.0, 0.0), (0.0, 0.0)))
    assert bike.kind == RoadUserKind.PEDESTRIAN
    assert bike.x_m == pytest.approx(-0.8), "it is a vehicle, named by its front"
    assert truck.kind == RoadUserKind.VAN
    assert (left.turn_indicators, right.turn_indicators, truck.turn_indicators) == (1.0, -1.0, 0.0)


def test_a_type_is_asked_for_once_and_another_only_when_it_is_seen() -> None:
    types = Types()
    read = VehicleReader(SimpleNamespace(vehicletype=types), Numbers())
    read.rows({"a": vehicle(0.0), "b": vehicle(10.0)})
    read.rows({"a": vehicle(0.5), "c": vehicle(20.0)})
    assert sorted(types.asked) == ["getHeight", "getLength", "getVehicleClass", "getWidth"]
    read.rows({"d": vehicle(0.0, "truck")})
    assert len(types.asked) == 8


def test_of_too_many_the_nearest_stay_and_keep_their_numbers() -> None:
    numbers = Numbers()
    rows = reader(numbers).rows({f"v{number:04d}": vehicle(10.0 * number) for number in range(CAPACITY + 40)})
    first = road_users(rows, NOBODY, (0.0, 0.0), (0.0, 0.0))
    assert len(first) == CAPACITY
    assert first[:, 2].max() < 10.0 * CAPACITY
    last = road_users(rows, NOBODY, (0.0, 0.0), (10.0 * (CAPACITY + 40), 0.0))
    assert last[:, 2].min() > 300.0
    by_number = {user.id: user.x_m for user in users(first)}
    assert all(by_number[user.id] == user.x_m for user in users(last) if user.id in by_number)
    assert numbers.name(first[0, 0]) == (False, "v0000")


def test_numbers_go_by_names_however_they_come() -> None:
    some = {name: vehicle(10.0 * place) for place, name in enumerate("abc")}
    rows, turned = reader().rows(some), reader().rows(dict(reversed(some.items())))
    assert np.array_equal(rows, turned[::-1])
    assert len(reader().rows({})) == 0


def test_who_has_not_set_out_is_nowhere() -> None:
    assert len(people_rows({"p": {0x40: 0.0}}, Numbers())) == 0
