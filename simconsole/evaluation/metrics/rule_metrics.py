"""Which rules of the road were broken, when and where. Pure."""

from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.values.errors import RecordingError
from simconsole.values.signals import FAR
from simconsole.values.units import KMH_PER_MPS

RULES: Final = {
    "collision": "collision",
    "red_light": "red light passed",
    "wrong_way": "wrong way",
    "off_road": "off the road",
    "speeding": "speed limit exceeded",
    "failing_to_yield": "failed to yield",
}
"""What people call the rules; their names are those of the state vector's columns."""

_FACTS: Final = ("vehicle.vx_mps", "vehicle.distance_m", "situation.speed_limit_mps")


class RuleEvent(NamedTuple):
    """One breach of a rule, from its first tick to its last one."""

    rule: str
    first_tick: int
    last_tick: int
    distance_m: float  # driven before it
    top_speed_mps: float  # while it lasted
    limit_mps: float | None  # where it began; None: there was none


def rule_events(drive: Drive) -> list[RuleEvent]:
    """Return every breach, in the order of their first ticks; none of a drive from before there were rules."""
    known = [rule for rule in RULES if not drive.names or f"rules.{rule}" in drive.names]
    try:
        broken = drive.columns(*(f"rules.{rule}" for rule in known))
    except RecordingError:
        return []
    if not any(column.any() for column in broken):
        return []
    facts = drive.columns(*_FACTS)
    found = []
    for rule, column in zip(known, broken, strict=True):
        found += _events(drive.first_tick, rule, column, facts)
    return sorted(found, key=lambda event: (event.first_tick, event.rule))


def plain_events(drive: Drive) -> list[dict[str, Any]]:
    """Return the breaches as plain values: times in s, speeds in km/h."""
    return [
        {
            "rule": event.rule,
            "tick": event.first_tick,
            "first_s": event.first_tick / drive.tick_hz,
            "last_s": event.last_tick / drive.tick_hz,
            "distance_m": event.distance_m,
            "top_speed_kmh": event.top_speed_mps * KMH_PER_MPS,
            "limit_kmh": None if event.limit_mps is None else event.limit_mps * KMH_PER_MPS,
        }
        for event in rule_events(drive)
    ]


def _events(first_tick: int, rule: str, column: Array, facts: tuple[Array, ...]) -> list[RuleEvent]:
    speed, distance, limit = facts
    edges = np.diff((column > 0.0).astype(np.int8), prepend=0, append=0)
    return [
        RuleEvent(
            rule=rule,
            first_tick=first_tick + first,
            last_tick=first_tick + after - 1,
            distance_m=float(distance[first]),
            top_speed_mps=float(np.abs(speed[first:after]).max()),
            limit_mps=float(limit[first]) if limit[first] < FAR else None,
        )
        for first, after in zip(np.flatnonzero(edges > 0).tolist(), np.flatnonzero(edges < 0).tolist(), strict=True)
    ]
