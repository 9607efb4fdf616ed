"""Metrics of a drive. Pure: columns and course in, figures out."""

import math
from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.evaluation.metrics.fault_metrics import plain_spans
from simconsole.evaluation.metrics.table import Drive
from simconsole.evaluation.metrics.takeovers import takeovers
from simconsole.evaluation.metrics.track import Track, track
from simconsole.evaluation.metrics.wheel_metrics import force_feedback
from simconsole.values.labels import mode_label, reason_label
from simconsole.values.units import KMH_PER_MPS
from simconsole.world.route import Route

_PERCENT: Final = 95.0


class ModeChange(NamedTuple):
    """One change of the mode, or one refused request or command (then `mode` is the mode that stayed)."""

    tick: int
    t_s: float
    mode: int
    reason: int
    refused: bool
    x_m: float
    y_m: float
    distance_m: float  # distance driven before it


class LateralErrors(NamedTuple):
    """How far base_link was from the theoretical path, over all ticks in AUTONOMOUS."""

    rms_m: float
    p95_m: float
    max_m: float
    max_at: int  # index of the tick


def mode_changes(drive: Drive, way: Track) -> list[ModeChange]:
    """Return every change of mode and every refusal that was shown, in order; the first tick's mode opens the list."""
    found: list[ModeChange] = []
    start, last_mode, last_refusal = 0, -1.0, 0.0
    for block in drive.read(
        ("arbitration.mode", "arbitration.reason", "arbitration.refusal", "vehicle.x_m", "vehicle.y_m")
    ):
        mode, reason, refusal, x, y = block.T
        changed = np.diff(mode, prepend=last_mode) != 0.0
        refused = (np.diff(refusal, prepend=last_refusal) != 0.0) & (refusal != 0.0) & ~changed
        found += [
            ModeChange(
                tick=drive.first_tick + start + at,
                t_s=(drive.first_tick + start + at) / drive.tick_hz,
                mode=int(mode[at]),
                reason=int(refusal[at] if refused[at] else reason[at]),
                refused=bool(refused[at]),
                x_m=float(x[at]),
                y_m=float(y[at]),
                distance_m=float(way.distance_m[start + at]),
            )
            for at in np.flatnonzero(changed | refused).tolist()
        ]
        start, last_mode, last_refusal = start + len(block), float(mode[-1]), float(refusal[-1])
    return found


def lateral_errors(way: Track) -> LateralErrors | None:
    """Return the lateral errors; None without a course or without a tick in AUTONOMOUS."""
    driven = way.autonomous
    if not len(way.lateral_m) or not driven.any():
        return None
    errors = np.abs(way.lateral_m[driven])
    worst = int(errors.argmax())
    return LateralErrors(
        rms_m=math.sqrt(float(np.mean(errors**2))),
        p95_m=float(np.percentile(errors, _PERCENT)),
        max_m=float(errors[worst]),
        max_at=int(np.flatnonzero(driven)[worst]),
    )


def metrics(
    drive: Drive,
    route: Route | None,
    way: Track | None = None,
    faults: Sequence[str] = (),
    changes: Sequence[ModeChange] | None = None,
) -> dict[str, Any]:
    """Return the metrics as plain values with the unit in every key; None where the drive has no such part.

    Args:
        drive: The drive.
        route: The theoretical path, None in a world without one.
        way: The drive's track, where the caller has it.
        faults: The names of the faults of its scenario, in their order.
        changes: The drive's mode changes, where the caller has them.
    """
    way = track(drive, route) if way is None else way
    duration = drive.ticks / drive.tick_hz
    lateral_accel, autonomous_accel = _lateral_accel_mps2(drive, way)
    return {
        "ticks": drive.ticks,
        "duration_s": duration,
        "distance_m": float(way.distance_m[-1]),
        "mean_speed_kmh": float(way.distance_m[-1]) / duration * KMH_PER_MPS,
        "max_speed_kmh": float(way.speed_mps.max()) * KMH_PER_MPS,
        "speed_limit_kmh": route.speed_limit_mps * KMH_PER_MPS if route is not None else None,
        "above_limit_s": float((way.speed_mps > way.limit_mps).sum()) / drive.tick_hz,
        "max_lateral_accel_mps2": lateral_accel,
        "autonomous": _autonomous(drive, way, autonomous_accel),
        "time_in_mode_s": _time_in_mode(drive, way),
        "takeovers": takeovers(drive, way),
        "mode_changes": [
            {
                "tick": change.tick,
                "t_s": change.t_s,
                "mode": mode_label(change.mode),
                "reason": reason_label(change.reason),
                "refused": change.refused,
                "distance_m": change.distance_m,
            }
            for change in (mode_changes(drive, way) if changes is None else changes)
        ],
        "faults": plain_spans(drive, faults),
        "force_feedback": force_feedback(drive),
    }


def _lateral_accel_mps2(drive: Drive, way: Track) -> tuple[float, float]:
    """Return the largest of the whole drive, and of its ticks in AUTONOMOUS (0 without any)."""
    driven, largest, autonomous, at = way.autonomous, 0.0, 0.0, 0
    for block in drive.read(("vehicle.ay_mps2",)):
        accel = np.abs(block[:, 0])
        largest = max(largest, float(accel.max()))
        autonomous = max(autonomous, float(accel[driven[at : at + len(block)]].max(initial=0.0)))
        at += len(block)
    return largest, autonomous


def _autonomous(drive: Drive, way: Track, max_lateral_accel_mps2: float) -> dict[str, float | None] | None:
    """Metrics over all ticks in AUTONOMOUS; lateral errors are base_link's from the theoretical path."""
    driven = way.autonomous
    count = int(driven.sum())
    if count == 0:
        return None
    distance = float(np.diff(way.distance_m, prepend=0.0)[driven].sum())
    errors = lateral_errors(way)
    return {
        "duration_s": count / drive.tick_hz,
        "distance_m": distance,
        "mean_speed_kmh": distance * drive.tick_hz / count * KMH_PER_MPS,
        "max_speed_kmh": float(way.speed_mps[driven].max()) * KMH_PER_MPS,
        "lateral_rms_m": None if errors is None else errors.rms_m,
        "lateral_p95_m": None if errors is None else errors.p95_m,
        "lateral_max_m": None if errors is None else errors.max_m,
        "lateral_max_at_m": None if errors is None else float(way.distance_m[errors.max_at]),
        "max_lateral_accel_mps2": max_lateral_accel_mps2,
    }


def _time_in_mode(drive: Drive, way: Track) -> dict[str, float]:
    modes, counts = np.unique(way.mode, return_counts=True)
    return {mode_label(float(m)): c / drive.tick_hz for m, c in zip(modes.tolist(), counts.tolist(), strict=True)}
