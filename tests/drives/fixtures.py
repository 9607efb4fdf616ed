"""A short drive and the demo, that many tests look at: made once in a test run."""

import os
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any, NamedTuple

import pytest

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


@pytest.fixture(scope="session")
def script(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A person who drives off and brakes."""
    path = tmp_path_factory.mktemp("script") / "launch.yaml"
    path.write_text(SCRIPT)
    return path


@pytest.fixture(scope="session")
def short(tmp_path_factory: pytest.TempPathFactory, script: Path) -> Path:
    """The bundle of a scripted drive of three seconds, with its log. Read only: copy it to change it."""
    bundle = tmp_path_factory.mktemp("short") / "bundle"
    words = ("--headless", "--driver", f"script:{script}", "--for", 3, "--out", bundle, "--no-pack")
    done = simconsole("drive", *words)
    assert done.returncode == 0, done.stderr
    return bundle


class Demo(NamedTuple):
    """The one demo of this test run."""

    bundle: Path
    done: "CompletedProcess[str]"
    results: dict[str, Any]
    table: LogTable
    cpu_s: float  # of the console and all that it started


@pytest.fixture(scope="session")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Demo:
    """`simconsole demo`, once for all tests, as a person starts it."""
    bundle = tmp_path_factory.mktemp("demo") / "bundle"
    before = os.times()
    done = simconsole("demo", "--out", bundle, "--json")
    after = os.times()
    cpu_s = sum(after[2:4]) - sum(before[2:4])
    assert done.returncode == 0, done.stderr
    return Demo(bundle, done, results(done), open_bundle(bundle).log.table(), cpu_s)
