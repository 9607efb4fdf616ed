"""Programs of a real ROS 2 (.venv-ros2), each test in a domain of its own on this machine's loopback."""

import itertools
import os
import sys
from pathlib import Path

import pytest

from tests.interop.programs import environment
from tests.paths import ROOT

PYTHONS = [folder / ".venv-ros2/bin/python" for folder in (ROOT, Path(sys.prefix).parent)]
PYTHON = str(next((path for path in PYTHONS if path.exists()), PYTHONS[0]))
_domains = itertools.count()

needs_ros2 = pytest.mark.skipif(not Path(PYTHON).exists(), reason="no .venv-ros2: scripts/make-ros2-venv")


def domain() -> dict[str, str]:
    """An environment with a domain of its own: two test runs on one machine do not meet."""
    number = 10 + (7 * os.getpid() + next(_domains)) % 90
    return environment(ROS_DOMAIN_ID=str(number), ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
