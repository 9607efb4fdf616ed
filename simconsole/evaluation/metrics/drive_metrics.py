"""Metrics of a drive. Pure: columns and course in, figures out."""

import math
from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.metrics.advice_metrics import advice_metrics
from simconsole.evaluation.metrics.encounters import encounters
from simconsole.evaluation.metrics.fault_metrics import plain_spans
from simconsole.evaluation.metrics.marks import marks
from simconsole.evaluation.metrics.registered import Driven, own_metrics
from simconsole.evaluation.metrics.rule_metrics import plain_events
from simconsole.evaluation.metrics.table import Drive
from simconsole.evaluation.metrics.takeovers import takeovers
from simconsole.evaluation.metrics.track import Track, track
from simconsole.evaluation.metrics.wheel_metrics import force_feedback
from simconsole.values.labels import mode_label, reason_label
from simconsole.values.units import KMH_PER_MPS
from simconsole.world.route import Route

_PERCENT: Final = 95.0
_MOVING_MPS: Final = 1.0


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
    """How far base_link was from the theoretical path, over all ticks in which one side drove."""

    rms_m: float
    p95_m: float
    max_m: float
    max_at: int  # index of the tick
    deviation_m: float | None  # standard deviation of the lateral position, SDLP of SAE J2944; None: it never moved


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


def lateral_errors(way: Track, driven: NDArray[np.bool_] | None = None) -> LateralErrors | None:
    """Return the lateral errors where `driven` says, bool [ticks], by default in AUTONOMOUS; None without any there.

    The standard deviation is that of the ticks in which the car moves: one that waits at a light keeps no lane.
    """
    driven = way.autonomous if driven is None else driven
    if not len(way.lateral_m) or not driven.any():
        return None
    errors = np.abs(way.lateral_m[driven])
    worst = int(errors.argmax())
    moved = way.lateral_m[driven & (way.speed_mps > _MOVING_MPS)]
    return LateralErrors(
        rms_m=math.sqrt(float(np.mean(errors**2))),
        p95_m=float(np.percentile(errors, _PERCENT)),
        max_m=float(errors[worst]),
        max_at=int(np.flatnonzero(driven)[worst]),
        deviation_m=float(moved.std(ddof=1)) if len(moved) > 1 else None,
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

    Raises:
        ProfileError, MetricError: a metric of another package cannot be loaded, fails, or breaks its promise.
    """
    way = track(drive, route) if way is None else way
    duration = drive.ticks / drive.tick_hz
    lateral_accel, (autonomous_accel, manual_accel) = _lateral_accel_mps2(drive, (way.autonomous, way.manual))
    return {
        "ticks": drive.ticks,
        "duration_s": duration,
        "distance_m": float(way.distance_m[-1]),
        "mean_speed_kmh": float(way.distance_m[-1]) / duration * KMH_PER_MPS,
        "max_speed_kmh": float(way.speed_mps.max()) * KMH_PER_MPS,
        "speed_limit_kmh": route.speed_limit_mps * KMH_PER_MPS if route is not None else None,
        "above_limit_s": float((way.speed_mps > way.limit_mps).sum()) / drive.tick_hz,
        "max_lateral_accel_mps2": lateral_accel,
        "autonomous": _driven_part(drive, way, way.autonomous, autonomous_accel),
        "manual": _driven_part(drive, way, way.manual, manual_accel),
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
        "marks": marks(drive, way),
        "faults": plain_spans(drive, faults),
        "rules": plain_events(drive),
        "road": encounters(drive, way),
        "speed_advice": advice_metrics(drive, way),
        "force_feedback": force_feedback(drive),
        "own": own_metrics(Driven(drive, way, route)),
    }


def _lateral_accel_mps2(drive: Drive, parts: Sequence[NDArray[np.bool_]]) -> tuple[float, list[float]]:
    """Return the largest of the whole drive, and of each of its parts (0 without any tick)."""
    largest, of_part, at = 0.0, [0.0] * len(parts), 0
    for block in drive.read(("vehicle.ay_mps2",)):
        accel = np.abs(block[:, 0])
        largest = max(largest, float(accel.max()))
        for place, part in enumerate(parts):
            of_part[place] = max(of_part[place], float(accel[part[at : at + len(block)]].max(initial=0.0)))
        at += len(block)
    return largest, of_part


def _driven_part(
    drive: Drive, way: Track, driven: NDArray[np.bool_], max_lateral_accel_mps2: float
) -> dict[str, float | None] | None:
    """Metrics over the ticks in which one side drove; lateral errors are base_link's from the theoretical path."""
    count = int(driven.sum())
    if count == 0:
        return None
    distance = float(np.diff(way.distance_m, prepend=0.0)[driven].sum())
    errors = lateral_errors(way, driven)
    return {
        "duration_s": count / drive.tick_hz,
        "distance_m": distance,
        "mean_speed_kmh": distance * drive.tick_hz / count * KMH_PER_MPS,
        "max_speed_kmh": float(way.speed_mps[driven].max()) * KMH_PER_MPS,
        "lateral_rms_m": None if errors is None else errors.rms_m,
        "lateral_p95_m": None if errors is None else errors.p95_m,
        "lateral_deviation_m": None if errors is None else errors.deviation_m,
        "lateral_max_m": None if errors is None else errors.max_m,
        "lateral_max_at_m": None if errors is None else float(way.distance_m[errors.max_at]),
        "max_lateral_accel_mps2": max_lateral_accel_mps2,
    }


def _time_in_mode(drive: Drive, way: Track) -> dict[str, float]:
    modes, counts = np.unique(way.mode, return_counts=True)
    return {mode_label(float(m)): c / drive.tick_hz for m, c in zip(modes.tolist(), counts.tolist(), strict=True)}
