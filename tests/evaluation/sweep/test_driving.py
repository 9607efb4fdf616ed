from pathlib import Path

import msgspec
import pytest

from simconsole.evaluation.checks.scenario_check import check_scenario
from simconsole.evaluation.checks.whole_drive import numbers
from simconsole.evaluation.sweep.driving import drive_into, drive_task
from simconsole.evaluation.sweep.plan import load_plan
from simconsole.evaluation.sweep.task import from_bytes
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.values.errors import ProfileError
from tests.evaluation.sweep.plans import grip, write_plan
from tests.paths import ROOT

HILL = str(ROOT / "profiles/scenarios/handling/hill_start_25.yaml")
BRAKING = str(ROOT / "profiles/scenarios/handling/straight_braking.yaml")


def test_a_session_gives_metrics_and_the_hash_of_its_bundle(tmp_path: Path) -> None:
    slippery, *_, dry = grip(tmp_path / "plan").tasks
    result = drive_into(dry, tmp_path / "bundle")
    assert (result.outcome, result.ticks, result.detail) == ("driven", 500, "")
    assert result.digest == open_bundle(tmp_path / "bundle").manifest.digest
    assert result.metrics["distance_m"] > 1.0
    assert drive_task(dry) == result
    assert drive_task(slippery).digest != result.digest


def test_a_scenario_is_judged_by_its_bounds_as_check_judges_it(tmp_path: Path) -> None:
    path = write_plan(tmp_path, sessions=[], scenarios=[HILL], values={"environment.friction": [1.0, 0.1]})
    as_it_is, icy = map(drive_task, load_plan(path).tasks)
    checked = check_scenario(HILL)
    assert (as_it_is.outcome, as_it_is.digest) == ("passed", checked.digest)
    assert icy.outcome == "failed"
    assert "not in" in icy.detail


def test_a_manoeuvre_gives_its_characteristic_values(tmp_path: Path) -> None:
    path = write_plan(tmp_path, sessions=[], scenarios=[BRAKING], values={"body.mass_kg": [1500]})
    result = drive_task(load_plan(path).tasks[0])
    assert 30.0 < result.metrics["stopping_distance_m"] < 60.0


def test_what_cannot_be_driven_says_why(tmp_path: Path) -> None:
    (task, *_) = grip(tmp_path).tasks
    (tmp_path / "script.yaml").write_text("points: []\n")
    result = drive_task(task)
    assert result.outcome == "refused"
    assert "script.yaml" in result.detail


def test_a_line_that_is_no_task_is_refused() -> None:
    with pytest.raises(ProfileError, match="task: "):
        from_bytes(b'{"index": 1}')


def test_of_nested_values_only_numbers_and_counts_are_kept() -> None:
    found = dict(numbers({"a": 1, "b": {"c": 2.5, "d": None, "e": "word"}, "f": [1, 2], "g": {"h": {"i": True}}}))
    assert found == {"a": 1.0, "b.c": 2.5, "f.count": 2.0, "g.h.i": 1.0}
    assert msgspec.json.decode(msgspec.json.encode(found)) == found
