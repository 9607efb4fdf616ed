"""docs/long-run.md: what the long checks saw when they last ran whole, from the reports of `make long`."""

import datetime
import os
import platform
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from tests.paths import ROOT

PAGE: Final = ROOT / "docs" / "long-run.md"
HEAD: Final = "| check | seen | took | machine | day | seed | outcome |\n|---|---|---|---|---|---|---|\n"
INTRODUCTION: Final = """# The long run

Written by `make long`: the random and long checks of `make test` at their full size, with seeds drawn anew. A run of
some of them renews their rows. `pytest --long --seed N FILE::TEST` draws again what a row's seed drew.

"""


class Check(NamedTuple):
    """One check of a run."""

    name: str  # pytest's node id
    figures: Sequence[str]
    took_s: float
    passed: bool


def rows(checks: Iterable[Check], seed: int, day: datetime.date) -> dict[str, str]:
    """Return the rows of a run, by check."""
    machine = f"{os.cpu_count()} cores, Python {platform.python_version()}"
    return {
        _cell(check.name): f"| {_cell(check.name)} | {'<br>'.join(map(_cell, check.figures)) or '-'} "
        f"| {_time(check.took_s)} | {machine} | {day.isoformat()} | {seed} "
        f"| {'passed' if check.passed else 'FAILED'} |\n"
        for check in checks
    }


def rows_of(page: str) -> dict[str, str]:
    """Return the rows of a page, by check."""
    _, _, body = page.partition(HEAD)
    return {line.split(" | ")[0].removeprefix("| "): line for line in body.splitlines(keepends=True)}


def page(found: Mapping[str, str]) -> str:
    """Return the page of these rows."""
    return INTRODUCTION + HEAD + "".join(found[name] for name in sorted(found))


def write(checks: Iterable[Check], seed: int, day: datetime.date) -> None:
    """Renew the rows of what ran; rows of tests that are no more are left out."""
    before = rows_of(PAGE.read_text("utf-8")) if PAGE.exists() else {}
    found = {**before, **rows(checks, seed, day)}
    root = PAGE.parents[1]
    PAGE.write_text(page({name: row for name, row in found.items() if is_there(name, root)}), "utf-8")


def is_there(name: str, root: Path) -> bool:
    """Return whether the test of a row still stands in its file."""
    path, _, rest = name.partition("::")
    return (root / path).is_file() and f"def {rest.partition('[')[0]}(" in (root / path).read_text("utf-8")


def figure(name: str, value: object) -> str | None:
    """Return a property that a test recorded as the page tells it; None for one that is no figure."""
    if name == "case":
        return None
    text = " ".join(str(value).split())
    if name == "fault":
        case, what, seen, bar = (part.strip() for part in f"{text} ".split(" | "))
        return f"{case} {what}: {seen}" + (f" ({bar})" if bar else "")
    return f"{name}: {text}"


def _cell(text: str) -> str:
    return text.replace("|", "/")


def _time(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 120.0 else f"{seconds / 60.0:.0f} min"
