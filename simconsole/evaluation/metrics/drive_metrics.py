"""Metrics of a drive. Pure: state vectors and course in, figures out."""

import math
from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.evaluation.metrics.fault_metrics import plain_spans
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.evaluation.metrics.takeovers import takeovers
from simconsole.values.labels import mode_label, reason_label
from simconsole.values.signals import Mode
from simconsole.values.units import KMH_PER_MPS
from simconsole.world.course import Course

REFUSED_FROM: Final = 20
"""Reasons from this number on tell why a change was refused (signals.Reason)."""

JUMP_M: Final = 1.0
"""A vehicle that moved further in one tick was put there (a restart): it did not drive."""

_PERCENT: Final = 95.0


class ModeChange(NamedTuple):
    """One change of the mode, or one refused request (then `mode` is the mode that stayed)."""

    tick: int
    t_s: float
    mode: int
    reason: int
    refused: bool
    x_m: float
    y_m: float
    distance_m: float  # distance driven before it


class Track(NamedTuple):
    """A drive along its course, float64 [ticks] each; without a course `s_m` and `lateral_m` are empty."""

    distance_m: Array  # driven since the first tick
    speed_mps: Array
    autonomous: Array  # 1 where the controller on the ROS side had the car
    s_m: Array
    lateral_m: Array


def track(drive: Drive, course: Course | None) -> Track:
    """Return where the drive was, tick by tick."""
    x, y = drive.column("vehicle.x_m"), drive.column("vehicle.y_m")
    steps = np.hypot(np.diff(x, prepend=x[0]), np.diff(y, prepend=y[0]))
    steps[steps > JUMP_M] = 0.0
    mode = drive.column("arbitration.mode")
    s, lateral = course.project_all(x, y) if course is not None else (np.zeros(0), np.zeros(0))
    return Track(
        np.cumsum(steps),
        np.hypot(drive.column("vehicle.vx_mps"), drive.column("vehicle.vy_mps")),
        np.where(mode == float(Mode.AUTONOMOUS), 1.0, 0.0),
        s,
        lateral,
    )


def mode_changes(drive: Drive, way: Track) -> list[ModeChange]:
    """Return every change of mode and every refused request, in order; the first tick's mode opens the list."""
    mode, reason = drive.column("arbitration.mode"), drive.column("arbitration.reason")
    x, y = drive.column("vehicle.x_m"), drive.column("vehicle.y_m")
    changed = np.diff(mode, prepend=-1.0) != 0.0
    refused = (np.diff(reason, prepend=reason[0]) != 0.0) & (reason >= REFUSED_FROM) & ~changed
    return [
        ModeChange(
            tick=drive.first_tick + at,
            t_s=(drive.first_tick + at) / drive.tick_hz,
            mode=int(mode[at]),
            reason=int(reason[at]),
            refused=bool(refused[at]),
            x_m=float(x[at]),
            y_m=float(y[at]),
            distance_m=float(way.distance_m[at]),
        )
        for at in np.flatnonzero(changed | refused).tolist()
    ]


def metrics(
    drive: Drive, course: Course | None, way: Track | None = None, faults: Sequence[str] = ()
) -> dict[str, Any]:
    """Return the metrics as plain values with the unit in every key; None where the drive has no such part.

    `faults` are the names of the faults of its scenario, in their order.
    """
    way = track(drive, course) if way is None else way
    duration = len(drive.vectors) / drive.tick_hz
    limit = course.speed_limit_mps if course is not None else math.inf
    return {
        "ticks": len(drive.vectors),
        "duration_s": duration,
        "distance_m": float(way.distance_m[-1]),
        "mean_speed_kmh": float(way.distance_m[-1]) / duration * KMH_PER_MPS,
        "max_speed_kmh": float(way.speed_mps.max()) * KMH_PER_MPS,
        "speed_limit_kmh": limit * KMH_PER_MPS if course is not None else None,
        "above_limit_s": float((way.speed_mps > limit).sum()) / drive.tick_hz,
        "max_lateral_accel_mps2": float(np.abs(drive.column("vehicle.ay_mps2")).max()),
        "autonomous": _autonomous(drive, way),
        "time_in_mode_s": _time_in_mode(drive),
        "takeovers": takeovers(drive, way.lateral_m),
        "mode_changes": [
            {
                "tick": change.tick,
                "t_s": change.t_s,
                "mode": mode_label(change.mode),
                "reason": reason_label(change.reason),
                "refused": change.refused,
                "distance_m": change.distance_m,
            }
            for change in mode_changes(drive, way)
        ],
        "faults": plain_spans(drive, faults),
    }


def _autonomous(drive: Drive, way: Track) -> dict[str, float | None] | None:
    """Metrics over all ticks in AUTONOMOUS; lateral errors are base_link's from the theoretical path."""
    driven = way.autonomous > 0.0
    count = int(driven.sum())
    if count == 0:
        return None
    steps = np.diff(way.distance_m, prepend=0.0)
    distance = float(steps[driven].sum())
    errors = np.abs(way.lateral_m[driven]) if len(way.lateral_m) else None
    return {
        "duration_s": count / drive.tick_hz,
        "distance_m": distance,
        "mean_speed_kmh": distance * drive.tick_hz / count * KMH_PER_MPS,
        "max_speed_kmh": float(way.speed_mps[driven].max()) * KMH_PER_MPS,
        "lateral_rms_m": None if errors is None else math.sqrt(float(np.mean(errors**2))),
        "lateral_p95_m": None if errors is None else float(np.percentile(errors, _PERCENT)),
        "lateral_max_m": None if errors is None else float(errors.max()),
        "lateral_max_at_m": None if errors is None else float(way.distance_m[driven][int(errors.argmax())]),
        "max_lateral_accel_mps2": float(np.abs(drive.column("vehicle.ay_mps2")[driven]).max()),
    }


def _time_in_mode(drive: Drive) -> dict[str, float]:
    modes, counts = np.unique(drive.column("arbitration.mode"), return_counts=True)
    return {mode_label(m): c / drive.tick_hz for m, c in zip(modes.tolist(), counts.tolist(), strict=True)}
