from pathlib import Path
from typing import Any

import pytest

from simconsole.evaluation.sweep.plan import load_plan
from simconsole.evaluation.sweep.task import from_bytes, to_bytes
from simconsole.values.errors import ProfileError
from tests.evaluation.sweep.plans import grip, write_plan
from tests.paths import ROOT

HILL = str(ROOT / "profiles/scenarios/handling/hill_start_25.yaml")


def test_every_combination_of_values_and_seeds_is_one_drive(tmp_path: Path) -> None:
    path = write_plan(
        tmp_path,
        values={"environment.friction": [0.3, 1.0], "body.mass_kg": {"from": 1200, "to": 1600, "count": 3}},
        seeds={"of": ["devices.person.seed", "outputs.bridge.link.seed"], "first": 5, "count": 2},
    )
    plan = load_plan(path)
    assert plan.keys == ("environment.friction", "body.mass_kg", "devices.person.seed", "outputs.bridge.link.seed")
    assert [task.index for task in plan.tasks] == list(range(12))
    assert [task.values["body.mass_kg"] for task in plan.tasks[:6:2]] == [1200.0, 1400.0, 1600.0]
    last = plan.tasks[-1]
    assert last.values == dict(zip(plan.keys, (1.0, 1600.0, 6, 6), strict=True))
    assert last.resolved.session.environment.friction == 1.0
    assert last.resolved.session.devices.person is not None
    assert last.resolved.session.devices.person.seed == 6
    assert last.resolved.vehicle.body.mass_kg == 1600.0  # type: ignore[union-attr]
    assert last.resolved.session.scenario.duration_s == 5.0


def test_scenarios_are_driven_with_the_values_in_their_sessions(tmp_path: Path) -> None:
    path = write_plan(tmp_path, sessions=[], scenarios=[HILL], values={"body.mass_kg": [1500]})
    (task,) = load_plan(path).tasks
    assert task.scenario is not None
    assert task.resolved.vehicle.body.mass_kg == 1500  # type: ignore[union-attr]


def test_a_task_is_the_same_after_its_way_to_a_worker(tmp_path: Path) -> None:
    for task in grip(tmp_path).tasks:
        assert from_bytes(to_bytes(task)) == task


def test_another_value_or_another_profile_is_another_plan(tmp_path: Path) -> None:
    plan = grip(tmp_path)
    assert plan.digest == load_plan(tmp_path / "plan.yaml").digest
    assert plan.digest != grip(tmp_path, duration_s=6.0).digest


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"sessions": []}, "sessions: value missing"),
        ({"values": {"body.mass_kg": [-1]}}, r"body\.mass_kg.*-1"),
        ({"values": {"body.weight": [1]}}, "body.weight"),
        ({"values": {"body.mass_kg": []}}, r"values\.body\.mass_kg: value missing"),
        ({"values": {"body.mass_kg": {"from": 1, "to": 2, "count": 1}}}, "count"),
        ({"values": {f"mode.a{n}": list(range(10)) for n in range(6)}}, "1000000 drives, at most 100000"),
        ({"sessions": ["nowhere.yaml"]}, "sessions profile: value .*: a file that exists"),
        ({"unknown": 1}, "unknown"),
    ],
)
def test_what_is_wrong_is_told_before_anything_is_driven(tmp_path: Path, changes: dict[str, Any], words: str) -> None:
    with pytest.raises(ProfileError, match=words):
        load_plan(write_plan(tmp_path, **changes))
