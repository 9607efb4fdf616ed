"""A robot's lidar and battery: what is refused, and how much energy the battery holds."""

from typing import Any

import msgspec
import pytest

from simconsole.profiles.files.loader import to_text
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.parts.turtlebot import BatteryProfile, LidarProfile, TurtlebotProfile
from tests.profiles.refused import refusal


@pytest.fixture(scope="module")
def burger() -> TurtlebotProfile:
    found = load_vehicle("turtlebot3_burger")
    assert isinstance(found, TurtlebotProfile)
    return found


def test_a_full_battery_holds_its_charge_times_its_mean_voltage() -> None:
    battery = BatteryProfile(capacity_ah=2.0, full_v=12.0, empty_v=10.0, idle_w=1.0, drive_w=1.0)
    assert battery.energy_j == pytest.approx(22.0 * 3600.0)


@pytest.mark.parametrize(
    ("part", "kind", "values", "told"),
    [
        ("lidar", LidarProfile, {"min_m": 1.0, "max_m": 1.0}, "min_m 1.0 must be below max_m 1.0"),
        ("lidar", LidarProfile, {"samples": 7}, "samples: value 7: "),
        ("battery", BatteryProfile, {"empty_v": 12.6}, "empty_v 12.6 must be below full_v 12.6"),
        ("battery", BatteryProfile, {"capacity_ah": 0.0}, "capacity_ah: value 0.0: "),
    ],
)
def test_what_cannot_be_meant_is_refused(
    burger: TurtlebotProfile, part: str, kind: type, values: dict[str, Any], told: str
) -> None:
    text = to_text({**msgspec.to_builtins(getattr(burger, part)), **values})
    assert told in refusal(text, kind)
