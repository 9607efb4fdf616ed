"""How much memory a run takes: the largest process, of those that run tests and of those that tests start."""

import ctypes
import gc
import os
import resource
import sys
from pathlib import Path
from typing import Final, NamedTuple

KEY: Final = "memory_mb"
LEFT_KEY: Final = "left_mb"
MOST_MB: Final = 1000.0
"""What one process may take, so that four of them run beside each other on a laptop of 8 GB."""
LARGE_MB: Final = 750.0
"""What tests may have left in a process that still gets new files: single tests take up to 200 MB for a while."""


class Peak(NamedTuple):
    """The largest process so far, in MB (1e6 bytes), and the test in which it became so large."""

    memory_mb: float
    test: str

    def line(self) -> str:
        """Return it for the end of a run."""
        over = f", more than the {MOST_MB:.0f} MB that one may take" if self.memory_mb > MOST_MB else ""
        return f"memory: at most {self.memory_mb:.0f} MB in one process, in {self.test}{over}"


def peak_mb() -> float:
    """Return the most memory that this process, or one that it has started and seen end, has had resident, in MB."""
    kib = max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return kib * 1024 / 1e6


class Tidying:
    """What tests have left behind is given back to the system once it may be much: see `after_test`."""

    def __init__(self, worth_mb: float = 40.0) -> None:
        """Do so as often as the process has grown by `worth_mb`: it takes a moment."""
        self.worth_mb = worth_mb
        self.left_mb = 0.0
        """What the tests so far have left, in MB."""
        self._tidy_mb = 0.0

    def after_test(self) -> None:
        """Collect garbage, and give back what the allocator keeps for later.

        What tests held in circles would else stay until the next search of all objects, which comes after thousands of
        tests. Only where the allocator is that of glibc and its memory is known: Linux.
        """
        if sys.platform != "linux":
            return
        self.left_mb = resident_mb()
        if self.left_mb < self._tidy_mb + self.worth_mb:
            return
        gc.collect()
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
        if trim is not None:
            trim(0)
        self.left_mb = self._tidy_mb = resident_mb()


def resident_mb() -> float:
    """Return the memory that this process has resident now, in MB. Linux only."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6
