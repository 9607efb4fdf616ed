"""README.md: short, illustrated, and every command in its console blocks runs.

The commands run in a folder of links to the checkout, so that what they write stays out of it, and with the
environment that runs the tests in the place of the one that `make` would set up (it was set up by `make test`).
"""

import os
import re
import subprocess
import sys
from typing import NamedTuple

import pytest

from tests.paths import ROOT

README = (ROOT / "README.md").read_text()
BLOCKS = re.findall(r"^```console\n(.*?)^```", README, re.MULTILINE | re.DOTALL)
COMMANDS = [line.removeprefix("$ ") for block in BLOCKS for line in block.splitlines() if line.startswith("$ ")]
DONE = "exit code of"


class Ran(NamedTuple):
    """What one command of the README did."""

    code: int
    output: str


def prepared(command: str) -> str:
    """Keep `make` from setting up again: here the environment is the one that runs the tests."""
    return re.sub(r"^make ", "make -o .venv/ready-to-run -o .venv/ready-to-test ", command)


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Ran]:
    folder = tmp_path_factory.mktemp("checkout")
    for entry in ROOT.iterdir():
        if entry.name not in {".git", ".venv", "out"}:
            (folder / entry.name).symlink_to(entry)
    (folder / ".venv").symlink_to(sys.prefix)
    script = "".join(f"{prepared(command)}\ncode=$?; echo; echo '{DONE}' $code\n" for command in COMMANDS)
    environment = {name: value for name, value in os.environ.items() if name not in {"DISPLAY", "WAYLAND_DISPLAY"}}
    done = subprocess.run(
        ["bash", "-c", script],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    *outputs, rest = re.split(rf"^{DONE} (\d+)\n", done.stdout, flags=re.MULTILINE)
    assert rest == ""
    return {
        command: Ran(int(code), output)
        for command, output, code in zip(COMMANDS, outputs[::2], outputs[1::2], strict=True)
    }


@pytest.mark.parametrize("command", COMMANDS)
def test_command_runs(command: str, ran: dict[str, Ran]) -> None:
    promised = re.search(r"exits (\d)", command)
    assert ran[command].code == int(promised[1] if promised else 0), ran[command].output
    assert "Traceback" not in ran[command].output


def test_demo_ends_as_the_page_shows(ran: dict[str, Ran]) -> None:
    """Every line of the expected output is there, numbers aside."""
    (expected,) = re.findall(r"^```\n(  distance.*?)^```", README, re.MULTILINE | re.DOTALL)
    shown = re.sub(r"[\d.]+", "0", ran["make demo"].output)
    for line in expected.splitlines():
        assert " ".join(re.sub(r"[\d.]+", "0", line).split()) in " ".join(shown.split())


def test_page_is_short_and_begins_with_a_command() -> None:
    assert len(README.split()) <= 650
    first = next(number for number, line in enumerate(README.splitlines(), start=1) if line.startswith("$ "))
    assert first <= 20
    assert COMMANDS[0] == "make demo"


def test_picture_is_there_and_small() -> None:
    (picture,) = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", README)
    content = (ROOT / picture).read_bytes()
    assert content.startswith(b"\x89PNG")
    assert len(content) < 300_000
