"""Runs a program behind the mocked kernel of mock_kernel.py, with the system's own Python."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.paths import ROOT

HERE = Path(__file__).parent
SYSTEM_PYTHON = "/usr/bin/python3"
BINDINGS = "import gi; gi.require_version('UMockdev', '1.0'); from gi.repository import UMockdev"


def need_umockdev() -> None:
    """Skip where umockdev is not installed (system-packages.txt lists it; CI installs it)."""
    try:
        found = subprocess.run([SYSTEM_PYTHON, "-c", BINDINGS], capture_output=True, check=False).returncode == 0
    except OSError:
        found = False
    if not found:
        pytest.skip("umockdev or its bindings are not installed (system-packages.txt)")


def start(log: Path, *how: str, motion: Path | None = None) -> "subprocess.Popen[str]":
    """Start haptic_program.py behind the mock, which plays a recorded motion."""
    return run_behind(log, str(HERE / "haptic_program.py"), *how, motion=motion)


def run_behind(log: Path, *words: str, motion: Path | None = None) -> "subprocess.Popen[str]":
    """Start Python with these words behind the mock; its standard input is a pipe."""
    need_umockdev()
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    environment |= {"SDL_VIDEODRIVER": "dummy", "PYTHONPATH": str(ROOT)}
    return subprocess.Popen(
        [SYSTEM_PYTHON, str(HERE / "mock_kernel.py"), str(log), str(motion or "-"), sys.executable, *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
    )


def calls(log: Path) -> list[dict[str, Any]]:
    """What the kernel was told, in order."""
    return [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []
