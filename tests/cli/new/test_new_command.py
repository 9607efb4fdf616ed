"""`simconsole new`: every template passes the test beside it, in a lab's own folder; nothing is overwritten."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

from simconsole.cli.new.new_command import KINDS
from tests.drives.console import complaint, results, within
from tests.paths import ROOT


def test_every_template_passes_its_own_test(tmp_path: Path) -> None:
    for kind in KINDS:
        done = within("new", kind, f"mine_{kind}", "--out", tmp_path / kind, "--json")
        assert done.returncode == 0, done.stderr
        made = [Path(path) for path in results(done)["files"]]
        assert sorted(path for path in (tmp_path / kind).rglob("*") if path.is_file()) == sorted(made)
    tests = [f"{kind}/test_mine_{kind}.py" for kind in KINDS]
    words = [sys.executable, "-m", "pytest", "--rootdir", str(tmp_path), "-rA", "-p", "no:cacheprovider", *tests]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    tested = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert tested.returncode == 0, tested.stdout
    assert all(f"PASSED {test}" in tested.stdout for test in tests)
    assert "SKIPPED" not in tested.stdout


def test_a_template_uses_no_name_of_ours_but_the_one_given(tmp_path: Path) -> None:
    for kind in KINDS:
        within("new", kind, "other_name", "--out", tmp_path / kind)
        for path in (tmp_path / kind).rglob("*"):
            if path.is_file():
                assert "$" not in path.read_text(), path
                assert "other_name" in path.name or path.name == "pyproject.toml"
            if path.suffix == ".py":
                ast.parse(path.read_text())


def test_nothing_that_is_there_is_replaced(tmp_path: Path) -> None:
    assert within("new", "session", "mine", "--out", tmp_path).returncode == 0
    (tmp_path / "mine.yaml").write_text("changed")
    done = within("new", "session", "mine", "--out", tmp_path)
    assert done.returncode == 2
    assert "is there already" in complaint(done)
    assert (tmp_path / "mine.yaml").read_text() == "changed"


@pytest.mark.parametrize("name", ["Mine", "my-car", "../mine", "", "1st", "x" * 42])
def test_a_name_that_is_no_module_is_refused(name: str, tmp_path: Path) -> None:
    done = within("new", "controller", name, "--out", tmp_path / "lab")
    assert done.returncode == 2
    assert "NAME" in complaint(done)
    assert not (tmp_path / "lab").exists()


def test_a_folder_that_cannot_be_made_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    done = within("new", "controller", "mine", "--out", tmp_path / "file" / "lab")
    assert "cannot be written" in complaint(done)
