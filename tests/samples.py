"""How large a random or long check is, which seed it draws from, and where it keeps what it saw.

`make test` runs a sample of each with a fixed seed; `make long` the full size with a seed drawn anew. Both print it,
and `pytest --seed N` draws from it again.
"""

import secrets
import zlib
from collections.abc import Callable
from typing import NamedTuple, Protocol

import pytest


class Sample(NamedTuple):
    """Size and seed of one check."""

    long: bool
    seed: int

    def of(self, short: int, full: int) -> int:
        """Return the size: `short` in `make test`, `full` in `make long`."""
        return full if self.long else short


class Measured(Protocol):
    """Keeps one figure of a case of the fault catalogue."""

    def __call__(self, case: str, what: str, seen: str, bar: str) -> None:
        """Keep that of `case` (an id) `what` was `seen`, where `bar` is what is promised; all for a reader."""


@pytest.fixture
def sample(request: pytest.FixtureRequest, record_property: Callable[[str, object], None]) -> Sample:
    """Say how large this check is and which seed it draws from."""
    given = request.config.getoption("--seed")
    long = bool(request.config.getoption("--long"))
    seed = given if given is not None else secrets.randbits(31) if long else zlib.crc32(request.node.name.encode())
    print(f"seed {seed}")
    record_property("seed", str(seed))
    return Sample(long, seed)


@pytest.fixture
def measured(record_property: Callable[[str, object], None]) -> Measured:
    """Keep a figure for docs/faults.md."""

    def keep(case: str, what: str, seen: str, bar: str) -> None:
        record_property("fault", f"{case} | {what} | {seen} | {bar}")

    return keep
