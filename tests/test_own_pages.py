"""docs/own: each page is a complete example; here its files are written and its commands run, as they stand there."""

from pathlib import Path

import pytest

from tests.pages import prepare, run
from tests.paths import ROOT

PAGES = sorted((ROOT / "docs" / "own").glob("*.md"))
SAYS = {
    "cockpit": "out/lab",
    "controller": "every hash equal",
    "keys": "Turning of the hand wheel per turning of the road wheels.",
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
    commands = prepare(page.read_text(), tmp_path)
    assert commands
    done = run(commands, tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert SAYS[page.stem] in done.stdout
