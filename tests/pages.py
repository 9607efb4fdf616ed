"""Pages of the documentation whose examples run as they stand: their files are written, their commands run."""

import os
import re
import subprocess
import sys
from pathlib import Path

from tests.drives.console import environment
from tests.paths import ROOT
from tests.patience import PATIENCE_S
from tests.ports import free_port

BLOCK = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```", re.MULTILINE | re.DOTALL)
PORT = "9390"
"""The port that pages name; a test has one of its own."""


def prepare(text: str, folder: Path) -> list[str]:
    """Write the files of a page, or of a part of one; return its commands."""
    port, commands = str(free_port()), []
    for kind, name, block in BLOCK.findall(text):
        content = block.replace(PORT, port)
        if name:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(content)
        elif kind == "console":
            commands += [line.removeprefix("$ ") for line in content.splitlines() if line.startswith("$ ")]
    return commands


def run(commands: list[str], folder: Path) -> "subprocess.CompletedProcess[str]":
    """Run them one after the other, until one fails; what still runs at the end is ended."""
    script = "\n".join(("trap 'kill $(jobs -p) 2>/dev/null || true' EXIT", "set -e", *commands))
    around = environment(PATH=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}", PYTHONPATH=str(ROOT))
    return subprocess.run(
        ["bash", "-c", script], cwd=folder, env=around, stdin=subprocess.DEVNULL, capture_output=True, text=True,
        timeout=PATIENCE_S, check=False,
    )  # fmt: skip
