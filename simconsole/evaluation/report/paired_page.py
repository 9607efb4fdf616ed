"""The paired report: two drives of the same inputs beside each other, and how far they come apart."""

from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.evaluation.manoeuvres.attempt import Line, Panel
from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.evaluation.metrics.thinning import thinned
from simconsole.evaluation.metrics.track import Track, track
from simconsole.evaluation.report.figures import panels_picture
from simconsole.evaluation.report.frame import html_page
from simconsole.evaluation.report.metric_rows import METRICS
from simconsole.evaluation.report.tables import sides_table
from simconsole.recording.differences import FieldDifference
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import write_atomically
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS
from simconsole.world.route import Route

_POINTS: Final = 1600
_FIELDS: Final = 40
"""Fields that are listed; of the others only the number is told."""
WHO: Final = {"autonomous": "What the autopilot drove", "manual": "What the person drove"}


class Side(NamedTuple):
    """One of the two drives."""

    name: str
    drive: Drive
    route: Route | None


def write_paired_report(
    path: Path, title: str, notes: Sequence[str], sides: tuple[Side, Side], differences: Sequence[FieldDifference]
) -> dict[str, dict[str, Any]]:
    """Write the page of two drives of equal length; return the metrics of each by its name.

    Args:
        path: the HTML file.
        title: its heading.
        notes: what a reader must know first, as that the driver is open loop.
        sides: the drive as it was, and as it is with something changed.
        differences: their fields that differ.

    Raises:
        RecordingError: the file cannot be written.
    """
    ways = track(sides[0].drive, sides[0].route), track(sides[1].drive, sides[1].route)
    found = {side.name: metrics(side.drive, side.route, way) for side, way in zip(sides, ways, strict=True)}
    body = [
        f"<h1>{escape(title)}</h1>",
        *(f'<p class="note"><b>{escape(note)}</b></p>' for note in notes),
        panels_picture("pair", title, _panels(sides, ways)),
        "<h2>Metrics</h2>",
        *(pair_table(found, part) for part in (None, "autonomous", "manual")),
        "<h2>Fields that differ</h2>",
        _differences_table(differences),
    ]
    try:
        write_atomically(path, html_page(title, body))
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror}") from error
    return found


def separation_m(first: Drive, second: Drive) -> Array:
    """Return the distance between the vehicles of two drives at each tick that both have, float64 [ticks]."""
    (x, y), (other_x, other_y) = (drive.columns("vehicle.x_m", "vehicle.y_m") for drive in (first, second))
    ticks = min(len(x), len(other_x))
    apart: Array = np.hypot(x[:ticks] - other_x[:ticks], y[:ticks] - other_y[:ticks])
    return apart


def _panels(sides: tuple[Side, Side], ways: tuple[Track, Track]) -> tuple[Panel, ...]:
    wheel = [side.drive.column("vehicle.road_wheel_rad") * DEG_PER_RAD for side in sides]
    accel = [side.drive.column("vehicle.ay_mps2") for side in sides]
    panels = [
        _over_time("Speed", "speed / km/h", sides, [way.speed_mps * KMH_PER_MPS for way in ways]),
        _over_time("Road-wheel angle, left positive", "angle / deg", sides, wheel),
        _over_time("Lateral acceleration", "acceleration / m/s²", sides, accel),
    ]
    if all(len(way.lateral_m) for way in ways):
        lateral = [way.lateral_m for way in ways]
        panels.append(_over_time("Beside the theoretical path", "left of it / m", sides, lateral))
    paths = [side.drive.columns("vehicle.x_m", "vehicle.y_m") for side in sides]
    lines = (Line(side.name, *_thin(x, y)) for side, (x, y) in zip(sides, paths, strict=True))
    panels.append(Panel("Path", "x / m", "y / m", tuple(lines)))
    apart = separation_m(sides[0].drive, sides[1].drive)
    panels.append(Panel("Apart", "time / s", "distance / m", (Line("", *_thin(_times(sides[0], apart), apart)),)))
    return tuple(panels)


def _over_time(title: str, label: str, sides: tuple[Side, Side], values: Sequence[Array]) -> Panel:
    lines = (Line(side.name, *_thin(_times(side, of), of)) for side, of in zip(sides, values, strict=True))
    return Panel(title, "time / s", label, tuple(lines))


def _times(side: Side, values: Array) -> Array:
    times: Array = side.drive.time_s[: len(values)]
    return times


def _thin(x: Array, y: Array) -> tuple[Array, Array]:
    kept = thinned(y, _POINTS)
    return x[kept], y[kept]


def pair_table(found: Mapping[str, Mapping[str, Any]], part: str | None) -> str:
    """Return the table of two whole drives, or of the parts that one side drove; empty where neither has it.

    Args:
        found: metrics of the two, by the name of each.
        part: `autonomous` or `manual`; None: the whole.
    """
    (first, one), (second, other) = ((name, of if part is None else of[part]) for name, of in found.items())
    if one is None or other is None:
        return "" if one is other else f"<p>{WHO[part or '']}: only in one of the two.</p>"
    known = [row for row in METRICS if one.get(row.key) is not None and other.get(row.key) is not None]
    apart = {row.key: other[row.key] - one[row.key] for row in known}
    head = f"<h3>{'The whole drives' if part is None else WHO[part]}</h3>"
    return f"{head}\n{sides_table(known, (first, second, 'difference'), (one, other, apart))}"


def _differences_table(differences: Sequence[FieldDifference]) -> str:
    heads = "".join(f"<th class=n>{name}</th>" for name in ("first at tick", "largest difference", "at tick"))
    lines = [f"<table><tr><th>field</th><th>unit</th>{heads}</tr>"]
    lines += [
        f"<tr><td>{escape(one.field)}</td><td>{escape(one.unit)}</td><td class=n>{one.first_tick}</td>"
        f"<td class=n>{one.largest:.4g}</td><td class=n>{one.largest_tick}</td></tr>"
        for one in differences[:_FIELDS]
    ]
    more = len(differences) - _FIELDS
    return "\n".join((*lines, "</table>", *((f"<p>and {more} more</p>",) if more > 0 else ())))
