"""The bridge's cores: each has its own test file; these make no socket, and take every line and branch."""

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.paths import ROOT

ROOM = ROOT / "simconsole" / "bridge"
TESTS = ROOT / "tests" / "bridge"
RE_EXPORTS = "__init__.py"
"""Tested with whatever reads them."""
BEYOND = (
    *("each_shipped_world", "as_many_are_lost", "spread_evenly", "its_own_size", "lost_independently", "random_use"),
    *("lights_near_the_vehicle", "over_the_sessions_link", "no_other_tag", "no_turn_does_more", "only_some_ticks"),
    *("stalled_client", "many_commands", "(is_foreseen and whole)"),
)
"""Parts of the names of tests that take long, and no line that the others do not take."""


def cores() -> list[str]:
    """The modules of the bridge's folders that the contract of pure folders names."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    (pure,) = (contract["source_modules"] for contract in contracts if contract["type"] == "forbidden")
    folders = [name.removesuffix(".**").rpartition(".")[2] for name in pure if name.startswith("simconsole.bridge.")]
    found = [path for folder in folders for path in sorted((ROOM / folder).rglob("*.py"))]
    assert len(found) > 30
    return [str(path.relative_to(ROOM)) for path in found]


def file_of(core: str) -> Path:
    """The test file of a core."""
    return TESTS / Path(core).parent / f"test_{Path(core).name}"


def files_of(core: str) -> list[Path]:
    """All test files of a core: a large one is split, as test_relay_losses.py from test_relay.py."""
    own = file_of(core)
    return [path for path in (own, *own.parent.glob(f"{own.stem}_*.py")) if path.exists()]


@pytest.mark.parametrize("core", [core for core in cores() if not core.endswith(RE_EXPORTS)])
def test_core_has_its_own_test_file(core: str) -> None:
    assert file_of(core).exists()


def test_every_line_and_branch_is_taken_without_a_socket(tmp_path: Path) -> None:
    files = sorted({path for core in cores() for path in files_of(core)})
    environment = {"COVERAGE_FILE": str(tmp_path / "coverage"), "PYTHONPATH": str(ROOT), "PATH": ""}
    run = [sys.executable, "-m", "coverage"]
    measure = [*run, "run", "--branch", "--source", str(ROOM), "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    done = subprocess.run(
        [*measure, "-p", "tests.bridge.no_sockets", "-k", f"not ({' or '.join(BEYOND)})", *map(str, files)],
        cwd=ROOT, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-1000:]
    report = tmp_path / "report.json"
    subprocess.run([*run, "json", "-q", "-o", report], cwd=ROOT, env=environment, check=True)
    measured = json.loads(report.read_text())["files"]
    missed = {}
    for core in cores():
        page = measured[f"simconsole/bridge/{core}"]
        if page["missing_lines"] or page["missing_branches"]:
            missed[core] = (page["missing_lines"], page["missing_branches"])
    assert missed == {}
