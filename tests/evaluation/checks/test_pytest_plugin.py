"""The plugin in a fresh folder, as a lab has it: named in its conftest.py, run by a pytest of its own."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

GOOD = """\
schema: 1
title: stands
duration_s: 1
session:
  schema: 1
  scenario: {vehicle: ball}
  devices: {driver: none}
checks:
  - {column: vehicle.vx_mps, min: 0.0, max: 0.0}
"""
BAD = GOOD.replace("min: 0.0, max: 0.0", "min: 1.0")
WRONG = GOOD.replace("duration_s: 1", "duration_s: -1")


def own_pytest(folder: Path, *arguments: str) -> tuple[int, str]:
    """Run pytest in a lab's folder; return its code and what it says."""
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-p", "no:xdist", *arguments]
    plain = {
        name: value for name, value in os.environ.items() if name != "PYTEST_ADDOPTS"
    }  # of the run this is part of
    done = subprocess.run(command, cwd=folder, env=plain, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def lab(folder: Path) -> Path:
    """Write a lab's folder."""
    (folder / "stands.scenario.yaml").write_text(GOOD)
    (folder / "conftest.py").write_text('pytest_plugins = ["simconsole.evaluation.checks.pytest_plugin"]\n')
    (folder / "other.yaml").write_text("no: scenario\n")
    return folder


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return lab(tmp_path)


@pytest.fixture(scope="module")
def golden(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of what was accepted in a lab's folder. Not to be changed."""
    folder = lab(tmp_path_factory.mktemp("accepted"))
    code, said = own_pytest(folder, "--simconsole-update-golden")
    assert (code, "1 passed" in said) == (0, True), said
    return folder / "golden"


def test_scenarios_are_collected_accepted_and_then_passed(folder: Path, golden: Path) -> None:
    code, said = own_pytest(folder)
    assert code == 1
    assert "no golden; accept one" in said
    shutil.copytree(golden, folder / "golden")
    assert (folder / "golden" / "stands.scenario.csv").is_file()
    code, said = own_pytest(folder, "-k", "stands")
    assert (code, "1 passed" in said) == (0, True), said


def test_what_fails_is_told_without_our_trace(folder: Path, golden: Path) -> None:
    (folder / "moves.scenario.yaml").write_text(BAD)
    (folder / "wrong.scenario.yaml").write_text(WRONG)
    shutil.copytree(golden, folder / "golden")
    code, said = own_pytest(folder)
    assert (code, "2 failed, 1 passed" in said) == (1, True), said
    assert "tick 1: vehicle.vx_mps: 0.0 not in 1.0 to inf" in said
    assert "wrong.scenario.yaml: duration_s: value -1" in said
    assert "Traceback" not in said
    assert "scenario_check.py" not in said


def test_a_lab_says_which_files_are_its_scenarios(folder: Path) -> None:
    (folder / "pytest.ini").write_text("[pytest]\nsimconsole_scenarios = drives/*.yaml\n")
    (folder / "drives").mkdir()
    (folder / "drives" / "mine.yaml").write_text(GOOD)
    code, said = own_pytest(folder, "--collect-only", "-q")
    assert (code, "drives/mine.yaml" in said, "stands" in said) == (0, True, False), said
