"""Every command in a block of a page runs: literally where the page is a lesson, else in the test that is named here.

README.md, docs/first-hour.md and docs/own run as they stand (test_readme.py, test_first_hour.py, test_own_pages.py);
the exports of docs/exports.md do here. What runs nowhere says why.
"""

import re
import shutil
from pathlib import Path

import pytest

from tests.pages import run
from tests.paths import ROOT

LESSONS = {"README.md", "docs/first-hour.md", *(f"docs/own/{path.name}" for path in (ROOT / "docs/own").glob("*.md"))}
SHELL = re.compile(r"^```(?:console|sh|bash)\n(.*?)^```", re.MULTILINE | re.DOTALL)
HERE = "tests/test_doc_commands.py"
EXPORT = "simconsole export out/drive-1 "
RUN = {
    "docs/exports.md": {
        EXPORT: HERE,
        "simconsole drive session.yaml --headless --commands bag:": "tests/drives/test_bag_round_trip.py",
        "simconsole drive session.yaml --headless --driver trace:": "tests/cli/test_drive.py",
        "simconsole import drive.mcap --to trace ": "tests/drives/test_bag_round_trip.py",
        "simconsole import field_test.bag --topic /joy --axes ": "tests/cli/test_exchange.py",
    },
    "docs/handling.md": {"simconsole check profiles/scenarios/handling/": "tests/scenarios/test_handling.py"},
    "docs/install.md": {"make demo": "tests/test_readme.py", "simconsole doctor": "tests/cli/test_doctor.py"},
    "docs/operators.md": {
        "simconsole view out/drive-1": "tests/cli/test_recordings.py",
        "simconsole view --no-open": "tests/cli/test_live_view.py",
        "simconsole view --browser": "tests/cli/test_recordings.py",
    },
    "docs/ros2.md": {"simconsole bridge serve --ros2": "tests/interop/puppets.py"},
    "docs/rosbridge.md": {
        "simconsole bridge cert --host ": "tests/cli/test_rosbridge.py",
        "simconsole bridge serve --host ": "tests/cli/test_rosbridge.py",
    },
    "docs/scenarios.md": {
        "simconsole check profiles/scenarios ": "tests/cli/test_check.py",
        "simconsole check mine.yaml --update-golden": "tests/evaluation/metrics/test_registered.py",
    },
    "docs/sweeps.md": {
        "simconsole sweep plan.yaml": "tests/cli/sweep/test_sweep_command.py",
        "export DASK": "tests/evaluation/sweep/clusters.py",
        "dask scheduler --no-dashboard": "tests/evaluation/sweep/clusters.py",
        "dask worker tcp://": "tests/evaluation/sweep/clusters.py",
    },
    "docs/traffic.md": {
        "sumo -c own.sumocfg --remote-port ": "tests/drives/sumo_machines.py",
        "simconsole drive session.yaml": "tests/drives/sumo_machines.py",
        "simconsole autopilot --url ": "tests/drives/sumo_machines.py",
    },
}
"""By page, how commands begin and the file whose test runs them, with the names of its own folders."""
NOWHERE = {
    "simconsole view ": "docs/operators.md: opens a window of rerun's; with --no-open and --browser it runs",
    "podman build ": "docs/install.md: needs a program that builds containers; test_packaging.py reads it",
    "pip install 'simconsole[ros2]'": "docs/ros2.md: fetches from a package index; scripts/make-ros2-venv does it",
    "simconsole replay out/sweep-drive-17": "docs/sweeps.md: any bundle's replay, as in README.md",
}
"""How commands begin that no test runs: the page, and why."""


def shown(page: Path) -> list[str]:
    """The commands in the shell blocks of a page, comments left out."""
    lines = [line.removeprefix("$ ") for block in SHELL.findall(page.read_text()) for line in block.splitlines()]
    words = (re.sub(r"(^|\s+)# .*$", "", line).strip() for line in lines)
    return [command for command in words if command]


OTHERS = [
    (str(page.relative_to(ROOT)), command)
    for page in [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))]
    if str(page.relative_to(ROOT)) not in LESSONS
    for command in shown(page)
]


@pytest.mark.parametrize(("page", "command"), OTHERS)
def test_a_command_runs_somewhere_or_it_is_said_why_not(page: str, command: str) -> None:
    test = next((test for begin, test in RUN.get(page, {}).items() if command.startswith(begin.rstrip())), None)
    if test is None:
        why = next((why for begin, why in NOWHERE.items() if f"{command} ".startswith(begin)), "")
        assert why.startswith(page), "which test runs it?"
        return
    words = command.split()
    named = words[1] if words[0] == "simconsole" else words[0]
    assert re.search(rf"\b{named}\b", (ROOT / test).read_text()), f"{test} says nothing of {named}"


def test_nothing_is_said_of_commands_that_no_page_shows() -> None:
    for page, begins in RUN.items():
        for begin in begins:
            assert any(where == page and f"{command} ".startswith(begin) for where, command in OTHERS), begin
    for begin in NOWHERE:
        assert any(f"{command} ".startswith(begin) for _, command in OTHERS), begin


def test_exports_run_as_the_page_shows_them(short: Path, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    shutil.copytree(short, tmp_path / "out" / "drive-1")
    commands = [command for command in shown(ROOT / "docs/exports.md") if command.startswith(EXPORT)]
    done = run(commands, tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert {path.name for path in (tmp_path / "out").iterdir()} >= {
        *("drive-1.mcap", "drive-1-rosbag2", "drive-1.csv", "drive-1.parquet")
    }
