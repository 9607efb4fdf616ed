import math
from typing import Any

import pytest

from simconsole.evaluation.metrics.drive_metrics import lateral_errors, metrics, mode_changes
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.metrics.track import track
from simconsole.world.course import Course


def test_metrics_of_a_known_drive(known: Any, course: Course) -> None:
    found = metrics(drive_of(*known), course)
    assert found["ticks"] == 1500
    assert found["duration_s"] == 30.0
    assert found["distance_m"] == pytest.approx(300.0, abs=1.5)
    assert found["mean_speed_kmh"] == pytest.approx(36.0, abs=0.2)
    assert found["max_speed_kmh"] == pytest.approx(36.0)
    assert found["speed_limit_kmh"] == pytest.approx(50.0)
    assert found["above_limit_s"] == 0.0
    assert found["max_lateral_accel_mps2"] == 1.5
    assert found["time_in_mode_s"] == {"MANUAL": 10.0, "AUTONOMOUS": 20.0}


def test_lateral_errors_are_those_of_the_autonomous_part_only(known: Any, course: Course) -> None:
    part = metrics(drive_of(*known), course)["autonomous"]
    assert part["duration_s"] == 20.0
    assert part["distance_m"] == pytest.approx(200.0, abs=1.0)
    assert part["lateral_rms_m"] == pytest.approx(0.02 / math.sqrt(2.0), rel=0.03)
    assert part["lateral_max_m"] == pytest.approx(0.02, rel=1e-3)
    assert part["lateral_p95_m"] == pytest.approx(0.02 * math.sin(0.95 * math.pi / 2.0), rel=0.01)
    assert 50.0 <= part["lateral_max_at_m"] <= 251.0


def test_the_persons_part_is_measured_as_the_controllers(known: Any, course: Course) -> None:
    """The known drive: 10 s by hand on the path, 20 s by a controller that swings by 2 cm."""
    found = metrics(drive_of(*known), course)
    assert (found["manual"]["duration_s"], found["manual"].keys()) == (10.0, found["autonomous"].keys())
    assert found["autonomous"]["lateral_deviation_m"] == pytest.approx(0.02 / math.sqrt(2.0), rel=0.03)
    rows = known.vectors.copy()
    rows[:100, known.columns.index("vehicle.y_m")] += 0.3
    rows[100:200, known.columns.index("vehicle.y_m")] -= 0.3
    swung = metrics(drive_of(rows[:200], known.columns, 50), course)["manual"]
    assert swung["lateral_deviation_m"] == pytest.approx(0.3, rel=0.05)


def test_who_waits_keeps_no_lane(known: Any, course: Course) -> None:
    rows = known.vectors[:200].copy()
    rows[50:, known.columns.index("vehicle.vx_mps")] = 0.0
    rows[50:, known.columns.index("vehicle.y_m")] += 0.3
    assert metrics(drive_of(rows, known.columns, 50), course)["manual"]["lateral_deviation_m"] < 0.01
    rows[:, known.columns.index("vehicle.vx_mps")] = 0.0
    assert metrics(drive_of(rows, known.columns, 50), course)["manual"]["lateral_deviation_m"] is None


def test_mode_changes_and_refusals_in_order(known: Any, course: Course) -> None:
    drive = drive_of(*known)
    changes = metrics(drive, course)["mode_changes"]
    assert [(c["tick"], c["mode"], c["refused"]) for c in changes] == [
        (1, "MANUAL", False),
        (201, "MANUAL", True),
        (251, "AUTONOMOUS", False),
        (1251, "MANUAL", False),
    ]
    assert [c["reason"] for c in changes] == [
        "drive started",
        "refused: brake is pressed",
        "driver asked",
        "driver turned the wheel",
    ]
    assert changes[2]["t_s"] == pytest.approx(5.02)
    assert mode_changes(drive, track(drive, course))[2].x_m == pytest.approx(course.at(2640.0).x_m, abs=1e-6)


def test_a_vehicle_that_is_put_elsewhere_did_not_drive_there(known: Any, course: Course) -> None:
    rows = known.vectors.copy()
    rows[750:, known.columns.index("vehicle.y_m")] += 40.0
    found = metrics(drive_of(rows, known.columns, 50), course)
    assert found["distance_m"] == pytest.approx(300.0, abs=2.0)


def test_without_course_or_autopilot_those_parts_are_none(known: Any, course: Course) -> None:
    alone = metrics(drive_of(*known), None)
    assert alone["speed_limit_kmh"] is None
    assert alone["autonomous"]["lateral_rms_m"] is None
    assert alone["autonomous"]["distance_m"] == pytest.approx(200.0, abs=1.0)
    assert metrics(drive_of(known.vectors[:200], known.columns, 50), course)["autonomous"] is None


def test_speeding_is_counted(known: Any, course: Course) -> None:
    rows = known.vectors.copy()
    rows[100:125, known.columns.index("vehicle.vx_mps")] = 14.0
    assert metrics(drive_of(rows, known.columns, 50), course)["above_limit_s"] == 0.5


def test_the_largest_lateral_error_is_at_its_tick(known: Any, course: Course) -> None:
    rows = known.vectors.copy()
    rows[600, known.columns.index("vehicle.y_m")] += 0.5
    rows[600, known.columns.index("vehicle.x_m")] += 0.5
    way = track(drive_of(rows, known.columns, 50), course)
    errors = lateral_errors(way)
    assert errors is not None
    assert (errors.max_at, errors.max_m) == (600, abs(way.lateral_m[600]))
    assert lateral_errors(track(drive_of(*known), None)) is None
    assert lateral_errors(track(drive_of(known.vectors[:200], known.columns, 50), course)) is None
