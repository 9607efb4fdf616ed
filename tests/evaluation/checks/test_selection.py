from pathlib import Path

import pytest

from simconsole.evaluation.checks.selection import is_scenario, parsed, selected
from simconsole.values.errors import ProfileError
from tests.paths import ROOT

NAMES = ["faults/wheel_lost.yaml", "faults/brake_stuck.yaml", "handling/sine_van.yaml", "roads/Hill.yaml"]


@pytest.mark.parametrize(
    ("expression", "left"),
    [
        ("faults", [0, 1]),
        ("not faults", [2, 3]),
        ("faults and not wheel", [1]),
        ("wheel or van", [0, 2]),
        ("not (wheel or van)", [1, 3]),
        ("hill", [3]),
        ("faults and wheel or roads", [0, 3]),
    ],
)
def test_expressions_select(expression: str, left: list[int]) -> None:
    assert selected(NAMES, expression) == [NAMES[at] for at in left]


@pytest.mark.parametrize("expression", ["", "and", "wheel and", "(wheel", "wheel)", "not", "wheel van"])
def test_what_is_no_expression_is_refused(expression: str) -> None:
    with pytest.raises(ProfileError, match=r"command line: -k: value .*: words with and, or, not and brackets"):
        parsed(expression)


def test_nothing_left_is_refused() -> None:
    with pytest.raises(ProfileError, match="-k: value moon: it selects none of 4 scenarios"):
        selected(NAMES, "moon")


def test_a_folder_stands_for_its_scenarios_and_for_nothing_else(tmp_path: Path) -> None:
    found = selected([str(ROOT / "profiles" / "scenarios")])
    assert str(ROOT / "profiles/scenarios/hand_over.yaml") in found
    assert str(ROOT / "profiles/scenarios/handling/weave.yaml") in found
    assert found == [str(path) for path in sorted(map(Path, found))]
    assert not is_scenario(ROOT / "profiles/sessions/demo.yaml")
    assert not is_scenario(tmp_path / "nowhere.yaml")
    with pytest.raises(ProfileError, match="no scenario in it"):
        selected([str(tmp_path)])
    assert selected(["a", "b", "a"]) == ["a", "b"]
