"""docs/long-run.md: what the last run of `make long` did, from its reports."""

import datetime
import os
import platform
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final, NamedTuple

PAGE: Final = Path(__file__).parents[1] / "docs" / "long-run.md"
HEAD: Final = "| check | seen | took | outcome |\n|---|---|---|---|\n"
_INTRODUCTION: Final = """# The long run

Written by one run of `make long`: the random and long checks of `make test` at their full size, with seeds drawn anew.
`pytest --long --seed {seed}` draws the same again, of one check as well: `pytest --long --seed {seed} FILE::TEST`.

{date}, Python {python}, {machine}, {cores} cores, two checks at a time. Seed {seed}: {passed} passed, {failed} failed.

"""


class Check(NamedTuple):
    """One check of a run."""

    name: str  # pytest's node id
    figures: Sequence[str]
    took_s: float
    passed: bool


def page(checks: Iterable[Check], seed: int, date: datetime.date) -> str:
    """Return the page of a run."""
    rows = sorted(checks)
    passed = sum(check.passed for check in rows)
    introduction = _INTRODUCTION.format(
        seed=seed,
        date=date.isoformat(),
        python=platform.python_version(),
        machine=f"{platform.system()} {platform.machine()}",
        cores=os.cpu_count(),
        passed=passed,
        failed=len(rows) - passed,
    )
    return introduction + HEAD + "".join(map(_row, rows))


def figure(name: str, value: object) -> str | None:
    """Return a property that a test recorded as the page tells it; None for one that is no figure."""
    if name == "case":
        return None
    text = " ".join(str(value).split())
    if name == "fault":
        case, what, seen, bar = (part.strip() for part in f"{text} ".split(" | "))
        return f"{case} {what}: {seen}" + (f" ({bar})" if bar else "")
    return f"{name}: {text}"


def _row(check: Check) -> str:
    took = f"{check.took_s:.0f} s" if check.took_s < 120.0 else f"{check.took_s / 60.0:.0f} min"
    outcome = "passed" if check.passed else "FAILED"
    return f"| {check.name.replace('|', '/')} | {'<br>'.join(check.figures) or '-'} | {took} | {outcome} |\n"
