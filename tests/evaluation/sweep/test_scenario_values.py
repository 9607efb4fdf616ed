from pathlib import Path
from typing import Any

import pytest
import yaml

from simconsole.evaluation.sweep.driving import drive_task
from simconsole.evaluation.sweep.plan import load_plan
from simconsole.values.errors import ProfileError
from tests.evaluation.sweep.plans import SCRIPT, SESSION, write_plan

LEAD = "scenario.actors.lead"


def plan(folder: Path, **changes: Any) -> Path:
    """A plan of one scenario: a car that rolls behind another one."""
    scenario = {
        "schema": 1,
        "title": "lead",
        "duration_s": 3,
        "session": {**SESSION, "devices": {"driver": "none"}},
        "script": SCRIPT,
        "events": [{"event": "emergency_stop", "at_s": 2.0}],
        "actors": [
            {"name": "other", "gap_m": 90},
            {"name": "lead", "gap_m": 30, "speed_kmh": 20, "acts": [{"at_s": 1.0, "speed_kmh": 0}]},
        ],
        "metrics": [{"metric": "distance_m", "min": 0.0}],
    }
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scenario.yaml").write_text(yaml.safe_dump(scenario))
    return write_plan(folder, sessions=[], scenarios=["scenario.yaml"], duration_s=3.0, **changes)


def test_actors_acts_and_events_are_varied(tmp_path: Path) -> None:
    values = {
        f"{LEAD}.gap_m": [20.0, 40.0],
        f"{LEAD}.acts.0.accel_mps2": [2.0],
        "scenario.events.0.at_s": [1.5],
        "environment.friction": [0.8],
    }
    tasks = load_plan(plan(tmp_path, values=values)).tasks
    assert [task.scenario.actors[1].gap_m for task in tasks if task.scenario] == [20.0, 40.0]
    for task in tasks:
        assert task.scenario is not None
        assert task.scenario.actors[0].gap_m == 90.0
        assert task.scenario.actors[1].acts[0].accel_mps2 == 2.0
        assert task.scenario.events[0].at_s == 1.5
        assert task.resolved.session.environment.friction == 0.8


def test_what_is_varied_is_driven(tmp_path: Path) -> None:
    near, far = map(drive_task, load_plan(plan(tmp_path, values={f"{LEAD}.gap_m": [20.0, 40.0]})).tasks)
    assert (near.outcome, far.outcome) == ("passed", "passed"), (near.detail, far.detail)
    assert near.digest != far.digest


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("scenario.actors.nobody.gap_m", 1.0, "nobody: one of other, lead"),
        ("scenario.actors.2.gap_m", 1.0, "2: one of other, lead"),
        ("scenario.events.1.at_s", 1.0, "1: one of 0 to 0"),
        ("scenario.remote.0.start_s", 1.0, "0: one of nothing"),
        (f"{LEAD}.wings", 1.0, "wings"),
        (f"{LEAD}.speed_kmh", -900.0, "speed_kmh"),
        (f"{LEAD}.acts.0.none.deeper", 1.0, "none: no such key"),
    ],
)
def test_what_there_is_not_is_named(key: str, value: float, told: str, tmp_path: Path) -> None:
    with pytest.raises(ProfileError, match=told):
        load_plan(plan(tmp_path, values={key: [value]}))


def test_a_session_has_no_values_of_a_scenario(tmp_path: Path) -> None:
    path = plan(tmp_path, values={f"{LEAD}.gap_m": [1.0]})
    path.write_text(path.read_text().replace("sessions: []", "sessions: [session.yaml]"))
    with pytest.raises(ProfileError, match=r"scenario\.actors\.lead\.gap_m: a session has no such value"):
        load_plan(path)
