"""How much memory a run takes: the largest process, of those that run tests and of those that tests start."""

import resource
from typing import Final, NamedTuple

KEY: Final = "memory_mb"
MOST_MB: Final = 1000.0
"""What one process may take, so that four of them run beside each other on a laptop of 8 GB."""


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
