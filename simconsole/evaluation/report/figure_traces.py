"""A drive over its distance: lateral deviation, speed, steering, mode."""

from typing import Any, Final

import numpy as np

from simconsole.evaluation.metrics.drive_metrics import ModeChange, lateral_errors
from simconsole.evaluation.metrics.table import Array, Drive, runs
from simconsole.evaluation.metrics.thinning import thinned
from simconsole.evaluation.metrics.track import Track
from simconsole.evaluation.report.colours import BAND, END, LIMIT, MODES, NOTE, PERSON, REMOTE
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS
from simconsole.world.route import Route

_POINTS: Final = 1600
_CM_PER_M: Final = 100.0
_ROOM: Final = 1.35  # upper end of the deviation's axis over its largest value
_NARROW: Final = 0.05  # share of the drive below which the mode's label does not fit


def draw_traces(figure: Any, drive: Drive, way: Track, changes: list[ModeChange], route: Route | None) -> None:
    """Draw the panels into a matplotlib figure, one distance axis for all."""
    lateral, speed, wheel, modes = figure.subplots(
        4, 1, sharex=True, gridspec_kw={"height_ratios": (3.0, 2.6, 2.2, 0.55), "hspace": 0.04}
    )
    _draw_lateral(lateral, way, route)
    _draw_speed(speed, way, route)
    _draw_steering(wheel, drive, way)
    _draw_modes(modes, way)
    for axes in (lateral, speed, wheel):
        _draw_changes(axes, changes)
    modes.set_xlabel("distance driven / m")
    modes.set_xlim(0.0, max(float(way.distance_m[-1]), 1.0))


def _draw_lateral(axes: Any, way: Track, route: Route | None) -> None:
    axes.set_title("Lateral deviation of base_link from the theoretical path, left positive")
    axes.set_ylabel("deviation / cm")
    if route is None:
        axes.text(0.5, 0.5, "no course in this world", transform=axes.transAxes, ha="center", color=NOTE)
        return
    errors = lateral_errors(way)
    if errors is None:
        _line(axes, way.distance_m, way.lateral_m * _CM_PER_M, PERSON, "person")
        axes.legend(loc="upper right")
        return
    driven, deviation = way.autonomous, way.lateral_m * _CM_PER_M
    rms, worst, at = errors.rms_m * _CM_PER_M, errors.max_m * _CM_PER_M, errors.max_at
    axes.axhspan(-rms, rms, color=BAND, zorder=0, label=f"RMS {rms:.2f} cm")
    _line(axes, way.distance_m, np.where(driven, np.nan, deviation), PERSON, "person", linewidth=0.9)
    _line(axes, way.distance_m, np.where(driven, deviation, np.nan), REMOTE, "autopilot")
    axes.plot(way.distance_m[at], deviation[at], "o", color=END, markersize=5, label=f"max {worst:.2f} cm")
    axes.set_ylim(-_ROOM * max(worst, 0.1), _ROOM * max(worst, 0.1))
    axes.legend(loc="upper center", ncols=4)


def _draw_speed(axes: Any, way: Track, route: Route | None) -> None:
    axes.set_title("Speed")
    axes.set_ylabel("speed / km/h")
    _line(axes, way.distance_m, way.speed_mps * KMH_PER_MPS, REMOTE, "driven")
    if route is not None:
        limit = way.limit_mps * KMH_PER_MPS
        steps = np.flatnonzero(np.diff(limit))
        shown = np.unique(np.concatenate(((0, len(limit) - 1), steps, steps + 1)))
        label = "limit" if len(steps) else f"limit {limit[0]:.0f} km/h"
        axes.plot(way.distance_m[shown], limit[shown], color=LIMIT, linestyle=(0, (5, 3)), linewidth=1.1, label=label)
        axes.legend(loc="lower right", ncols=2)
    axes.set_ylim(0.0, max(1.15 * float(axes.get_ylim()[1]), 1.0))


def _draw_steering(axes: Any, drive: Drive, way: Track) -> None:
    axes.set_title("Road-wheel angle, left positive")
    axes.set_ylabel("angle / deg")
    _line(axes, way.distance_m, drive.column("vehicle.road_wheel_rad") * DEG_PER_RAD, REMOTE, None)


def _draw_modes(axes: Any, way: Track) -> None:
    axes.set_yticks([])
    axes.set_ylabel("mode", rotation=0, ha="right", va="center")
    axes.grid(visible=False)
    axes.spines["left"].set_visible(False)
    whole = max(float(way.distance_m[-1]), 1.0)
    for start, end, value in zip(*runs([way.mode]), strict=True):
        left, right = float(way.distance_m[start]), float(way.distance_m[min(end, len(way.mode) - 1)])
        kind = int(value)
        axes.barh(0.5, right - left, left=left, height=1.0, color=MODES.get(kind, NOTE), linewidth=0.0)
        if right - left > _NARROW * whole:
            text = mode_label(kind)
            axes.text((left + right) / 2, 0.5, text, ha="center", va="center", color="white", fontsize=7.5)
    axes.set_ylim(0.0, 1.0)


def _draw_changes(axes: Any, changes: list[ModeChange]) -> None:
    """Mark where the controller got the car and where it lost it."""
    before = None
    for change in changes:
        if change.refused:
            continue
        if Mode.AUTONOMOUS in (before, change.mode) and before is not None:
            axes.axvline(change.distance_m, color=MODES.get(change.mode, NOTE), linewidth=1.0, linestyle=(0, (2, 2)))
        before = change.mode


def _line(axes: Any, x: Array, y: Array, colour: str, label: str | None, linewidth: float = 1.3) -> None:
    kept = thinned(np.nan_to_num(y), _POINTS)
    axes.plot(x[kept], y[kept], color=colour, linewidth=linewidth, label=label)
