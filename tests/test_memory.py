import subprocess
import sys

from tests.memory import MOST_MB, Peak, peak_mb

LARGE_MB = 300.0
ALLOCATES = f"bytearray(int({LARGE_MB}e6))"


def test_the_memory_of_an_ended_child_is_seen() -> None:
    subprocess.run([sys.executable, "-c", ALLOCATES], check=True)
    assert peak_mb() >= LARGE_MB


def test_the_line_tells_what_is_too_much() -> None:
    assert Peak(612.4, "a.py::b").line() == "memory: at most 612 MB in one process, in a.py::b"
    assert Peak(MOST_MB + 1.0, "a").line().endswith("in a, more than the 1000 MB that one may take")
