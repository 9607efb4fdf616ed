"""Moments that somebody marked: the person at the wheel, an operator or the ROS side, the ECU on CAN. Pure."""

from typing import Any, Final

import numpy as np

from simconsole.evaluation.metrics.table import Drive
from simconsole.evaluation.metrics.track import Track
from simconsole.values.signals import Button, Event

_SOURCES: Final = (
    ("driver.edges", int(Button.MARK), "driver"),
    ("events.events", int(Event.MARK), "operator or ROS side"),
    ("events.ecu_events", int(Event.MARK), "CAN"),
)


def marks(drive: Drive, way: Track) -> list[dict[str, Any]]:
    """Return every mark in order: `tick`, `t_s`, `by` whom, and `distance_m` driven before it."""
    known = [source for source in _SOURCES if not drive.names or source[0] in drive.names]
    found, start = [], 0
    for block in drive.read([name for name, _, _ in known]):
        for column, (_, bit, by) in zip(block.T, known, strict=True):
            for at in (np.flatnonzero(column.astype(np.int64) & bit) + start).tolist():
                tick = drive.first_tick + at
                found.append(
                    {"tick": tick, "t_s": tick / drive.tick_hz, "by": by, "distance_m": float(way.distance_m[at])}
                )
        start += len(block)
    return sorted(found, key=lambda mark: (mark["tick"], mark["by"]))
