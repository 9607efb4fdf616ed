"""The car's columns are those of its groups."""

from simconsole.vehicle.car.state import CAR as COLUMNS
from simconsole.vehicle.car.state import Car, CarState, Wheel


def test_columns_are_the_groups_one_after_the_other() -> None:
    names: list[str] = []
    for name, group in Car.__annotations__.items():
        prefix = f"{name}_" if group is Wheel else ""
        names += [prefix + field for field in group._fields]
    assert tuple(names) == CarState._fields
    assert len(names) == COLUMNS.width
