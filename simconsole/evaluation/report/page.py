"""The report of a drive: one HTML file that needs nothing else (shell: it writes the file)."""

from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, Final

from simconsole.evaluation.metrics.drive_metrics import metrics, mode_changes
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.evaluation.metrics.track import track
from simconsole.evaluation.report.figure_words import map_words, traces_words
from simconsole.evaluation.report.figures import map_svg, traces_svg
from simconsole.evaluation.report.frame import html_page, picture
from simconsole.evaluation.report.metric_rows import rounded
from simconsole.evaluation.report.tables import (
    advice_table,
    changes_table,
    definitions_list,
    facts_table,
    faults_table,
    latency_table,
    marks_table,
    metrics_table,
    own_table,
    road_table,
    rules_table,
    takeovers_table,
    wheel_table,
)
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import write_atomically
from simconsole.values.units import MPS_PER_KMH
from simconsole.world.route import Route

_FAR_M: Final = 100.0
_WALK_KMH: Final = 3.6
_HEAD: Final = ("started", "participant", "trial", "machine", "simconsole")
"""Facts that stand at the head of the page, where they are known."""


def write_report(
    path: Path,
    drive: Drive,
    route: Route | None,
    title: str,
    extra: Mapping[str, object] | None = None,
    *,
    faults: Sequence[str] = (),
    latency_us: Mapping[str, Mapping[str, float]] | None = None,
    acts: Sequence[Mapping[str, Any]] = (),
    walls: Sequence[Array] | None = None,
) -> dict[str, Any]:
    """Write the report of a drive and return its metrics (metrics/drive_metrics.py).

    Args:
        path: the HTML file.
        drive: the drive.
        route: the theoretical path, None in a world without one.
        title: heading of the page.
        extra: further facts for the page, in order. Nothing that differs between equal drives belongs here, if two
            reports of one drive are to be equal.
        faults: names of the scenario's faults, in their order.
        latency_us: p50, p99, max and count of each hop (LatencyStatistics.summary_us). They differ between equal
            drives, so they are not among the metrics.
        acts: the operator's acts, as the drive's summary has them; their notes stand beside the marks.
        walls: of what a robot drives in, float64 [points, 2 or more] each: x, y in m; None: no robot drives.

    Raises:
        RecordingError: a column is missing, or the file cannot be written.
    """
    way = track(drive, route)
    changes = mode_changes(drive, way)
    found = metrics(drive, route, way, faults, changes)
    traces = traces_svg(drive, way, changes, route, robot=walls is not None)
    figures = (
        picture(map_svg(drive, way, changes, route, walls or ()), "Map of the drive", map_words(found, route)),
        picture(traces, "The drive over its distance", traces_words(found, route)),
    )
    try:
        write_atomically(path, page(title, found, figures, extra or {}, latency_us or {}, acts))
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror}") from error
    return found


def page(
    title: str,
    found: Mapping[str, Any],
    figures: Sequence[str],
    extra: Mapping[str, object],
    latency_us: Mapping[str, Mapping[str, float]],
    acts: Sequence[Mapping[str, Any]] = (),
) -> str:
    """Return the page's HTML; `figures` are HTML, the rest is as `write_report` takes it."""
    tick_hz = round(found["ticks"] / found["duration_s"])
    noted = found["marks"] or any(act.get("note") for act in acts)
    chapters = (
        ("Metrics", metrics_table(found)),
        ("Mode changes", changes_table(found)),
        ("Marks and notes", marks_table(found, acts, tick_hz) if noted else ""),
        ("Take-overs", takeovers_table(found) if found["takeovers"] else ""),
        ("On the road", road_table(found) if found["road"] else ""),
        ("Speed advice", advice_table(found["speed_advice"]) if found["speed_advice"] else ""),
        ("Rules of the road", rules_table(found) if found["rules"] else ""),
        ("Faults", faults_table(found) if found["faults"] else ""),
        ("Own metrics", own_table(found["own"]) if found.get("own") else ""),
        ("Force feedback", wheel_table(found["force_feedback"]) if found["force_feedback"] else ""),
        ("What the figures mean", definitions_list(found)),
        ("Drive", facts_table(extra) if extra else ""),
        ("Latency", latency_table(latency_us) if latency_us else ""),
    )
    parts = [
        f"<h1>{escape(title)}</h1>",
        f'<p class="note">{escape(_origin(extra))}</p>',
        _tiles(found),
        *figures,
        *(f"<h2>{head}</h2>\n{text}" for head, text in chapters if text),
    ]
    return html_page(title, parts)


def _origin(extra: Mapping[str, object]) -> str:
    """Return who drove when, on what, with which version, as far as it is known."""
    known = [f"{name} {extra[name]}" for name in _HEAD if extra.get(name)]
    return "; ".join(("simconsole drive report", *known))


def _driven(distance_m: float) -> str:
    """Return a distance in km, one that is less than 100 m in m."""
    return f"{distance_m / 1000.0:.2f} km" if distance_m >= _FAR_M else f"{rounded(distance_m)} m"


def _speed(speed_kmh: float) -> str:
    """Return a speed in km/h, one that is slower than a walk in m/s."""
    return f"{speed_kmh:.1f} km/h" if speed_kmh >= _WALK_KMH else f"{speed_kmh * MPS_PER_KMH:.2f} m/s"


def _tiles(found: Mapping[str, Any]) -> str:
    part = found["autonomous"] or {}
    shown = [
        (_driven(found["distance_m"]), "driven in all"),
        (f"{found['duration_s']:.0f} s", "duration"),
    ]
    if part:
        shown.append((_driven(part["distance_m"]), "by the autopilot"))
        shown.append((_speed(part["mean_speed_kmh"]), "mean speed of the autopilot"))
    if part.get("lateral_rms_m") is not None:
        shown.append((f"{rounded(part['lateral_rms_m'] * 100.0)} cm", "lateral error of the autopilot, RMS"))
        shown.append((f"{rounded(part['lateral_max_m'] * 100.0)} cm", "its largest"))
    return f"<ul class=tiles>{''.join(f'<li><b>{value}</b><span>{name}</span></li>' for value, name in shown)}</ul>"
