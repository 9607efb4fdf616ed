import gc
import mmap
import subprocess
import sys
from collections.abc import Iterator

import pytest

from tests.memory import MOST_MB, Peak, Tidying, peak_mb, resident_mb

LARGE_MB = 300.0
ALLOCATES = f"bytearray(int({LARGE_MB}e6))"


def test_the_memory_of_an_ended_child_is_seen() -> None:
    subprocess.run([sys.executable, "-c", ALLOCATES], check=True)
    assert peak_mb() >= LARGE_MB


def test_the_line_tells_what_is_too_much() -> None:
    assert Peak(612.4, "a.py::b").line() == "memory: at most 612 MB in one process, in a.py::b"
    assert Peak(MOST_MB + 1.0, "a").line().endswith("in a, more than the 1000 MB that one may take")


@pytest.fixture
def nobody_else_collects() -> Iterator[None]:
    gc.disable()
    yield
    gc.enable()


class Circle:
    """Memory of its own, no part of what the allocator may have left over from other tests."""

    def __init__(self, size_mb: float) -> None:
        self.held = mmap.mmap(-1, int(size_mb * 1e6))
        self.held.write(b"1" * len(self.held))
        self.itself = self


@pytest.mark.usefixtures("nobody_else_collects")
def test_what_tests_have_left_is_given_back_once_it_is_much() -> None:
    tidying = Tidying(worth_mb=20.0)
    tidying.after_test()
    before_mb = resident_mb()
    Circle(8.0)
    tidying.after_test()
    assert resident_mb() > before_mb + 6.0, "not worth the while"
    Circle(24.0)
    assert resident_mb() > before_mb + 28.0
    tidying.after_test()
    assert resident_mb() < before_mb + 6.0
