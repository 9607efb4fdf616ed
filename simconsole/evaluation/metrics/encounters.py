"""What a drive met on a road map: lights passed and stood at, others who went first, by who drove then. Pure."""

from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.metrics.table import Drive
from simconsole.evaluation.metrics.track import Track
from simconsole.values.errors import RecordingError
from simconsole.values.signals import FAR

_COLUMNS: Final = ("situation.tick", "situation.signal_distance_m", "situation.yield_m")
_LINE_M: Final = 5.0  # a distance that changes by more in one tick is that to another line
_QUEUE_M: Final = 50.0  # who stands within this before a stop line stands at its light
_STANDS_MPS: Final = 0.1


class Encounters(NamedTuple):
    """How often it was met, while one side drove."""

    lights_passed: int  # the vehicle's front passed the stop line of one
    lights_stood_at: int  # of those
    let_pass: int  # somebody had to be let pass: on a crossing, or with the right of way


def encounters(drive: Drive, way: Track) -> dict[str, Any] | None:
    """Return what was met in the whole drive, while the autopilot drove and while the person did.

    None: a world without lights, crossings and junctions, or a drive from before they were recorded.
    """
    if drive.names and not drive.names.issuperset(_COLUMNS):
        return None
    try:
        tick, distance, owed = drive.columns(*_COLUMNS)
    except RecordingError:
        return None
    if not tick.any():
        return None
    before, after = distance[:-1], distance[1:]
    passed = np.flatnonzero((before >= 0.0) & (after < 0.0) & (before - after < _LINE_M)) + 1
    stands = (way.speed_mps < _STANDS_MPS) & (distance >= 0.0) & (distance < _QUEUE_M)
    parts = np.split(stands, passed)[:-1]  # each: from one line to the next
    stood = np.array([bool(part.any()) for part in parts], np.bool_)
    asked = np.flatnonzero(np.diff((owed < FAR).astype(np.int8), prepend=0) > 0)
    everywhere = np.ones(len(distance), np.bool_)
    sides = {"whole": everywhere, "autonomous": way.autonomous, "manual": way.manual}
    return {name: _of(side, passed, stood, asked)._asdict() for name, side in sides.items()}


def _of(
    side: NDArray[np.bool_], passed: NDArray[np.int64], stood: NDArray[np.bool_], asked: NDArray[np.int64]
) -> Encounters:
    mine = side[passed]
    return Encounters(
        lights_passed=int(mine.sum()), lights_stood_at=int((mine & stood).sum()), let_pass=int(side[asked].sum())
    )
