"""The map of a drive: driven path over theoretical path."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, Final

import numpy as np

from simconsole.evaluation.metrics.drive_metrics import ModeChange
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.evaluation.metrics.thinning import path_thinned
from simconsole.evaluation.metrics.track import JUMP_M, Track
from simconsole.evaluation.report.colours import END, LIMIT, MODES, NOTE, PERSON, REMOTE, START, THEORY
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from simconsole.world.route import Route

_STEP_M: Final = 1.0
_ARENA_STEP_M: Final = 0.05  # between points of a way among walls
_LABEL_M: Final = 26.0  # how far beside the road a label stands
_NOTED: Final[dict[str, Any]] = {"textcoords": "offset points", "color": NOTE, "fontsize": 7.5}


def draw_map(
    figure: Any,
    drive: Drive,
    way: Track,
    changes: list[ModeChange],
    route: Route | None,
    walls: Sequence[Array] = (),
) -> None:
    """Draw the map into a matplotlib figure, with the walls of an arena, float64 [points, 2 or more] each, in m."""
    axes = figure.add_subplot()
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title("Driven path" if route is None else "Driven path against theoretical path")
    axes.set_xlabel("x in map / m")
    axes.set_ylabel("y in map / m")
    if route is not None:
        path = route.offset(0.0, 0.0, route.length_m, _STEP_M)
        axes.plot(*path.T, color=THEORY, linewidth=6.0, solid_capstyle="round", label="theoretical path")
        _label_landmarks(axes, route)
    for number, wall in enumerate(walls):
        axes.plot(wall[:, 0], wall[:, 1], color=NOTE, linewidth=1.4, label=None if number else "walls", zorder=3)
    x, y = drive.columns("vehicle.x_m", "vehicle.y_m")
    _draw_driven(axes, x, y, way, _ARENA_STEP_M if walls else _STEP_M)
    _draw_changes(axes, changes)
    edge = {"markeredgecolor": "white", "markeredgewidth": 1.2, "linestyle": "none", "zorder": 6}
    axes.plot(x[0], y[0], "o", color=START, markersize=10, label="start", **edge)
    axes.plot(x[-1], y[-1], "o", color=END, markersize=10, label="end", **edge)
    axes.margins(0.08)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=6)


def _draw_driven(axes: Any, x: Array, y: Array, way: Track, step_m: float) -> None:
    autonomous = way.autonomous
    jumps = np.hypot(np.diff(x), np.diff(y)) > JUMP_M
    cuts = np.flatnonzero((autonomous[1:] != autonomous[:-1]) | jumps) + 1
    named: set[str] = set()
    for start, end in pairwise((0, *cuts.tolist(), len(x))):
        remote = autonomous[start]
        # One point of overlap closes the gap between two parts, unless the vehicle was put elsewhere.
        last = end + 1 if end < len(x) and not jumps[end - 1] else end
        kept = start + path_thinned(x[start:last], y[start:last], step_m)
        label = "driven by the autopilot" if remote else "driven by the person"
        axes.plot(
            x[kept],
            y[kept],
            color=REMOTE if remote else PERSON,
            linewidth=1.6,
            label=None if label in named else label,
            zorder=4,
        )
        named.add(label)


def _draw_changes(axes: Any, changes: list[ModeChange]) -> None:
    named = False
    for change in changes[1:]:
        if change.refused or change.mode in (Mode.PARKED, Mode.STOPPED):
            continue
        axes.plot(
            change.x_m,
            change.y_m,
            marker="D",
            markersize=6,
            color=MODES.get(change.mode, NOTE),
            markeredgecolor="white",
            linestyle="none",
            label=None if named else "mode change",
            zorder=5,
        )
        named = True
        axes.annotate(
            mode_label(change.mode),
            (change.x_m, change.y_m),
            xytext=(0, 9 if change.mode == Mode.AUTONOMOUS else -15),
            ha="center",
            textcoords="offset points",
            fontsize=7.5,
            color=MODES.get(change.mode, NOTE),
        )


def _label_landmarks(axes: Any, route: Route) -> None:
    for mark in route.landmarks:
        if mark.across:
            crossing = mark.kind == "crossing"
            width, order, colour = (2.4, 3, LIMIT) if crossing else (3.0, 1, THEORY)
            axes.plot(*np.array(mark.across).T, color=colour, linewidth=width, solid_capstyle="butt", zorder=order)
        if mark.kind == "crossing":
            _label(axes, route, mark.s_m, mark.kind)
        elif mark.kind == "roundabout":
            axes.annotate(mark.kind, (mark.x_m, mark.y_m), xytext=(16, 12), **_NOTED)
        else:
            _label_junction(axes, route, mark.s_m, mark.kind)


def _label(axes: Any, route: Route, s_m: float, text: str) -> None:
    point = route.at(s_m)
    upright = abs(np.sin(point.yaw_rad)) > 0.5
    x, y = route.offset(_LABEL_M * (0.6 if upright else 0.8), s_m, s_m + 0.1)[0].tolist()
    left = np.sin(point.yaw_rad) > 0.0
    side = ("right" if left else "left") if upright else "center"
    axes.annotate(text, (x, y), ha=side, va="center", color=NOTE, fontsize=7.5)


def _label_junction(axes: Any, route: Route, s_m: float, text: str) -> None:
    """Write beside the crossing road, on the left of the route."""
    point = route.at(s_m)
    east, north = np.cos(point.yaw_rad) > 0.5, np.sin(point.yaw_rad) > 0.5
    x, y = route.offset(_LABEL_M, s_m + 5.0, s_m + 5.1)[0].tolist()
    axes.annotate(text, (x, y), ha="left" if east or north else "right", va="center", color=NOTE, fontsize=7.5)
