"""Engine, gearbox and automatic: values that are each in bounds and contradict each other are refused."""

from typing import Any

import msgspec
import pytest

from simconsole.profiles.files.loader import to_text
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.parts.drivetrain import AutomaticProfile, EngineProfile, GearboxProfile
from simconsole.profiles.vehicle import CarProfile
from tests.profiles.refused import refusal


@pytest.fixture(scope="module")
def car() -> CarProfile:
    found = load_vehicle("hatchback")
    assert isinstance(found, CarProfile)
    return found


def changed(part: Any, **values: Any) -> str:
    """The text of a part with these values in the place of its own."""
    return to_text({**msgspec.to_builtins(part), **values})


def curve(*speeds_rpm: float) -> list[dict[str, float]]:
    return [{"at_rpm": speed_rpm, "torque_nm": 100.0} for speed_rpm in speeds_rpm]


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"curve": curve(0.0, 2000.0)}, "curve[0].at_rpm must be above 0"),
        ({"curve": curve(1000.0, 1000.0)}, "curve at_rpm [1000.0, 1000.0] must rise from point to point"),
        ({"curve": []}, "curve: "),
        ({"stall_rpm": 500.0, "fire_rpm": 500.0}, "stall_rpm 500.0 must be below fire_rpm 500.0"),
        ({"fire_rpm": 800.0, "idle_rpm": 800.0}, "fire_rpm 800.0 must be below idle_rpm 800.0"),
        ({"idle_rpm": 900.0, "limit_rpm": 1800.0}, "idle_rpm 900.0 must be below half of limit_rpm 1800.0"),
        ({"cylinders": 0}, "cylinders: value 0: "),
    ],
)
def test_an_engine_whose_speeds_are_out_of_order_is_refused(car: CarProfile, values: dict[str, Any], told: str) -> None:
    assert told in refusal(changed(car.engine, **values), EngineProfile)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"forward": [3.5, 3.5, 1.0]}, "forward (3.5, 3.5, 1.0) must fall from gear to gear"),
        ({"forward": []}, "forward: "),
        ({"bite_closed": 0.5, "bite_open": 0.54}, "bite_open 0.54 must be 0.55 or more: bite_closed + 0.05"),
        ({"driven": "middle"}, 'driven: value "middle": one of '),
    ],
)
def test_a_gearbox_that_cannot_be_meant_is_refused(car: CarProfile, values: dict[str, Any], told: str) -> None:
    assert told in refusal(changed(car.gearbox, **values), GearboxProfile)


@pytest.mark.parametrize(
    ("low", "high"),
    [
        ("down_rpm", "up_rpm"),
        ("down_full_rpm", "up_full_rpm"),
        ("launch_from_rpm", "launch_to_rpm"),
        ("lock_from_rpm", "lock_to_rpm"),
    ],
)
def test_an_automatic_that_would_shift_to_and_fro_is_refused(car: CarProfile, low: str, high: str) -> None:
    text = changed(car.automatic, **{low: 2500.0, high: 2500.0})
    assert f"{high} 2500.0 must be above {low} 2500.0" in refusal(text, AutomaticProfile)
