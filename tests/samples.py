"""How large a random or long check is, which seed it draws from, and where it keeps what it saw.

`make test` runs a sample of each with seeds that stay; `make long` the full size with seeds drawn anew. The run's seed
stands in its last lines and before the output of each test; `pytest --seed N` draws the same again.
"""

import secrets
import zlib
from collections.abc import Callable
from typing import Final, NamedTuple, Protocol

import pytest

SAMPLED: Final = ("sample", "module_sample")
"""A test with one of these fixtures has a full size, and runs in `make long`."""


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


def draw_seed(config: pytest.Config) -> None:
    """Settle the seed of the whole run before it is handed to other processes: what was given, else drawn or 0."""
    if config.option.seed is None:
        config.option.seed = secrets.randbits(31) if config.option.long else 0


def sample_of(config: pytest.Config, name: str) -> Sample:
    """Return size and seed of the check `name`; each check of a run has a seed of its own."""
    print(f"seed {config.option.seed}")
    return Sample(config.option.long, zlib.crc32(name.encode()) ^ config.option.seed)


@pytest.fixture
def sample(request: pytest.FixtureRequest) -> Sample:
    """Say how large this check is and which seed it draws from."""
    return sample_of(request.config, request.node.name)


@pytest.fixture(scope="module")
def module_sample(request: pytest.FixtureRequest) -> Sample:
    """Say the same of what all checks of a module share."""
    return sample_of(request.config, request.node.name)


@pytest.fixture
def measured(record_property: Callable[[str, object], None]) -> Measured:
    """Keep a figure for docs/faults.md."""

    def keep(case: str, what: str, seen: str, bar: str) -> None:
        record_property("fault", f"{case} | {what} | {seen} | {bar}")

    return keep
