"""What a scenario drives now beside its golden: every column that differs, for a person who decides about it."""

from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from simconsole.evaluation.checks import golden
from simconsole.evaluation.checks.scenario_check import drive_scenario
from simconsole.evaluation.metrics.table import Array
from simconsole.session.resolution import load_scenario
from simconsole.tick.advance import Console
from simconsole.values.kernels import Row
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import unit_of

MISSING: Final = "no golden: nothing was accepted so far"


class ColumnReview(NamedTuple):
    """A column that differs, at the samples that both have."""

    column: str
    unit: str
    time_s: Array
    accepted: Array
    driven: Array
    first_s: float
    largest: float  # absolute difference; inf where one of the two is no number
    largest_s: float


class Review(NamedTuple):
    """One scenario: where its drive leaves its golden."""

    scenario: str
    title: str
    remarks: tuple[str, ...]  # what no plot shows: ticks and columns that only one of the two has
    columns: tuple[ColumnReview, ...]  # by the time of their first difference


def review_scenario(name_or_path: str) -> Review:
    """Drive a scenario that has a golden and compare every sample of every column.

    Raises:
        ProfileError: scenario or golden cannot be read.
    """
    scenario, path = load_scenario(name_or_path)
    accepted = path.parent / "golden" / f"{path.stem}.csv"
    kept = drive_scenario(scenario, lambda console: Samples(console, scenario.golden_hz))
    if not accepted.is_file():
        return Review(path.stem, scenario.title, (MISSING,), ())
    return _compared(path.stem, scenario.title, accepted, kept)


class Samples:
    """A recorder that keeps the ticks which a golden holds."""

    def __init__(self, console: Console, rate_hz: int) -> None:
        self.columns, self.tick_hz = console.columns, console.tick_hz
        self.rows: dict[int, Row] = {}
        self._step_ticks = golden.step_ticks(console.tick_hz, rate_hz)

    def write(self, snapshot: Snapshot) -> int:
        """Look at one tick."""
        if snapshot.tick % self._step_ticks == 0:
            self.rows[snapshot.tick] = snapshot.vector.copy()
        return 0

    def write_block(self, tick: int, vectors: Row) -> tuple[int, int]:
        """Look at the ticks from `tick` on, all of them."""
        for at in range(-tick % self._step_ticks, len(vectors), self._step_ticks):
            self.rows[tick + at] = vectors[at].copy()
        return len(vectors), 0


def _compared(name: str, title: str, path: Path, driven: Samples) -> Review:
    with path.open(encoding="utf-8", newline="") as file:
        accepted = golden.Golden(file, str(path))
        rows = dict(accepted)
    ticks = [tick for tick in rows if tick in driven.rows]
    old = np.array([rows[tick] for tick in ticks]).reshape(len(ticks), len(accepted.columns))
    new = np.array([driven.rows[tick] for tick in ticks]).reshape(len(ticks), len(driven.columns))
    time_s = np.array(ticks) / driven.tick_hz
    places = {column: at for at, column in enumerate(driven.columns)}
    found = [
        review
        for at, column in enumerate(accepted.columns)
        if column in places
        if (review := _column(column, time_s, old[:, at], new[:, places[column]])) is not None
    ]
    remarks = _remarks(accepted.columns, driven.columns, len(rows) - len(ticks), len(driven.rows) - len(ticks))
    return Review(name, title, remarks, tuple(sorted(found, key=lambda column: column.first_s)))


def _column(column: str, time_s: Array, old: Array, new: Array) -> ColumnReview | None:
    """Return how a column differs, None where every bit is equal."""
    differs = np.flatnonzero(old.view(np.int64) != new.view(np.int64))
    if not len(differs):
        return None
    apart = np.abs(new - old)
    apart[~np.isfinite(apart)] = np.inf
    apart[old.view(np.int64) == new.view(np.int64)] = 0.0
    worst = int(apart.argmax())
    return ColumnReview(
        column=column,
        unit=unit_of(column),
        time_s=time_s,
        accepted=old,
        driven=new,
        first_s=float(time_s[differs[0]]),
        largest=float(apart[worst]),
        largest_s=float(time_s[worst]),
    )


def _remarks(old: tuple[str, ...], new: tuple[str, ...], missing: int, more: int) -> tuple[str, ...]:
    said = (
        (missing, f"{missing} accepted samples were not driven"),
        (more, f"{more} samples were driven beyond the accepted ones"),
        (len({*old} - {*new}), f"accepted columns that are gone: {', '.join(name for name in old if name not in new)}"),
        (len({*new} - {*old}), f"columns that are new: {', '.join(name for name in new if name not in old)}"),
    )
    return tuple(text for count, text in said if count)
