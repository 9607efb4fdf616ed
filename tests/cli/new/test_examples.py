"""`simconsole new example`: a copy of one's own that runs; the programs of the ROS side have tests in tests/interop."""

import json
import os
import subprocess
import sys
from argparse import Namespace
from pathlib import Path
from typing import Any

import pytest

from simconsole.cli.new.examples import EXAMPLES, examples_folder
from simconsole.cli.new.new_command import new
from simconsole.values.errors import ProfileError
from tests.drives.console import environment
from tests.paths import ROOT
from tests.patience import PATIENCE_S


@pytest.fixture
def example(tmp_path: Path) -> Any:
    """Write an example, return its folder."""

    def written(name: str) -> Path:
        new(Namespace(kind="example", name=name, out=str(tmp_path)))
        return tmp_path / name

    return written


def run(folder: Path, *words: str) -> str:
    """Run a program of the environment in an example's folder; return what it says."""
    around = environment(PATH=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}", PYTHONPATH=str(ROOT))
    done = subprocess.run(
        words, cwd=folder, env=around, capture_output=True, text=True, timeout=PATIENCE_S, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_every_example_that_travels_is_there_and_says_what_it_is() -> None:
    assert set(EXAMPLES) <= {path.name for path in examples_folder().iterdir()}
    for name in EXAMPLES:
        assert len(list((examples_folder() / name).iterdir())) >= 1


def test_a_folder_that_is_there_and_a_name_that_is_none_are_refused(tmp_path: Path, example: Any) -> None:
    folder = example("regression")
    (folder / "brake.yaml").write_text("mine")
    with pytest.raises(ProfileError, match="is there already"):
        example("regression")
    assert (folder / "brake.yaml").read_text() == "mine"
    with pytest.raises(ProfileError, match="NAME: value regresion: one of controllers, lab"):
        example("regresion")


def test_the_regression_is_equal_to_its_golden(example: Any) -> None:
    assert "pass  brake" in run(example("regression"), "simconsole", "check", "brake.yaml")


def test_the_labs_repository_passes_its_own_pytest(example: Any) -> None:
    said = run(example("lab"), sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider")
    assert "2 passed" in said


def test_the_notebook_runs_cell_by_cell(example: Any) -> None:
    notebook = json.loads((example("notebook") / "drive.ipynb").read_text())
    assert (notebook["nbformat"], notebook["metadata"]["kernelspec"]["language"]) == (4, "python")
    names: dict[str, Any] = {}
    shown: list[object] = []
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            *lines, last = "".join(cell["source"]).splitlines()
            try:
                value = compile(last, "cell", "eval")
            except SyntaxError:  # no expression: a notebook shows nothing
                exec("\n".join((*lines, last)), names)
            else:
                exec("\n".join(lines), names)
                shown.append(eval(value, names))
    drive, _, driven_map, plots, equal = shown
    assert getattr(drive, "ticks", 0) == 15 * 250
    assert all("<svg" in figure._repr_svg_() for figure in (driven_map, plots))  # type: ignore[attr-defined]
    assert equal is True


@pytest.mark.parametrize("session", ["ring", "street"])
def test_the_own_course_and_the_own_road_map_are_driven(session: str, example: Any) -> None:
    folder = example("own_course")
    if session == "ring":
        run(folder, sys.executable, "-m", "simconsole.world.tools.generate", "ring.plan.yaml", "again.yaml")
        assert (folder / "again.yaml").read_text() == (folder / "ring.yaml").read_text()
    else:
        run(folder, "simconsole", "world", "import", "street.xodr")
    driven = folder / f"on_{session}.yaml"
    driven.write_text(driven.read_text().replace("scene: null", "scene: null, report: false"))  # nobody reads it here
    said = run(folder, "simconsole", "drive", driven.name, "--headless", "--no-pack", "--out", "out")
    assert "by the person      47.9 m" in said
