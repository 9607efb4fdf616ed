"""Speed advice: whether it was followed, and what approaches to lights cost where it was and where it was not. Pure."""

from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.metrics.table import Drive
from simconsole.evaluation.metrics.track import Track
from simconsole.values.errors import RecordingError

_SPEED: Final = 1  # kinds of `recording.recorded_advice`
_REACTION_S: Final = 1.5
_TOLERANCE_MPS: Final = 0.6  # 2 km/h: what a person reads and holds
FOLLOWED: Final = 0.8
"""Advice counts as followed where speed lay in its band for this share of its time, less the time for reaction."""
_LINE_M: Final = 5.0  # a distance that changes by more in one tick is that to another line
_REACH_M: Final = 300.0
_QUEUE_M: Final = 50.0
_STANDS_MPS: Final = 0.1


class Approaches(NamedTuple):
    """The way to some lights, means for one; None: there was none."""

    lights: int
    stops: float | None  # share at which the vehicle stood
    waiting_s: float | None
    time_loss_s: float | None  # against driving at the limit
    energy_jpkg: float | None  # for gaining speed, of one kilogram


def advice_metrics(drive: Drive, way: Track) -> dict[str, Any] | None:
    """Return compliance and benefit as plain values; None where nobody was advised or no light was passed."""
    if not drive.advice:
        return None
    try:
        (distance,) = drive.columns("situation.signal_distance_m")
    except RecordingError:
        return None
    before, after = distance[:-1], distance[1:]
    passed = np.flatnonzero((before >= 0.0) & (after < 0.0) & (before - after < _LINE_M)) + 1
    if not len(passed):
        return None
    advised, ripe, inside = _advised(drive, way)
    costs: list[tuple[bool, bool, tuple[float, ...]]] = []
    start = 0
    for end in passed.tolist():
        part = np.flatnonzero((distance[start:end] >= 0.0) & (distance[start:end] <= _REACH_M)) + start
        due = ripe[part]
        followed = bool(due.any()) and float(inside[part][due].mean()) >= FOLLOWED
        costs.append((bool(advised[part].any()), followed, _cost(way, distance, part, drive.tick_hz)))
        start = end
    followed_costs = [cost for _, followed, cost in costs if followed]
    others = [cost for _, followed, cost in costs if not followed]
    return {
        "lights": len(costs),
        "advised": sum(given for given, _, _ in costs),
        "compliance": float(inside[ripe].mean()) if ripe.any() else None,
        "followed": _means(followed_costs)._asdict(),
        "not_followed": _means(others)._asdict(),
    }


def _advised(drive: Drive, way: Track) -> tuple[NDArray[np.bool_], ...]:
    """Return [ticks] each: a speed was advised; for longer than a reaction takes; and the vehicle drove so."""
    advised, ripe, inside = (np.zeros(drive.ticks, np.bool_) for _ in range(3))
    ends = [one.tick for one in drive.advice[1:]] + [drive.first_tick + drive.ticks]
    for one, end in zip(drive.advice, ends, strict=True):
        if one.kind != _SPEED:
            continue
        first, last = one.tick - drive.first_tick, end - drive.first_tick
        advised[first:last] = True
        ripe[first + round(_REACTION_S * drive.tick_hz) : last] = True
        speed = way.speed_mps[first:last]
        inside[first:last] = (speed >= one.low_mps - _TOLERANCE_MPS) & (speed <= one.high_mps + _TOLERANCE_MPS)
    return advised, ripe, inside


def _cost(way: Track, distance: NDArray[np.float64], part: NDArray[np.int64], tick_hz: int) -> tuple[float, ...]:
    if not len(part):
        return 0.0, 0.0, 0.0, 0.0
    speed, limit = way.speed_mps[part], np.broadcast_to(way.limit_mps, way.speed_mps.shape)[part]
    stands = (speed < _STANDS_MPS) & (distance[part] < _QUEUE_M)
    lost = np.maximum(1.0 - speed / np.maximum(limit, 1e-9), 0.0)
    gained = np.maximum(np.diff(0.5 * speed**2), 0.0)
    return float(stands.any()), float(stands.sum()) / tick_hz, float(lost.sum()) / tick_hz, float(gained.sum())


def _means(costs: list[tuple[float, ...]]) -> Approaches:
    if not costs:
        return Approaches(0, None, None, None, None)
    return Approaches(len(costs), *(float(np.mean(column)) for column in zip(*costs, strict=True)))
