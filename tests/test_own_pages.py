"""docs/own: each page is a complete example; here its files are written and its commands run, as they stand there."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.drives.console import environment
from tests.paths import ROOT
from tests.patience import PATIENCE_S
from tests.ports import free_port

PAGES = sorted((ROOT / "docs" / "own").glob("*.md"))
BLOCK = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```", re.MULTILINE | re.DOTALL)
PORT = "9390"


def prepare(page: Path, folder: Path) -> list[str]:
    """Write the files of a page; return its commands."""
    port, commands = str(free_port()), []
    for kind, name, text in BLOCK.findall(page.read_text()):
        content = text.replace(PORT, port)
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
        ["bash", "-c", script], cwd=folder, env=around, capture_output=True, text=True, timeout=PATIENCE_S, check=False
    )


SAYS = {
    "cockpit": "out/lab",
    "controller": "every hash equal",
    "message": "looks 0.25 rad to the left",
    "scenario": "brake",
    "session": "every hash equal",
    "vehicle": "laden.yaml: ",
    "world": "out/ring",
}


def test_there_is_a_page_for_each_thing() -> None:
    assert [page.stem for page in PAGES] == sorted(SAYS)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_its_example_runs_literally(page: Path, tmp_path: Path) -> None:
    commands = prepare(page, tmp_path)
    assert commands
    done = run(commands, tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert SAYS[page.stem] in done.stdout
