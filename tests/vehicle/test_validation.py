"""docs/validation.md is what its script writes, and what it says holds."""

import json
import re
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import pytest

from tests.paths import ROOT


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, dict[str, Any]]:
    """The page as the script writes it now, and its figures."""
    path = tmp_path_factory.mktemp("validation") / "validation.md"
    done = subprocess.run(
        [sys.executable, ROOT / "scripts" / "make_validation.py", path, "--json"],
        check=True,
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    return path.read_text(), json.loads(done.stdout.splitlines()[-1])


NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?")


def apart(published: str, written: str) -> list[str]:
    """Return the numbers that differ by more than one unit of their last digit: what another libm may do to peers."""
    found = []
    for old, new in zip(NUMBER.findall(published), NUMBER.findall(written), strict=True):
        mantissa, _, exponent = old.partition("e")
        unit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
        if abs(float(old) - float(new)) > 1.001 * unit:
            found.append(f"published {old}, now {new}")
    return found


def test_the_page_is_the_one_that_the_script_writes(written: tuple[str, dict[str, Any]]) -> None:
    published = (ROOT / "docs" / "validation.md").read_text()
    assert NUMBER.sub("#", published) == NUMBER.sub("#", written[0]), "run: python scripts/make_validation.py"
    assert len(NUMBER.findall(published)) > 80
    assert not apart(published, written[0]), "run: python scripts/make_validation.py"


def test_a_stale_number_on_the_page_is_seen() -> None:
    assert apart("8.476 m, 1.4e-03", "8.475 m, 1.4e-03") == []
    assert apart("8.476 m, 1.4e-03", "8.478 m, 1.6e-03") == [
        "published 8.476, now 8.478",
        "published 1.4e-03, now 1.6e-03",
    ]


def test_oracles_hold(written: tuple[str, dict[str, Any]], record_property: Callable[[str, object], None]) -> None:
    found = written[1]["oracles"]
    record_property(
        "oracles, off by", ", ".join(f"{name} {value.get('error', 0):.2g}" for name, value in found.items())
    )
    assert abs(found["ackermann"]["error"]) < 0.015
    assert found["bicycle"]["error"] < 0.03
    assert abs(found["bicycle"]["gain_error"]) < 1e-3
    assert abs(found["static_loads"]["error"]) < 1e-6
    assert -1e-3 < found["energy"]["error"] < 0.0, "motion never exceeds the height's energy"
    assert found["energy"]["largest_rise_share"] < 1e-6
    assert found["mirror"]["error"] == 0.0
    assert found["mirror"]["compared"] > 10_000
    assert 0.8 < found["convergence"]["order"] < 1.5
    assert found["convergence"]["error_1_ms_m"] < 0.01


def test_ours_is_the_nearest_to_the_multi_body_model_everywhere(written: tuple[str, dict[str, Any]]) -> None:
    for one in written[1]["peers"]:
        gaps, rates = one["gaps_m"], one["yaw_rates_radps"]
        assert gaps["ours"] < 0.5 * min(gaps["ST"], gaps["STD"], gaps["KS"]), one
        assert abs(rates["ours"] / rates["MB"] - 1.0) < 0.01, one
