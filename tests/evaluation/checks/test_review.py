"""What a golden review finds: every column whose bits differ, and what no plot shows."""

import math
import shutil
from pathlib import Path

import pytest

from simconsole.evaluation.checks.review import MISSING, Review, review_scenario
from simconsole.evaluation.checks.scenario_check import check_scenario

SCENARIO = """\
schema: 1
title: On the brakes
duration_s: 4
session:
  schema: 1
  scenario: {vehicle: hatchback}
  devices: {driver: none}
script:
  points:
    - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
    - {time_s: 2.0, brake: 0.5}
"""


@pytest.fixture(scope="module")
def accepted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("scenario") / "brakes.yaml"
    path.write_text(SCENARIO)
    check_scenario(str(path), update_golden=True)
    return path


@pytest.fixture
def scenario(accepted: Path, tmp_path: Path) -> Path:
    """A scenario of its own for each test, accepted as it is."""
    shutil.copytree(accepted.parent, tmp_path / "scenario")
    return tmp_path / "scenario" / accepted.name


def edited(scenario: Path, old: str, new: str) -> Review:
    text = scenario.read_text()
    assert old in text
    scenario.write_text(text.replace(old, new))
    return review_scenario(str(scenario))


def rewritten(scenario: Path, column: str, tick: int, value: str) -> Review:
    """Review after one value of the golden was replaced."""
    path = scenario.parent / "golden" / "brakes.csv"
    lines = path.read_text().splitlines()
    names = lines[1].split(",")
    for at, line in enumerate(lines):
        if line.startswith(f"{tick},"):
            values = line.split(",")
            values[names.index(column)] = value
            lines[at] = ",".join(values)
    path.write_text("\n".join(lines) + "\n")
    return review_scenario(str(scenario))


def test_an_equal_drive_has_nothing_to_review(scenario: Path) -> None:
    assert review_scenario(str(scenario)) == Review("brakes", "On the brakes", (), ())


def test_a_change_is_found_in_the_column_where_it_begins(scenario: Path) -> None:
    review = edited(scenario, "brake: 0.5", "brake: 0.6")
    names = [column.column for column in review.columns]
    assert "driver.brake" in names
    assert "vehicle.x_m" not in names
    brake = review.columns[names.index("driver.brake")]
    assert brake.time_s.tolist() == [0.5 * number for number in range(1, 9)]
    assert brake.accepted[-1] == pytest.approx(0.5, abs=0.01)
    assert brake.driven[-1] == pytest.approx(0.6, abs=0.01)
    assert (brake.first_s, brake.largest) == (0.5, pytest.approx(0.1, abs=0.01))
    assert [column.first_s for column in review.columns] == sorted(column.first_s for column in review.columns)


def test_a_single_value_is_found_with_its_time(scenario: Path) -> None:
    (column,) = rewritten(scenario, "vehicle.y_m", 500, "0.25").columns
    assert (column.column, column.unit, column.first_s, column.largest, column.largest_s) == (
        "vehicle.y_m",
        "m",
        2.0,
        0.25,
        2.0,
    )


def test_what_is_no_number_is_the_largest_difference(scenario: Path) -> None:
    (column,) = rewritten(scenario, "vehicle.y_m", 500, "nan").columns
    assert (column.largest, column.largest_s) == (math.inf, 2.0)


def test_minus_zero_is_not_zero(scenario: Path) -> None:
    (column,) = rewritten(scenario, "driver.gear", 500, "-0.0").columns
    assert (column.column, column.largest, column.first_s) == ("driver.gear", 0.0, 2.0)


def test_a_longer_drive_and_another_column_are_told(scenario: Path) -> None:
    review = edited(scenario, "duration_s: 4", "duration_s: 5")
    assert review.remarks == ("2 samples were driven beyond the accepted ones",)
    assert edited(scenario, "duration_s: 5", "duration_s: 3").remarks == ("2 accepted samples were not driven",)
    path = scenario.parent / "golden" / "brakes.csv"
    path.write_text(path.read_text().replace("vehicle.y_m", "vehicle.sideways_m"))
    remarks = edited(scenario, "duration_s: 3", "duration_s: 4").remarks
    assert remarks == ("accepted columns that are gone: vehicle.sideways_m", "columns that are new: vehicle.y_m")


def test_a_scenario_without_a_golden_says_so(scenario: Path) -> None:
    (scenario.parent / "golden" / "brakes.csv").unlink()
    assert review_scenario(str(scenario)).remarks == (MISSING,)
