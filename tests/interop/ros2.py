"""Programs of a real ROS 2 (.venv-ros2), each test in a domain of its own on this machine's loopback."""

import itertools
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
PYTHONS = [folder / ".venv-ros2/bin/python" for folder in (ROOT, Path(sys.prefix).parent)]
PYTHON = next((path for path in PYTHONS if path.exists()), PYTHONS[0])
_domains = itertools.count()

needs_ros2 = pytest.mark.skipif(not PYTHON.exists(), reason="no .venv-ros2: scripts/make-ros2-venv")


def environment() -> dict[str, str]:
    """A domain of its own: two test runs on one machine do not meet."""
    domain = 10 + (7 * os.getpid() + next(_domains)) % 90
    return {
        **os.environ,
        "ROS_DOMAIN_ID": str(domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "PYTHONPATH": str(ROOT),
        "PYTHONWARNINGS": "default",
    }


@contextmanager
def program(environment: dict[str, str], *words: str) -> Iterator["subprocess.Popen[str]"]:
    """A Python program beside the test; its end is the test's at the latest."""
    command = [str(PYTHON), *words]
    with subprocess.Popen(
        command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        try:
            yield process
        finally:
            process.kill()
            process.communicate()
