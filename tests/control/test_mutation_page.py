"""docs/mutation.md, written by `make mutation`: it meets the bar, and what it says of survivors is of this code."""

import ast
import re

import pytest

from tests.paths import ROOT

TEXT = (ROOT / "docs" / "mutation.md").read_text()
SURVIVORS = re.findall(r"^\| `([^`]+)` \| `([^`]+)` \| `([^`]+)` \| (.+) \|$", TEXT, re.MULTILINE)
MODULES = re.findall(r"^\| ([a-z_]+) \| (\d+) \| (\d+) \| [\d.]+ % \|$", TEXT, re.MULTILINE)


def test_the_score_is_that_of_its_modules_and_meets_the_bar() -> None:
    made, killed = (sum(int(row[at]) for row in MODULES) for at in (1, 2))
    total = re.search(r"^(\d+) mutants run against \d+ tests, (\d+) killed: ([\d.]+) %\.$", TEXT, re.MULTILINE)
    assert total is not None
    assert (int(total[1]), int(total[2])) == (made, killed)
    assert float(total[3]) == pytest.approx(100.0 * killed / made, abs=0.01)
    assert killed >= 0.95 * made


@pytest.mark.parametrize(("function", "before", "after", "why"), SURVIVORS, ids=[row[0] for row in SURVIVORS])
def test_every_survivor_is_of_a_line_that_is_still_there(function: str, before: str, after: str, why: str) -> None:
    module, _, name = function.partition(".")
    (path,) = (ROOT / "simconsole" / "control").rglob(f"{module}.py")
    source = path.read_text()
    spans = [(node.lineno, node.end_lineno) for node in ast.parse(source).body if getattr(node, "name", "") == name]
    ((first, last),) = spans
    lines = source.splitlines()[first - 1 : last]
    assert before.replace(r"\|", "|") in " ".join(" ".join(lines).split())
    assert before != after
    assert why != "not explained yet"
