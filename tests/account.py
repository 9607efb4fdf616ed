"""What a run that broke off has not run, and why: for its last lines, often all that is kept of a run elsewhere."""

from collections.abc import Sequence
from typing import Final

_ERROR_LINES: Final = 8
_TESTS: Final = 8


class Account:
    """The tests of a run, those of which there was an outcome, and the first error of the processes that ran them."""

    def __init__(self) -> None:
        """Begin with none."""
        self.tests: Sequence[str] = ()
        self.ended: set[str] = set()
        self.error = ""

    def lines(self) -> list[str]:
        """Return the end of the error, and the first tests that were not run: one of them met it."""
        said = [line for line in self.error.splitlines() if line.strip()]
        left = [test for test in self.tests if test not in self.ended]
        return [*said[-_ERROR_LINES:], f"{len(left)} tests were not run:", *left[:_TESTS]]
