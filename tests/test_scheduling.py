import os
import random
import subprocess
import sys
from pathlib import Path

import pytest

from tests.scheduling import next_file

ROOT = Path(__file__).parents[1]
FILES = 40
CONFTEST = """\
import os
from pathlib import Path
import pytest
from tests.patience import wait_until
from tests.scheduling import Stretches, scheduler_of

def pytest_xdist_make_scheduler(config, log):
    return Stretches(config, log)

def pytest_runtest_logreport(report):
    if hasattr(report, "node"):
        scheduler_of(report.node).retire(report.node)

def pytest_testnodedown(node, error):
    scheduler_of(node).replace(node)

def pytest_runtest_teardown(item):
    with open("ran", "a") as ran:
        print(item.path.name, os.getpid(), file=ran)

@pytest.hookimpl(tryfirst=True)
def pytest_sessionfinish(session):
    def living():
        numbers = {line.split()[1] for line in Path("ran").read_text().splitlines()}
        return [number for number in numbers if os.path.exists(f"/proc/{number}/exe")]

    if "PYTEST_XDIST_WORKER" not in os.environ:
        wait_until(lambda: len(living()) <= 2, "the end of large processes")
"""
TESTS = "def test_a(): pass\ndef test_b(): pass\ndef test_c(): pass\n"


def test_who_has_begun_goes_on() -> None:
    assert next_file([False, False, True, True], 1, {0}) == 2


def test_the_first_begins_at_the_start_and_the_second_in_the_middle() -> None:
    waiting = [True] * FILES
    assert next_file(waiting, None, set()) == 0
    waiting[0] = False
    assert next_file(waiting, None, {0}) == 1 + (FILES - 1) // 2


def test_a_stretch_that_nobody_goes_through_is_taken_from_its_start() -> None:
    assert next_file([False, True, True, False, True], 3 + 1, {3}) == 1


@pytest.mark.parametrize("processes", [1, 2, 3, 4])
@pytest.mark.parametrize("seed", range(5))
def test_each_file_is_taken_once_and_mostly_after_its_neighbour(processes: int, seed: int) -> None:
    """Whoever is faster: at most one jump for each halving of what is left."""
    draw = random.Random(seed)
    waiting, last, taken, jumps = [True] * FILES, dict[int, int](), list[int](), 0
    while any(waiting):
        process = draw.randrange(processes)
        others = {place for each, place in last.items() if each != process}
        place = next_file(waiting, last.get(process), others)
        jumps += place != last.get(process, place - 1) + 1
        waiting[place] = False
        last[process] = place
        taken.append(place)
    assert sorted(taken) == list(range(FILES))
    assert jumps <= FILES // 3


def test_a_large_process_is_replaced_and_every_test_runs_once(tmp_path: Path) -> None:
    """With a real xdist: here each process is too large after its first test."""
    (tmp_path / "conftest.py").write_text(CONFTEST)
    for file in range(4):
        (tmp_path / f"test_{file}.py").write_text(TESTS)
    words = [sys.executable, "-m", "pytest", "-n", "2", "--dist", "loadfile", "--no-loadscope-reorder", str(tmp_path)]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    run = subprocess.run(
        words, cwd=tmp_path, env=environment | {"PYTHONPATH": str(ROOT)}, capture_output=True, text=True, check=False
    )
    assert "12 passed" in run.stdout, run.stdout + run.stderr
    ran_by = dict(line.split() for line in (tmp_path / "ran").read_text().splitlines())
    assert len(ran_by) == 4
    assert len(set(ran_by.values())) > 2
