"""docs/first-hour.md: each of its ten tasks runs literally, in a folder of its own."""

import re
import shutil
from pathlib import Path

import pytest

from tests.drives.fixtures import Once
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
    ("out/first/scene.rrd",),
    (),
    ("laden.yaml",),
    ("cockpit.yaml", "out/calibrated/report.html"),
)


EXPORTED, COMPARED, SEEN = 4, 5, 6
"""Tasks by number: the two others go on with the drive that was exported."""


def do(number: int, folder: Path) -> None:
    """Run a task's commands."""
    commands = prepare(TASKS[number], folder)
    assert commands
    if number == COMPARED:
        commands.append("test -s out/first-and-heavy.html")
    done = run([command for command in commands if command not in ELSEWHERE], folder)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("number", range(10), ids=lambda number: TASKS[number].splitlines()[0])
def test_the_task_is_done_by_its_commands(number: int, once: Once, tmp_path: Path) -> None:
    folder = tmp_path
    if number in (EXPORTED, COMPARED, SEEN):
        exported = once("first-hour-drive", lambda made: do(EXPORTED, made))
        folder = Path(shutil.copytree(exported, tmp_path / "task"))
    if number == SEEN:
        (folder / "out/first/scene.rrd").unlink()  # the drive has written one already
    if number != EXPORTED:
        do(number, folder)
    for path in LEAVES[number]:
        assert (folder / path).stat().st_size > 0


def test_there_are_ten_and_what_is_run_elsewhere_is_there() -> None:
    assert len(TASKS) == 10
    text = "".join(TASKS)
    for command, path in ELSEWHERE.items():
        assert command in text
        assert "turtlebot" in (ROOT / path).read_text()
