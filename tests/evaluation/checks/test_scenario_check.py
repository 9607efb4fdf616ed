import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.evaluation.checks.scenario_check import Bound, check_scenario
from simconsole.profiles.scenario import Check, ScenarioProfile
from simconsole.profiles.session import Devices, ModeSection, Scenario, SessionProfile
from simconsole.values.errors import ProfileError
from tests.evaluation.in_memory import drive_scenario

COLUMNS = ("a", "b")
ROWS = np.column_stack([np.arange(1.0, 101.0), np.zeros(100)])  # one second at 100 Hz: a is the tick


def judge(check: Check, rows: np.ndarray) -> str | None:
    bound = Bound(check, COLUMNS, 100, "s.yaml")
    for tick, row in enumerate(rows, start=1):
        bound.see(tick, row)
    return bound.problem(len(rows))


@pytest.fixture
def scenario() -> ScenarioProfile:
    session = SessionProfile(
        schema=1, scenario=Scenario(vehicle="ball"), devices=Devices(driver="none"), mode=ModeSection(tick_hz=100)
    )
    return ScenarioProfile(schema=1, title="a second", duration_s=1.0, session=session)


@pytest.mark.parametrize(
    "check",
    [
        Check(column="a", at_s=0.5, min=50.0, max=50.0),
        Check(column="a", at_s=1.0, min=100.0, max=100.0),
        Check(column="a", from_s=0.5, min=51.0),
        Check(column="a", from_s=0.2, until_s=0.4, min=21.0, max=40.0),
        Check(column="b", min=0.0, max=0.0),
    ],
)
def test_a_bound_that_holds(check: Check) -> None:
    assert judge(check, ROWS) is None


@pytest.mark.parametrize(
    ("check", "problem"),
    [
        (Check(column="a", at_s=0.5, max=49.0), "tick 50: a: 50.0 not in -inf to 49.0"),
        (Check(column="a", max=90.0), "tick 91: a: 91.0 not in -inf to 90.0"),
        (Check(column="a", from_s=0.5, min=60.0), "tick 51: a: 51.0 not in 60.0 to inf"),
        (Check(column="a", at_s=2.0, min=0.0), "a: no tick from 200 to 200, the drive has 100"),
    ],
)
def test_a_broken_bound_is_named_with_its_first_tick(check: Check, problem: str) -> None:
    assert judge(check, ROWS) == problem


def test_what_is_no_number_is_outside_every_bound() -> None:
    rows = ROWS.copy()
    rows[10, 1] = np.nan
    assert judge(Check(column="b"), rows) == "tick 11: b: nan not in -inf to inf"


def test_an_unknown_column_is_refused() -> None:
    with pytest.raises(ProfileError, match=r"^s\.yaml: checks: column: value c: a column of the state vector"):
        judge(Check(column="c"), ROWS)


def test_a_scenario_without_person_and_controller_is_driven_too(scenario: ScenarioProfile) -> None:
    recorder, columns = drive_scenario(scenario)
    assert recorder.ticks == 100
    assert recorder.vectors.shape == (100, len(columns))
    assert np.isfinite(recorder.vectors).all()
    again, _ = drive_scenario(scenario)
    assert again.digest == recorder.digest


LONG = """\
schema: 1
title: stands for {seconds} s
duration_s: {seconds}
session:
  schema: 1
  scenario: {{vehicle: ball}}
  devices: {{driver: none}}
checks:
  - {{column: vehicle.vx_mps, min: 0.0, max: 0.0}}
"""
PEAK = """
import json, sys, tracemalloc
from simconsole.evaluation.checks.scenario_check import check_scenario
check_scenario(sys.argv[1], True)  # compiled and loaded
peaks = []
for path in sys.argv[1:]:
    for update in (True, False):
        tracemalloc.start()
        verdict = check_scenario(path, update)
        peaks.append([verdict.passed, verdict.ticks, tracemalloc.get_traced_memory()[1]])
        tracemalloc.stop()
print(json.dumps(peaks))
"""


def test_a_check_takes_no_more_memory_for_a_longer_drive(tmp_path: Path) -> None:
    """Rows, golden and bounds stream: a day fits where a minute does."""
    paths = [tmp_path / "short.yaml", tmp_path / "long.yaml"]
    for path, seconds in zip(paths, (20, 200), strict=True):
        path.write_text(LONG.format(seconds=seconds))
    done = subprocess.run([sys.executable, "-c", PEAK, *paths], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    short, again, long, long_again = json.loads(done.stdout)
    assert (short[:2], long[:2]) == ([True, 5000], [True, 50_000])
    assert long[2] < 1.2 * short[2] + 50_000, "written"
    assert long_again[2] < 1.2 * again[2] + 50_000, "compared"


def test_a_day_begins_and_keeps_no_room_for_its_end(tmp_path: Path) -> None:
    """It ends at its first tick, for a bound names a column that there is not: 39.8 GiB were asked for before."""
    (tmp_path / "day.yaml").write_text(LONG.format(seconds=86400).replace("vehicle.vx_mps", "vehicle.wings"))
    with pytest.raises(ProfileError, match=r"checks: column: value vehicle\.wings"):
        check_scenario(str(tmp_path / "day.yaml"))
    recorder = MemoryRecorder(86400 * 1000, 400)
    assert recorder.vectors.shape == (0, 400)


def test_a_golden_is_whole_or_the_one_before(tmp_path: Path) -> None:
    path, accepted = tmp_path / "s.yaml", tmp_path / "golden" / "s.csv"
    path.write_text(LONG.format(seconds=1))
    assert not check_scenario(str(path)).passed
    first = check_scenario(str(path), update_golden=True)
    before = accepted.read_text()
    assert first.digest in before.splitlines()[0]
    assert check_scenario(str(path)).passed
    path.write_text(path.read_text().replace("vehicle.vx_mps", "vehicle.wings"))
    with pytest.raises(ProfileError):
        check_scenario(str(path), update_golden=True)
    assert accepted.read_text() == before
    assert [entry.name for entry in accepted.parent.iterdir()] == ["s.csv"]
