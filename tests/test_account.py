import os
import subprocess
import sys
from pathlib import Path

from tests.paths import ROOT
from tests.patience import PATIENCE_S

BROKEN = """
def test_one(): pass
def test_two(record_property): record_property("not to be sent to another process", object())
def test_three(): pass
"""


def test_a_run_whose_process_breaks_says_at_its_end_why_and_what_was_not_run(tmp_path: Path) -> None:
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    (tmp_path / "test_broken.py").write_text(BROKEN)
    (tmp_path / "test_good.py").write_text("def test_good(): pass\n")
    words = [sys.executable, "-m", "pytest", "-p", "tests.conftest", "-n", "2", "--dist", "loadfile"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=PATIENCE_S)
    lines = [line for line in done.stdout.splitlines() if line]
    assert done.returncode == 3
    assert lines[-4:-1] == ["2 tests were not run:", "test_broken.py::test_two", "test_broken.py::test_three"]
    assert any("can't serialize <class 'object'>" in line for line in lines[-12:-4]), done.stdout
    assert "2 passed" in lines[-1]
