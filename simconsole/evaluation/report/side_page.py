"""Two drives side by side, of any length and by anybody: a person and the ROS side on one route, before and after.

Where both have the same route they are shown over their place on it, otherwise over the distance that each drove.
"""

from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, Final

import numpy as np

from simconsole.evaluation.manoeuvres.attempt import Line, Panel
from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.table import Array
from simconsole.evaluation.metrics.thinning import path_thinned
from simconsole.evaluation.metrics.track import Track, track
from simconsole.evaluation.report.figures import panels_picture
from simconsole.evaluation.report.frame import html_page
from simconsole.evaluation.report.paired_page import WHO, Side, pair_table
from simconsole.evaluation.report.tables import table
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import write_atomically
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS

_STEP_M: Final = 2.0
_CM_PER_M: Final = 100.0
_ALIKE: Final = 5.0  # one deviation this many times another gets an axis of its own: each stays readable
_JUMP_M: Final = 20.0  # a place that changes by more between two points is that of another round


def write_side_page(
    path: Path, sides: tuple[Side, Side], facts: tuple[Mapping[str, object], Mapping[str, object]]
) -> dict[str, dict[str, Any]]:
    """Write the page; return the metrics of each drive by its name.

    Args:
        path: the HTML file.
        sides: the two drives, with different names.
        facts: of each, who drove what, when and where.

    Raises:
        RecordingError: a column is missing, or the file cannot be written.
    """
    ways = track(sides[0].drive, sides[0].route), track(sides[1].drive, sides[1].route)
    found = {side.name: metrics(side.drive, side.route, way) for side, way in zip(sides, ways, strict=True)}
    title = " and ".join(side.name for side in sides)
    body = [
        f"<h1>{escape(title)}</h1>",
        '<p class="note">simconsole: two drives side by side; differences are the second less the first.</p>',
        panels_picture("sides", title, _panels(sides, ways)),
        "<h2>Metrics</h2>",
        *(pair_table(found, part) for part in (None, *WHO)),
        "<h2>Drives</h2>",
        _facts_table(sides, facts),
    ]
    try:
        write_atomically(path, html_page(title, body))
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror}") from error
    return found


def _panels(sides: tuple[Side, Side], ways: tuple[Track, Track]) -> tuple[Panel, ...]:
    one_route = _one_route(sides)
    along = "place on the route / m" if one_route else "distance driven / m"
    paths = [side.drive.columns("vehicle.x_m", "vehicle.y_m") for side in sides]
    kept = [path_thinned(x, y, _STEP_M) for x, y in paths]
    places = [way.distance_m for way in ways]
    if one_route:
        places = [side.route.project_all(x, y)[0] for side, (x, y) in zip(sides, paths, strict=True) if side.route]
    wheels = [side.drive.column("vehicle.road_wheel_rad") * DEG_PER_RAD for side in sides]

    def over(title: str, label: str, values: Sequence[Array], shown: Sequence[int] = (0, 1)) -> Panel:
        lines = (Line(sides[at].name, *_broken(places[at][kept[at]], values[at][kept[at]])) for at in shown)
        return Panel(title, along, label, tuple(lines))

    panels = [
        over("Speed", "speed / km/h", [way.speed_mps * KMH_PER_MPS for way in ways]),
        over("Road-wheel angle, left positive", "angle / deg", wheels),
    ]
    if all(len(way.lateral_m) for way in ways):
        beside = [way.lateral_m * _CM_PER_M for way in ways]
        reach = sorted(max(float(np.abs(values).max()), 1.0) for values in beside)
        together = reach[1] < _ALIKE * reach[0]
        titles = (
            ["Lateral deviation, left positive"] if together else [f"Lateral deviation: {one.name}" for one in sides]
        )
        groups = [(0, 1)] if together else [(0,), (1,)]
        panels[:0] = [over(title, "deviation / cm", beside, of) for title, of in zip(titles, groups, strict=True)]
    lines = (Line(side.name, x[at], y[at]) for side, (x, y), at in zip(sides, paths, kept, strict=True))
    return (*panels, Panel("Path", "x / m", "y / m", tuple(lines)))


def _one_route(sides: tuple[Side, Side]) -> bool:
    """Return whether both have the same theoretical path: as long, and equal wherever it is looked at."""
    first, second = sides[0].route, sides[1].route
    if first is None or second is None or first.length_m != second.length_m:
        return False
    places = np.linspace(0.0, first.length_m, 50, endpoint=False).tolist()
    return all((one := first.at(s)).x_m == (other := second.at(s)).x_m and one.y_m == other.y_m for s in places)


def _broken(place: Array, value: Array) -> tuple[Array, Array]:
    """Return a line that is interrupted where a new round begins."""
    cuts = np.flatnonzero(np.abs(np.diff(place)) > _JUMP_M) + 1
    return np.insert(place, cuts, np.nan), np.insert(value, cuts, np.nan)


def _facts_table(sides: tuple[Side, Side], facts: tuple[Mapping[str, object], Mapping[str, object]]) -> str:
    names = dict.fromkeys((*facts[0], *facts[1]))
    rows = ((name, *(str(of.get(name, "-")) for of in facts)) for name in names)
    return table(("of the drive", *(side.name for side in sides)), rows, words=3)
