"""A short drive that many tests look at: made once in a test run."""

from pathlib import Path

import pytest

from tests.drives.console import simconsole

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
    """The bundle of a scripted drive of three seconds. Read only: copy it to change it."""
    bundle = tmp_path_factory.mktemp("short") / "bundle"
    done = simconsole("drive", "--headless", "--driver", f"script:{script}", "--for", 3, "--out", bundle)
    assert done.returncode == 0, done.stderr
    return bundle
