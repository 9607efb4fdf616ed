"""docs/first-hour.md: each of its ten tasks runs literally, in a folder of its own."""

import re
from pathlib import Path

import pytest

from tests.pages import prepare, run
from tests.paths import ROOT

TASKS = re.split(r"^## ", (ROOT / "docs" / "first-hour.md").read_text(), flags=re.MULTILINE)[1:]
ELSEWHERE = {"simconsole turtlebot --out out/robots": "tests/cli/turtlebot/test_turtlebot_command.py"}
"""Commands of minutes: the tests that run them."""
LEAVES = (
    ("out/keys/report.html",),
    ("mine.py",),
    ("block.yaml",),
    ("lab/golden/brake.scenario.csv",),
    ("out/first.csv",),
    (),
    ("out/seen/scene.rrd",),
    (),
    ("laden.yaml",),
    ("cockpit.yaml", "out/calibrated/report.html"),
)


@pytest.fixture(scope="module")
def folders() -> dict[int, Path]:
    """The folders in which a task was done."""
    return {}


@pytest.mark.parametrize("number", range(10), ids=lambda number: TASKS[number].splitlines()[0])
def test_the_task_is_done_by_its_commands(number: int, folders: dict[int, Path], tmp_path: Path) -> None:
    commands = prepare(TASKS[number], tmp_path)
    assert commands
    if number == 5:  # it goes on with the drive of the task before
        if 4 in folders:
            (tmp_path / "out").symlink_to(folders[4] / "out")
        else:
            commands.insert(0, prepare(TASKS[4], tmp_path)[0])
        commands.append("test -s out/first-and-heavy.html")
    done = run([command for command in commands if command not in ELSEWHERE], tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    for path in LEAVES[number]:
        assert (tmp_path / path).stat().st_size > 0
    folders[number] = tmp_path


def test_there_are_ten_and_what_is_run_elsewhere_is_there() -> None:
    assert len(TASKS) == 10
    text = "".join(TASKS)
    for command, path in ELSEWHERE.items():
        assert command in text
        assert "turtlebot" in (ROOT / path).read_text()
