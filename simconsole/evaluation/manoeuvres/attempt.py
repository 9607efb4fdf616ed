"""One drive of a manoeuvre, and what a manoeuvre yields: the records that drivers, evaluation and report share."""

from collections.abc import Generator, Iterator, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np

from simconsole.drivers.manoeuvre_driver.run_up import Pilot
from simconsole.evaluation.metrics.table import Array, Drive


class Attempt(NamedTuple):
    """One drive from standstill: who drives, for how long at most, and which driver aids are switched off."""

    name: str
    pilot: Pilot | None  # None: the scenario's own script
    longest_s: float
    off: tuple[str, ...] = ()


class Line(NamedTuple):
    """One curve of a plot."""

    label: str
    x: Array
    y: Array


class Panel(NamedTuple):
    """One plot."""

    title: str
    x_label: str
    y_label: str
    lines: tuple[Line, ...]


class Result(NamedTuple):
    """Characteristic values by name, the unit in each, and plots; or why the manoeuvre could not be driven."""

    values: dict[str, float]
    panels: tuple[Panel, ...]
    problem: str | None = None


def undriven(attempt: str, speed_kmh: float) -> Result:
    """Return the result of a car that did not reach the manoeuvre's speed."""
    return Result({}, (), f"{attempt}: the car has not held {speed_kmh:g} km/h, where the manoeuvre begins")


Driving: TypeAlias = Generator[Attempt, Drive, Result]
"""A running manoeuvre: a generator that yields one attempt after the other and is sent the drive of each."""


def traces(title: str, y_label: str, drives: dict[str, tuple[Drive, Array]], every: int = 5) -> Panel:
    """Return a plot over time of one signal of several drives, time from the first tick given, thinned."""
    lines = []
    for label, (drive, values) in drives.items():
        time_s = drive.time_s - drive.time_s[0]
        lines.append(Line(label, np.asarray(time_s[::every]), np.asarray(values[::every])))
    return Panel(title, "time / s", y_label, tuple(lines))


def part(drive: Drive, first: int, last: int | None = None) -> Drive:
    """Return the ticks of a drive from one index to another."""

    def read(names: Sequence[str]) -> Iterator[Array]:
        yield np.column_stack(drive.columns(*names))[first:last]

    return Drive(read, len(range(drive.ticks)[first:last]), drive.tick_hz, drive.first_tick + first)
