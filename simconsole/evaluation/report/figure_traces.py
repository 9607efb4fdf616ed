"""A drive over its distance: lateral deviation, speed, steering, mode."""

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.metrics.drive_metrics import ModeChange, lateral_errors
from simconsole.evaluation.metrics.table import Array, Drive, runs
from simconsole.evaluation.metrics.thinning import thinned
from simconsole.evaluation.metrics.track import Track
from simconsole.evaluation.report.colours import BAND, END, LIMIT, MODES, NOTE, PERSON, REMOTE
from simconsole.evaluation.report.metric_rows import rounded
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS
from simconsole.world.route import Route

_POINTS: Final = 1600
_CM_PER_M: Final = 100.0
_ROOM: Final = 1.35  # upper end of the deviation's axis over its largest value
_LEAST_M: Final = 1e-3  # of which such an axis shows at least so much
_METRES_FROM_M: Final = 1.5  # deviations beyond it are told in metres
_NARROW: Final = 0.05  # share of the drive below which the mode's label does not fit


def draw_traces(
    figure: Any, drive: Drive, way: Track, changes: list[ModeChange], route: Route | None, *, robot: bool = False
) -> None:
    """Draw the panels into a matplotlib figure, one distance axis for all; a deviation has its driver's own scale.

    Of a `robot`, which follows no path and has no road wheels, there are speed, yaw rate and mode.
    """
    drivers = _drivers(way) if route is not None else [("", PERSON, way.autonomous)] * (not robot)
    heights = [3.0 / len(drivers) + 0.6 * (len(drivers) - 1)] * len(drivers) if drivers else []
    *laterals, speed, wheel, modes = figure.subplots(
        len(drivers) + 3, 1, sharex=True, gridspec_kw={"height_ratios": (*heights, 2.6, 2.2, 0.55), "hspace": 0.04}
    )
    for axes, driver in zip(laterals, drivers, strict=True):
        _draw_lateral(axes, way, route, *driver)
    _draw_speed(speed, way, route)
    if robot:
        _draw_turning(wheel, drive, way)
    else:
        _draw_steering(wheel, drive, way)
    _draw_modes(modes, way)
    for axes in (*laterals, speed, wheel):
        _draw_changes(axes, changes)
    modes.set_xlabel("distance driven / m")
    modes.set_xlim(0.0, max(float(way.distance_m[-1]), 1.0))


def _drivers(way: Track) -> list[tuple[str, str, NDArray[np.bool_]]]:
    """Return who drove, their colour, and in which ticks: whatever the autopilot did not drive is the person's."""
    both = (("autopilot", REMOTE, way.autonomous), ("person", PERSON, ~way.autonomous))
    return [one for one in both if one[2].any()]


def _draw_lateral(axes: Any, way: Track, route: Route | None, who: str, colour: str, driven: NDArray[np.bool_]) -> None:
    """Draw one driver's deviation, scaled by it alone: a person's metres leave the autopilot's centimetres readable."""
    axes.set_title("Lateral deviation of base_link from the theoretical path, left positive" + (who and f": {who}"))
    errors = lateral_errors(way, driven)
    if route is None or errors is None:
        axes.set_ylabel("deviation / cm")
        axes.text(0.5, 0.5, "no course in this world", transform=axes.transAxes, ha="center", color=NOTE)
        return
    unit, factor = ("m", 1.0) if errors.max_m > _METRES_FROM_M else ("cm", _CM_PER_M)
    axes.set_ylabel(f"deviation / {unit}")
    rms, worst, deviation = errors.rms_m * factor, errors.max_m * factor, way.lateral_m * factor
    axes.axhspan(-rms, rms, color=BAND, zorder=0, label=f"RMS {rounded(rms)} {unit}")
    _line(axes, way.distance_m, np.where(driven, deviation, np.nan), colour, who)
    at, place = errors.max_at, deviation[errors.max_at]
    axes.plot(way.distance_m[at], place, "o", color=END, markersize=5, label=f"max {rounded(worst)} {unit}")
    axes.set_ylim(-_ROOM * max(worst, _LEAST_M * factor), _ROOM * max(worst, _LEAST_M * factor))
    axes.legend(loc="upper center", ncols=3)


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


def _draw_turning(axes: Any, drive: Drive, way: Track) -> None:
    axes.set_title("Yaw rate, left positive")
    axes.set_ylabel("yaw rate / deg/s")
    _line(axes, way.distance_m, drive.column("vehicle.yaw_rate_radps") * DEG_PER_RAD, REMOTE, None)


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
