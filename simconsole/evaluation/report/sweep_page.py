"""The page of a sweep: how it ended, how each metric is distributed, and which drives are the worst cases."""

from collections.abc import Callable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from simconsole.evaluation.metrics.table import Array
from simconsole.evaluation.report.frame import html_page
from simconsole.evaluation.sweep.plan import Plan
from simconsole.evaluation.sweep.results import metric_names
from simconsole.evaluation.sweep.task import GOOD, Task, TaskResult
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import write_atomically

CURVE: Final = 120, 28
"""Width and height of a distribution in its row, in units of its drawing; it has no more steps than it is wide."""
LOST: Final = 20
"""Drives that did not end well that are listed; of the others only the number is told."""


class Distribution(NamedTuple):
    """The values of one metric over a sweep."""

    name: str
    indices: list[int]  # of the drives that have it
    values: Array  # in the same order

    @property
    def largest(self) -> int:
        """The index of the drive with the largest value."""
        return self.indices[int(self.values.argmax())]

    @property
    def smallest(self) -> int:
        """The index of the drive with the smallest value."""
        return self.indices[int(self.values.argmin())]


def distributions(results: Mapping[int, TaskResult]) -> list[Distribution]:
    """Return the metrics that vary between the drives of a sweep, by name."""
    found = []
    ordered = [results[index] for index in sorted(results)]
    for name in metric_names(ordered):
        having = [result for result in ordered if name in result.metrics]
        values = np.array([result.metrics[name] for result in having])
        if np.ptp(values) > 0.0:
            found.append(Distribution(name, [result.index for result in having], values))
    return found


def write_sweep_page(path: Path, plan: Plan, results: Mapping[int, TaskResult], again: Callable[[int], str]) -> None:
    """Write the page.

    Args:
        path: the HTML file.
        plan: what was driven.
        results: by index.
        again: returns the command that drives one of them again into a bundle and replays that, by its index.

    Raises:
        RecordingError: the file cannot be written.
    """
    found = distributions(results)
    lost = [results[index] for index in sorted(results) if results[index].outcome not in GOOD]
    parts = [
        f"<h1>{escape(plan.title)}</h1>",
        f'<p class="note">{len(results)} of {len(plan.tasks)} drives; '
        f"varied: {escape(', '.join(plan.keys)) or '-'}.</p>",
        _outcomes(results),
    ]
    if lost:
        parts += ["<h2>Drives that did not end well</h2>", _lost(plan, lost, again)]
    if found:
        parts += [
            "<h2>Distributions</h2>",
            '<p class="note">The curve: from least to most, the share of drives that have at most that value.</p>',
            _table(plan, found),
            "<h2>Least and most again</h2>",
            _commands(plan, found, again),
        ]
    try:
        write_atomically(path, html_page(plan.title, parts))
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror}") from error


def _outcomes(results: Mapping[int, TaskResult]) -> str:
    outcomes = [result.outcome for result in results.values()]
    tiles = (f"<li><b>{outcomes.count(one)}</b><span>{one}</span></li>" for one in sorted(set(outcomes)))
    return f'<ul class="tiles">{"".join(tiles)}</ul>'


def _lost(plan: Plan, lost: Sequence[TaskResult], again: Callable[[int], str]) -> str:
    rows = [
        f"<tr><td class=n>{one.index}</td><td>{escape(_case(plan.tasks[one.index]))}</td><td>{one.outcome}</td>"
        f"<td>{escape(one.detail)}</td><td><code>{escape(again(one.index))}</code></td></tr>"
        for one in lost[:LOST]
    ]
    more = len(lost) - LOST
    head = "<table><tr><th class=n>drive</th><th>of</th><th>ended</th><th>why</th><th>again</th></tr>"
    return "\n".join((head, *rows, "</table>", *((f"<p>and {more} more</p>",) if more > 0 else ())))


def _curve(one: Distribution) -> str:
    """Return the share of drives that have at most a value, over the values, as a drawing that fits in a row."""
    (wide, high), count = CURVE, len(one.values)
    steps = min(count, wide)
    upto = np.array([-(-step * count // steps) for step in range(1, steps + 1)])  # so many of the drives each
    x = (np.sort(one.values)[upto - 1] - one.values.min()) / np.ptp(one.values) * wide
    y = high * (1.0 - upto / count)
    way = "".join(f"H{along:.1f}V{up:.1f}" for along, up in zip(x, y, strict=True))
    drawn = f'<path d="M0 {high}{way}" fill="none" stroke="#1a73e8" stroke-width="1.5"/>'
    name = escape(f"distribution of {one.name}", quote=True)
    return f'<svg role="img" aria-label="{name}" viewBox="-1 -1 {wide + 2} {high + 2}">{drawn}</svg>'


def _table(plan: Plan, found: Sequence[Distribution]) -> str:
    heads = "".join(f"<th class=n>{name}</th>" for name in ("least", "drive", "median", "95 %", "most", "drive"))
    heads += "<th>distribution</th>"
    rows = []
    for one in found:
        median, high = np.percentile(one.values, (50.0, 95.0))
        least, most = plan.tasks[one.smallest], plan.tasks[one.largest]
        rows.append(
            f"<tr><td>{escape(one.name)}</td><td class=n>{one.values.min():.4g}</td>{_which(least)}"
            f"<td class=n>{median:.4g}</td><td class=n>{high:.4g}</td><td class=n>{one.values.max():.4g}</td>"
            f"{_which(most)}<td>{_curve(one)}</td></tr>"
        )
    return "\n".join((f"<table><tr><th>metric</th>{heads}</tr>", *rows, "</table>"))


def _commands(plan: Plan, found: Sequence[Distribution], again: Callable[[int], str]) -> str:
    """Return the drives that are the least or the most of a metric, each with the command that drives it again."""
    rows: dict[int, list[str]] = {}
    for one in found:
        rows.setdefault(one.smallest, []).append(f"least {one.name}")
        rows.setdefault(one.largest, []).append(f"most {one.name}")
    lines = (
        f"<tr><td class=n>{index}</td><td>{escape(_case(plan.tasks[index]))}</td><td>{escape(', '.join(rows[index]))}"
        f"</td><td><code>{escape(again(index))}</code></td></tr>"
        for index in sorted(rows)
    )
    head = "<table><tr><th class=n>drive</th><th>of</th><th>is</th><th>again, into a bundle, and replayed</th></tr>"
    return "\n".join((head, *lines, "</table>"))


def _which(task: Task) -> str:
    return f'<td class=n title="{escape(_case(task), quote=True)}">{task.index}</td>'


def _case(task: Task) -> str:
    """Return what a drive was, as people read it."""
    return ", ".join((task.source, *(f"{key} {value}" for key, value in task.values.items())))
