"""The page of a golden review: accepted and driven over each other, where they differ."""

from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Final

from simconsole.evaluation.checks.review import ColumnReview, Review
from simconsole.evaluation.manoeuvres.attempt import Line, Panel
from simconsole.evaluation.report.figures import panels_picture
from simconsole.evaluation.report.frame import html_page
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import write_atomically

PLOTS: Final = 12
"""Columns of a scenario that are plotted, those first that differ first; the table names all."""


def write_review(path: Path, reviews: Sequence[Review], equal: Sequence[str], alike: Sequence[str] = ()) -> None:
    """Write the page.

    Args:
        path: the HTML file.
        reviews: of the scenarios that differ.
        equal: names of those that are equal to the bit.
        alike: names of those that are within their tolerances.

    Raises:
        RecordingError: the file cannot be written.
    """
    same = escape(", ".join(equal)) or "none"
    parts = [
        "<h1>Golden review</h1>",
        '<p class="note">Accepted is what stands in the goldens, driven is what this version drives. Nothing is '
        "changed by this page; <code>simconsole check --update-golden</code> accepts what is driven.</p>",
        f"<p>Equal to the bit: {same}.</p>",
        *((f"<p>Not equal, within their tolerances: {escape(', '.join(alike))}.</p>",) if alike else ()),
        *map(_chapter, reviews),
    ]
    try:
        write_atomically(path, html_page("Golden review", parts))
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror}") from error


def _chapter(review: Review) -> str:
    remarks = "".join(f"<p>{escape(remark)}</p>" for remark in review.remarks)
    head = f"<h2>{escape(review.scenario)}: {escape(review.title)}</h2>\n{remarks}"
    if not review.columns:
        return f"{head}<p>No sampled value differs.</p>" if not review.remarks else head
    panels = tuple(map(_panel, review.columns[:PLOTS]))
    return f"{head}\n{panels_picture(review.scenario, review.title, panels)}\n{_table(review.columns)}"


def _panel(review: ColumnReview) -> Panel:
    lines = (
        Line("accepted", review.time_s, review.accepted),
        Line("driven", review.time_s, review.driven),
    )
    return Panel(review.column, "time / s", review.unit, lines)


def _table(columns: Sequence[ColumnReview]) -> str:
    heads = "".join(f"<th class=n>{name}</th>" for name in ("first at", "largest difference", "at"))
    rows = [
        f"<tr><td>{escape(one.column)}</td><td>{escape(one.unit)}</td><td class=n>{one.first_s:.3f} s</td>"
        f"<td class=n>{one.largest:.4g}</td><td class=n>{one.largest_s:.3f} s</td></tr>"
        for one in columns
    ]
    return "\n".join((f"<table><tr><th>column</th><th>unit</th>{heads}</tr>", *rows, "</table>"))
