import runpy

import pytest

from simconsole.control.modes.document import text
from simconsole.control.modes.mode_table import REACTIONS, Trigger
from simconsole.values.signals import Mode
from tests.paths import ROOT

PAGE = ROOT / "docs" / "modes.md"


def test_the_committed_page_is_the_generated_one() -> None:
    assert PAGE.read_text(encoding="utf-8") == text()


def test_every_transition_is_drawn_once() -> None:
    arrows = [line for line in text().splitlines() if " --> " in line and "[*]" not in line]
    drawn = {
        (source.strip(), target, name)
        for source, _, rest in (line.partition(" --> ") for line in arrows)
        for target, _, names in [rest.partition(": ")]
        for name in names.split(", ")
    }
    assert drawn == {(m.name, t.name, g.name) for m in Mode for g, t in REACTIONS[m].items()}


def test_every_trigger_is_explained() -> None:
    for trigger in Trigger:
        assert f"| {trigger.name} | " in text()


def test_the_command_prints_the_page(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.warns(RuntimeWarning, match="found in sys.modules"):
        runpy.run_module("simconsole.control.modes.document", run_name="__main__")
    assert capsys.readouterr().out == text()
