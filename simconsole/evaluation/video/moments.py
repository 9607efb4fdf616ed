"""A recorded drive at the moments of a video's frames."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from simconsole.hud.driver_view.motion import ShownVehicle, moved, shown_vehicle
from simconsole.hud.driver_view.other_vehicles import at_moment
from simconsole.recording.matching import Matched, matched, renamed
from simconsole.recording.reading import Recording
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.values.errors import RecordingError
from simconsole.values.kernels import Row
from simconsole.values.state_vector import PLATFORM_AT, Snapshot, columns
from simconsole.world.traffic.road_users import RoadUsersAt


class _Nothing(NamedTuple):
    """The state of no platform: a picture needs none of it."""


class VideoFrame(NamedTuple):
    """One frame: the newest tick before it, and the vehicle where it is then, between two ticks."""

    t_s: float
    snapshot: Snapshot
    shown: ShownVehicle


def moments(recording: Recording, from_s: float, to_s: float | None, fps: int) -> Iterator[VideoFrame]:
    """Yield a recorded drive at `fps` from `from_s` on, up to `to_s` (None: its end), in simulated time.

    Raises:
        RecordingError: the drive has no tick in that time.
    """
    rows, tick_hz = _snapshots(recording), recording.header.tick_hz
    traffic = _Traffic(recording)
    older = next(rows, None)
    first_s = from_s if older is None else max(from_s, older.t_s)
    frame = 0
    for newer in rows:
        while older is not None and (at_s := first_s + frame / fps) < newer.t_s:
            if to_s is not None and at_s > to_s:
                return
            yield VideoFrame(at_s, older, traffic.beside(moved(older, newer, at_s - older.t_s), older.tick))
            frame += 1
        older = newer
    at_s = first_s + frame / fps
    if older is not None and at_s <= older.t_s + 0.5 / tick_hz and (to_s is None or at_s <= to_s):
        yield VideoFrame(at_s, older, traffic.beside(shown_vehicle(older), older.tick))
        frame += 1
    if frame == 0:
        ends = "no tick was recorded" if older is None else f"the drive ends at {older.t_s:g} s"
        raise RecordingError(f"nothing to see from {from_s:g} s{'' if to_s is None else f' to {to_s:g} s'}: {ends}")


class _Traffic:
    """The road users of a recorded drive, moment after moment."""

    def __init__(self, recording: Recording) -> None:
        self._steps = recorded_road_users(recording)
        self._tick_hz = recording.header.tick_hz
        self._before: RoadUsersAt | None = None
        self._now: RoadUsersAt | None = None
        self._next = next(self._steps, None)

    def beside(self, shown: ShownVehicle, tick: int) -> ShownVehicle:
        """Return the moment after `tick` with its road users."""
        while self._next is not None and self._next.tick <= tick:
            self._before, self._now, self._next = self._now, self._next, next(self._steps, None)
        if self._now is None:
            return shown
        others = at_moment(self._now, shown.t_s, self._tick_hz, self._before)
        return shown._replace(others=others, signals=self._now.signals)


def _snapshots(recording: Recording) -> Iterator[Snapshot]:
    header = recording.header
    match = matched(columns(_Nothing), renamed(header))
    for block in recording.blocks():
        for tick, vector in zip(block.ticks.tolist(), block.vectors, strict=True):
            yield Snapshot(tick, header.tick_hz, _of_this_version(vector, match))


def _of_this_version(vector: Row, match: Matched) -> Row:
    """Return a recorded state vector as this version's, without the platform's own part; what is missing is 0."""
    if match.first is None:
        return vector
    now = np.zeros(PLATFORM_AT)
    now[match.first] = match.of_second(vector)
    return now
