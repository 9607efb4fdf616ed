"""README.md: short, illustrated, and every command in its console blocks runs.

The commands run in a folder of links to the checkout, so that what they write stays out of it, and with the
environment that runs the tests in the place of the one that `make` would set up (it was set up by `make test`). The
demo is the one that this test run makes for all tests: `make` says that its command is the same. What stands there as
the newest drive is a short one (tests/recording/bundles/test_replay_bundle.py replays the demo).
"""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.drives.fixtures import Demo
from tests.paths import ROOT

README = (ROOT / "README.md").read_text()
BLOCKS = re.findall(r"^```console\n(.*?)^```", README, re.MULTILINE | re.DOTALL)
SHOWN = [line.removeprefix("$ ") for block in BLOCKS for line in block.splitlines() if line.startswith("$ ")]
DEMO = "make demo"
CLONE = "git clone ADDRESS simconsole && cd simconsole"
COMMANDS = SHOWN[1:]
"""All but the first: the checkout that runs the tests is what it makes."""
DONE = "exit code of"


class Ran(NamedTuple):
    """What one command of the README did."""

    code: int
    output: str


def prepared(command: str) -> str:
    """Keep `make` from setting up again: here the environment is the one that runs the tests."""
    plan = "-n --no-print-directory " if command == DEMO else ""
    return re.sub(r"^make ", f"make {plan}-o .venv/ready-to-run -o .venv/ready-to-test ", command)


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory, demo: Demo, short: Path) -> dict[str, Ran]:
    folder = tmp_path_factory.mktemp("checkout")
    (folder / "out").mkdir()
    (folder / "out" / "drive-today").symlink_to(short)
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
    found = {
        command: Ran(int(code), output)
        for command, output, code in zip(COMMANDS, outputs[::2], outputs[1::2], strict=True)
    }
    assert found[DEMO] == Ran(0, ".venv/bin/simconsole demo\n\n")
    return {**found, DEMO: Ran(demo.done.returncode, demo.done.stdout + demo.done.stderr)}


@pytest.mark.parametrize("command", COMMANDS)
def test_command_runs(command: str, ran: dict[str, Ran]) -> None:
    promised = re.search(r"exits (\d)", command)
    assert ran[command].code == int(promised[1] if promised else 0), ran[command].output
    assert "Traceback" not in ran[command].output


def test_clone_line_leads_into_a_checkout(tmp_path: Path) -> None:
    """Its ADDRESS is here a repository with a Makefile."""
    words = "git -C {0} -c user.name=T -c user.email=t@example.org"
    made = words.format("there")
    script = f"git init -q there && touch there/Makefile && {made} add . && {made} commit -qm x && "
    script += SHOWN[0].replace("ADDRESS", "there") + " && test -f Makefile"
    done = subprocess.run(["bash", "-ec", script], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_demo_ends_as_the_page_shows(ran: dict[str, Ran]) -> None:
    """Every line of the expected output is there to the last digit: the demo is the same on every machine."""
    (expected,) = re.findall(r"^```\n(  distance.*?)^```", README, re.MULTILINE | re.DOTALL)
    shown = " ".join(ran[DEMO].output.split())
    for line in expected.splitlines():
        assert " ".join(line.split()) in shown


def test_page_is_short_and_begins_with_a_command() -> None:
    assert len(README.split()) <= 650
    first = next(number for number, line in enumerate(README.splitlines(), start=1) if line.startswith("$ "))
    assert first <= 20
    assert SHOWN[:2] == [CLONE, DEMO]


def test_pictures_are_there_and_small() -> None:
    pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", README)
    assert len(pictures) == 2
    for picture in pictures:
        content = (ROOT / picture).read_bytes()
        assert content.startswith((b"\x89PNG", b"RIFF"))
        assert len(content) < 300_000
