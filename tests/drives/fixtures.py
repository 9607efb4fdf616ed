"""What many tests look at, made once in a test run by whoever asks: a short drive, the demo, the check of scenarios."""

import fcntl
import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any, NamedTuple

import pytest

from simconsole.evaluation.checks.selection import selected
from simconsole.profiles.files.loader import profiles_folder
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.reading import LogTable
from tests.drives.console import results, simconsole

SCRIPT = """\
points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 0.3, clutch: 1, gear: 1}
  - {time_s: 0.6, clutch: 1, throttle: 0.3}
  - {time_s: 1.8, clutch: 0, throttle: 0.3, hand_wheel_deg: 0}
  - {time_s: 2.2, hand_wheel_deg: 10, throttle: 0.3, brake: 0}
  - {time_s: 2.6, throttle: 0, brake: 0.3}
"""

REPEATED = frozenset(
    {
        "handling/sine_with_dwell_van",
        "handling/bend_braking_van",
        "handling/severe_double_lane_change",
        "handling/straight_braking_30",
        "handling/straight_braking_60",
        "by_hand/urban",
        "by_hand/van",
        "roads/country_autopilot",
        "roads/urban_autopilot",
        "traffic/lead_brakes",
        "traffic/stop_and_go",
    }
)
"""Scenarios that repeat another with another car, speed, friction or world: driven with --long only."""

Once = Callable[[str, Callable[[Path], object]], Path]
"""Return the folder of this name; whoever asks first makes what is in it, the others wait."""


@pytest.fixture(scope="session")
def once(tmp_path_factory: pytest.TempPathFactory) -> Once:
    """Make what all processes of a test run share."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base

    def folder_of(name: str, make: Callable[[Path], object]) -> Path:
        folder, made = shared / name, shared / f"{name}.made"
        with (shared / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not made.exists():
                shutil.rmtree(folder, ignore_errors=True)  # of one who failed
                folder.mkdir()
                make(folder)
                made.touch()
        return folder

    return folder_of


@pytest.fixture(scope="session")
def script(once: Once) -> Path:
    """A person who drives off and brakes."""
    return once("script", lambda folder: (folder / "launch.yaml").write_text(SCRIPT)) / "launch.yaml"


@pytest.fixture(scope="session")
def short(once: Once, script: Path) -> Path:
    """The bundle of a scripted drive of three seconds, with its log. Read only: copy it to change it."""

    def make(folder: Path) -> None:
        words = ("--headless", "--driver", f"script:{script}", "--for", 3, "--out", folder / "bundle", "--no-pack")
        done = simconsole("drive", *words)
        assert done.returncode == 0, done.stderr

    return once("short", make) / "bundle"


class Demo(NamedTuple):
    """The one demo of this test run."""

    bundle: Path
    done: "CompletedProcess[str]"
    results: dict[str, Any]
    cpu_s: float  # of the console and all that it started

    @property
    def ticks(self) -> int:
        """How many the log holds."""
        return len(self.table("arbitration.mode").ticks)

    def table(self, *columns: str) -> LogTable:
        """These columns; all of them are more than a process of the tests should hold."""
        return open_bundle(self.bundle).log.table(columns)


@pytest.fixture(scope="session")
def demo(once: Once) -> Demo:
    """`simconsole demo`, once for all tests, as a person starts it. Read only: copy it to change it."""

    def make(folder: Path) -> None:
        before = os.times()
        done = simconsole("demo", "--out", folder / "bundle", "--json")
        after = os.times()
        assert done.returncode == 0, done.stderr
        cpu_s = sum(after[2:4]) - sum(before[2:4])
        (folder / "told.json").write_text(json.dumps([done.stdout, done.stderr, cpu_s]))

    folder = once("demo", make)
    out, err, cpu_s = json.loads((folder / "told.json").read_text())
    done = CompletedProcess(["simconsole", "demo"], 0, out, err)
    return Demo(folder / "bundle", done, results(done), cpu_s)


class Checked(NamedTuple):
    """The one check of the shipped scenarios of this test run."""

    scenarios: dict[Path, dict[str, Any]]  # what `--json` says of each file
    cpu_s: float  # of the command and all that it started


@pytest.fixture(scope="session")
def checked(once: Once, pytestconfig: pytest.Config) -> Checked:
    """`simconsole check` of all shipped scenarios, once for all tests; the sample leaves out what repeats another."""
    scenarios = profiles_folder() / "scenarios"
    named = {
        path.relative_to(scenarios).with_suffix("").as_posix(): path for path in map(Path, selected([str(scenarios)]))
    }
    assert named.keys() > REPEATED
    paths = [path for name, path in named.items() if pytestconfig.option.long or name not in REPEATED]

    def make(folder: Path) -> None:
        before = os.times()
        done = simconsole("check", *paths, "--json")
        after = os.times()
        (folder / "told.json").write_text(json.dumps([results(done), sum(after[2:4]) - sum(before[2:4])]))

    told, cpu_s = json.loads((once("checked", make) / "told.json").read_text())
    return Checked(dict(zip(paths, told["scenarios"], strict=True)), cpu_s)
