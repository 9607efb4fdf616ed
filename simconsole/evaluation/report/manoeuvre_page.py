"""The report of test manoeuvres: one HTML file that needs nothing else (shell: it writes the file)."""

from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Final, NamedTuple

from simconsole.evaluation.manoeuvres.attempt import Result
from simconsole.evaluation.report.figures import panels_picture
from simconsole.evaluation.report.frame import html_page
from simconsole.profiles.manoeuvre import Limit
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import write_atomically

_GOOD: Final = "inside its limits"
_BAD: Final = "NOT inside its limits"


class Chapter(NamedTuple):
    """One manoeuvre of a report."""

    name: str
    title: str
    result: Result
    limits: tuple[Limit, ...]
    problems: tuple[str, ...]


def write_handling_report(path: Path, chapters: Sequence[Chapter]) -> None:
    """Write the report of these manoeuvres.

    Raises:
        RecordingError: the file cannot be written.
    """
    parts = ["<h1>Test manoeuvres</h1>", *map(_chapter, chapters)]
    text = html_page("Test manoeuvres", parts)
    try:
        write_atomically(path, text)
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror}") from error


def _chapter(chapter: Chapter) -> str:
    limits = {limit.value: limit for limit in chapter.limits}
    lines = ["<table><tr><th>characteristic value</th><th class=n>driven</th><th class=n>limits</th></tr>"]
    for name, value in chapter.result.values.items():
        bounds = limits.get(name)
        lines.append(
            f"<tr><td>{escape(name)}</td><td class=n>{value:.4g}</td>"
            f"<td class=n>{'' if bounds is None else escape(_between(bounds))}</td></tr>"
        )
    verdict = _BAD if chapter.problems else _GOOD
    notes = "".join(f"<p>{escape(problem)}</p>" for problem in chapter.problems)
    panels = chapter.result.panels
    figure = panels_picture(chapter.name, chapter.title, panels) if panels else ""
    return (
        f"<h2>{escape(chapter.title)}</h2>\n<p class=note>{escape(chapter.name)}: {verdict}</p>{notes}\n"
        + "\n".join((*lines, "</table>"))
        + f"\n{figure}"
    )


def _between(limit: Limit) -> str:
    if limit.min is None:
        return f"at most {limit.max:g}"
    return f"at least {limit.min:g}" if limit.max is None else f"{limit.min:g} to {limit.max:g}"
