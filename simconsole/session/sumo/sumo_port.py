"""SUMO's worker as the core sees it: asked for a step, never waited for.

A step that is asked for after tick N has brought others on to N + a period when the core takes it there, so they are
where they belong; they see the vehicle as it was a period before. All ages are counted in steps, not by a clock.
"""

import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

import msgspec
import numpy as np

from simconsole.profiles.traffic import TrafficProfile
from simconsole.session.sumo.sumo_memory import ERROR_AT, How, SumoMemory
from simconsole.values.errors import ProfileError
from simconsole.world.roads.road_map import Array, RoadMap
from simconsole.world.roads.running import NONE_RUNNING, changed
from simconsole.world.rules.running_signals import RunningSignals
from simconsole.world.sumo_traffic.engines import CONNECT_S, KEY, missing
from simconsole.world.traffic.road_users import NOBODY, Box, from_record

_LOOK_S: Final = 0.02
_START_S: Final = 600.0
"""A SUMO that loads a country, or warms up for hours, takes so long at most."""


class SumoPort:
    """Traffic that SUMO moves in a process of its own."""

    def __init__(self, profile: TrafficProfile, road_map: RoadMap, tick_hz: int, folder: Path, ego: Box) -> None:
        """Make the memory that the worker opens; the worker is the supervisor's to start.

        Raises:
            ProfileError: SUMO is not installed.
            WorkerError: the memory cannot be made.
        """
        assert profile.sumo is not None
        lacking = missing(profile.sumo)
        if lacking is not None:
            raise ProfileError(f"{KEY}: value missing: {lacking}")
        self._memory, self._ego = SumoMemory.create(folder, road_map), ego
        self._patience = math.ceil(1000.0 * profile.sumo.timeout_s / profile.period_ms)
        self.signals = RunningSignals(road_map, tick_hz)
        self.lost: str | None = None
        self.ego_error_m = 0.0
        self.late_steps = 0
        self._users, self._answered, self._changes = NOBODY, 0, 0

    def wait(self, alive: Callable[[], bool], patience_s: float = _START_S) -> None:
        """Wait until SUMO is there, take who is on the road at the beginning, and ask for the first step.

        Raises:
            ProfileError: it refuses, or is not there in time.
        """
        deadline_s = time.monotonic() + patience_s + CONNECT_S
        while (said := self._memory.said.newest()) is None or said.number == How.STARTING:
            if not alive() or time.monotonic() > deadline_s:
                raise ProfileError(f"{KEY}: SUMO: its worker does not answer: a simulation that starts")
            time.sleep(_LOOK_S)
        why = said.content.decode(errors="replace")
        if said.number == How.LOST:
            raise ProfileError(f"{KEY}: SUMO: {why}: a simulation that starts")
        if said.number != How.RUNS:
            raise ProfileError(why)
        self._take()
        self._ask(self._ego)

    def road_users(self) -> Array:
        """Return where everybody is, float64 [users, FIELDS] as `RoadUser`."""
        return self._users

    def step(self, ego: Box | None) -> Array:
        """Return who is where now, by the newest answer, and ask for the next; nobody once SUMO has failed."""
        if self.lost is None:
            self._take()
            self._look()
            self.late_steps += self._answered < self._memory.asked.newest
        if self.lost is None:
            self._ask(self._ego if ego is None else ego)
        return self._users

    def push(self, number: float, change_mps: float) -> None:
        """Change the speed of road user `number`, who has collided and from now on only comes to rest."""
        self._memory.pushed.put(msgspec.json.encode((number, change_mps)))

    def close(self) -> None:
        """Nothing: the worker ends SUMO, and the supervisor the worker."""

    def _ask(self, ego: Box) -> None:
        self._memory.asked.write(np.array(ego))

    def _take(self) -> None:
        record = self._memory.answered.latest()
        if record is None or (record.stamp == self._answered and self._changes):
            return
        self._answered = record.stamp
        self._users, self.ego_error_m = from_record(record.values), float(record.values[ERROR_AT])
        if record.second_stamp != self._changes:
            piece = self._memory.signals.newest()
            if piece is not None:
                self._changes = piece.number
                self.signals.take(changed(NONE_RUNNING, piece.content))

    def _look(self) -> None:
        """See whether SUMO is still there."""
        said = self._memory.said.newest()
        if said is not None and said.number != How.RUNS:
            self.lost = said.content.decode(errors="replace")
        elif (late := self._memory.asked.newest - self._answered) > self._patience:
            self.lost = f"no answer to {late} steps"
        if self.lost is not None:
            self._users = NOBODY
