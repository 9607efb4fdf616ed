"""Everybody else on the road, as the log, shared memory, views and messages have them."""

from collections.abc import Sequence
from enum import IntEnum
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.world.roads.road_map import Array
from simconsole.world.roads.running import NONE_RUNNING, RunningNow


class RoadUserKind(IntEnum):
    """What kind of road user it is."""

    CAR = 1
    VAN = 2
    PEDESTRIAN = 3


class RoadUser(NamedTuple):
    """One road user, as a box in `map`: the middle of its footprint on the ground."""

    id: float  # whole; nobody gets it again
    kind: float  # of RoadUserKind
    x_m: float
    y_m: float
    yaw_rad: float
    speed_mps: float  # along its heading
    length_m: float
    width_m: float
    height_m: float
    z_m: float = 0.0  # of the ground below its middle
    turn_indicators: float = 0.0  # 1 left, -1 right, 0 off


class Box(NamedTuple):
    """A vehicle's footprint: its middle in `map`, its speed along its heading."""

    x_m: float
    y_m: float
    yaw_rad: float
    speed_mps: float
    length_m: float
    width_m: float


class RoadUsersAt(NamedTuple):
    """The road users after a tick: a table, float64 [users, FIELDS]; and the signals that came with them."""

    tick: int
    users: Array
    signals: RunningNow = NONE_RUNNING  # where another simulator runs them


CAPACITY: Final = 256
"""Road users that a record in shared memory has room for."""
FIELDS: Final = len(RoadUser._fields)
RECORD_WIDTH: Final = 1 + CAPACITY * FIELDS
_FIRST_FIELDS: Final = 9  # of tables from before there were height and indicators
NOBODY: Final[Array] = np.zeros((0, FIELDS))
NOBODY_AT_ALL: Final = RoadUsersAt(0, NOBODY)
"""Before the first step of traffic, and where there is none."""
ENCODING: Final = f"float64[{FIELDS}]"
"""Of road users in a log: little-endian, one row a user."""


def users(rows: Array) -> tuple[RoadUser, ...]:
    """Return the road users of a table, float64 [users, FIELDS]."""
    return tuple(RoadUser(*row) for row in rows.tolist())


def to_bytes(rows: Array) -> bytes:
    """Return a table of road users as a message: little-endian float64, one user after the other."""
    return rows.astype("<f8", copy=False).tobytes()


def from_bytes(content: bytes, encoding: str = ENCODING) -> Array:
    """Return the table of a message; fields that its encoding does not have yet are 0.

    Raises:
        ValueError: it is none.
    """
    fields = next((count for count in (FIELDS, _FIRST_FIELDS) if encoding == f"float64[{count}]"), 0)
    if not fields:
        raise ValueError(f"encoding {encoding!r}: {ENCODING}")
    if len(content) % (8 * fields) or len(content) > 8 * fields * CAPACITY:
        raise ValueError(f"{len(content)} bytes: up to {CAPACITY} road users of {8 * fields}")
    rows = np.frombuffer(content, "<f8").astype(np.float64).reshape(-1, fields)
    return np.pad(rows, ((0, 0), (0, FIELDS - fields)))


def to_record(rows: Array) -> NDArray[np.float64]:
    """Return a table as a record of fixed width: how many, then the users, then zeros."""
    record = np.zeros(RECORD_WIDTH)
    record[0] = len(rows)
    record[1 : 1 + rows.size] = rows.ravel()
    return record


def from_record(record: Array) -> Array:
    """Return the table of a record."""
    return record[1 : 1 + int(record[0]) * FIELDS].reshape(-1, FIELDS)


def table(some: Sequence[RoadUser]) -> Array:
    """Return road users as a table, float64 [users, FIELDS]."""
    return np.array(some, np.float64).reshape(-1, FIELDS)
