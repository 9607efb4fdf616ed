"""A controller of another package: installed beside us, named by a session, and refused where it is wrong."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from simconsole.cli.api.commands import hold_speed
from simconsole.drivers.registered import GROUP, OwnController, named_controller
from simconsole.profiles.session import ControllerChoice
from simconsole.session.preconditions import check_controller
from simconsole.session.resolution import load_session, override
from simconsole.values.errors import ControllerError, ProfileError
from simconsole.values.registered import Bounded
from tests.drives.console import environment
from tests.drives.console import simconsole as command
from tests.installed import installed
from tests.paths import ROOT

USED = """
import json, sys
from pathlib import Path
import msgspec, pyarrow.parquet
import simconsole
from simconsole.cli.main import main
folder = Path(sys.argv[1])
brief = {"scenario.duration_s": 4.0, "outputs.scene": None, "outputs.report": False}
session = simconsole.load(folder / "quick.yaml").with_values(brief)
drive = session.run(out=folder / "bundle")
assert drive.replay().hashes_equal
plain = msgspec.to_builtins(session.profile)
bounds = [{"column": "vehicle.vx_mps", "at_s": 4.0, "min": 3.0, "max": 7.0}]
scenario = {"schema": 1, "title": "q", "duration_s": 4, "session": plain, "checks": bounds}
(folder / "scenario.yaml").write_text(json.dumps(scenario))
assert main(["check", str(folder / "scenario.yaml"), "--update-golden"]) == 0
plan = {"schema": 1, "sessions": ["quick.yaml"], "duration_s": 4.0,
        "values": {"features.controller.parameters.speed_mps": [1.0, 7.0]}}
(folder / "plan.yaml").write_text(json.dumps(plan))
assert main(["sweep", str(folder / "plan.yaml"), "--jobs", "1", "--out", str(folder / "swept")]) == 0
table = pyarrow.parquet.read_table(folder / "swept" / "results.parquet").to_pydict()
assert table["digest"][1] == drive.digest, (table["digest"], drive.digest)
assert table["metrics.max_speed_kmh"][0] < 5.0 < table["metrics.max_speed_kmh"][1]
fails = {"features.controller.parameters.speed_mps": 1.5}
(folder / "fails.yaml").write_text(json.dumps(msgspec.to_builtins(session.with_values(fails).profile)))
assert main(["drive", str(folder / "fails.yaml"), "--headless", "--out", str(folder / "failed"), "--json"]) == 1
assert 0 < simconsole.open_drive(folder / "failed").ticks < 1000
scenario["session"] = msgspec.to_builtins(session.with_values(fails).profile)
(folder / "fails.yaml").write_text(json.dumps({**scenario, "checks": []}))
verdict = simconsole.check(folder / "fails.yaml")
assert not verdict.passed
assert any(problem.startswith("controller quick: tick ") for problem in verdict.problems), verdict.problems
"""


def test_a_session_a_scenario_and_a_sweep_name_a_controller(tmp_path: Path) -> None:
    assert command("new", "driver", "quick", "--out", tmp_path).returncode == 0
    installed(tmp_path, GROUP, quick="CONTROLLER")
    source = tmp_path / "quick.py"
    broken = "        car = seen.vehicle\n        assert self.speed_mps != 1.5 or seen.t_s < 1.0, 'worn out'\n"
    source.write_text(source.read_text().replace("        car = seen.vehicle\n", broken))
    path = os.pathsep.join((str(tmp_path), str(ROOT)))
    words = [sys.executable, "-c", USED, str(tmp_path)]
    done = subprocess.run(words, capture_output=True, text=True, check=False, env=environment(PYTHONPATH=path))
    assert done.returncode == 0, done.stdout + done.stderr
    assert "controller quick: tick 2" in done.stdout
    assert "AssertionError: worn out" in done.stdout


def make(made: Any, **parameters: float) -> Any:
    own = OwnController({"speed_mps": Bounded(5.0, 0.0, 10.0)}, made)
    choice = ControllerChoice(name="quick", parameters=parameters)
    return named_controller(choice, None, SimpleNamespace(), 0.02, own)  # type: ignore[arg-type]  # it is not looked at


def fails(settings: object) -> Callable[[object], None]:
    raise KeyError("map")


def test_parameters_are_inside_their_bounds_and_each_drive_has_a_controller_of_its_own() -> None:
    seen: list[Any] = []

    def made(settings: Any) -> Callable[[object], None]:
        seen.append(settings)
        return lambda snapshot: None

    make(made)
    make(made, speed_mps=7.0)
    assert [one.parameters for one in seen] == [{"speed_mps": 5.0}, {"speed_mps": 7.0}]
    assert seen[0].period_s == 0.02
    with pytest.raises(ProfileError, match=r"^features.controller.parameters: speed_mps: value 11: 0 to 10$"):
        make(made, speed_mps=11.0)
    with pytest.raises(ProfileError, match=r"^features.controller.parameters: wings: one of speed_mps$"):
        make(made, wings=1.0)


@pytest.mark.parametrize(
    ("made", "told"),
    [(fails, "KeyError: 'map'"), (lambda settings: 3, "int: a function of a snapshot")],
)
def test_what_cannot_be_made_is_one_line(made: Any, told: str) -> None:
    with pytest.raises(ProfileError, match=f"^features.controller: value quick: {told}$"):
        make(made)


def test_what_fails_or_answers_wrongly_is_named_with_its_tick() -> None:
    seen: Any = SimpleNamespace(tick=7)
    answers = iter((hold_speed(1.0), None, 5.0))
    controller = make(lambda settings: lambda snapshot: next(answers))
    assert controller(seen) == hold_speed(1.0)
    assert controller(seen) is None
    with pytest.raises(ControllerError, match=r"^controller quick: tick 7: TypeError: float: a command"):
        controller(seen)
    with pytest.raises(ControllerError, match=r"^controller quick: tick 7: StopIteration"):
        controller(seen)


def test_one_that_is_not_registered_is_refused_by_name() -> None:
    with pytest.raises(ProfileError, match=r"^features.controller.name: value nobody: one of "):
        named_controller(ControllerChoice(name="nobody"), None, SimpleNamespace(), 0.02)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"mode": {"pacing": "free"}}, "needs mode.pacing lockstep; it is free"),
        ({"features": {"autopilot": "urban"}}, "without features.autopilot: one controller at a time"),
        ({"features": {"commands": "bag:x.bag"}}, "without features.commands: one controller at a time"),
    ],
)
def test_it_is_alone_and_in_lockstep(changes: dict[str, dict[str, object]], told: str) -> None:
    session = override(load_session("bridge"), features={"controller": {"name": "quick"}}, mode={"pacing": "lockstep"})
    check_controller(session)
    with pytest.raises(ProfileError, match=f"^features.controller: value quick: {told}$"):
        check_controller(override(session, **changes))
