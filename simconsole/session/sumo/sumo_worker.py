"""The worker that runs SUMO beside a paced drive: a step for each that the core asks for, in the core's time.

It is never started a second time: another SUMO would be another road. Its restarted process only says so.
"""

import logging
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Final

import msgspec
import numpy as np

from simconsole.processes.shared_memory import Record
from simconsole.processes.worker import Worker
from simconsole.profiles.files.world_files import read_map
from simconsole.profiles.traffic import TrafficProfile
from simconsole.profiles.world import RoadsProfile
from simconsole.session.sumo.sumo_memory import How, SumoMemory, signal_bytes, signals_within
from simconsole.values.errors import ProfileError
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_world import roads_of
from simconsole.world.roads.running import NONE_RUNNING, RunningNow
from simconsole.world.sumo_traffic.sumo_traffic import SumoTraffic, Surroundings
from simconsole.world.traffic.road_users import RECORD_WIDTH, Box, to_record

if TYPE_CHECKING:
    from simconsole.tick.assembly import ResolvedSession

LOOK_S: Final = 0.002
MOST_AT_ONCE: Final = 5
"""Steps that are made up for when SUMO was late; of more, SUMO's time stands still for the rest."""
NAME: Final = "sumo"
_logger = logging.getLogger(__name__)


class SumoWorker(Worker, frozen=True, kw_only=True):
    """Steps SUMO."""

    traffic: TrafficProfile
    world: RoadsProfile
    tick_hz: int
    ego: tuple[float, ...]
    """Where the vehicle starts: a `Box`."""
    duration_s: float | None = None

    def run(self, folder: Path, stop: Callable[[], bool]) -> None:
        """Step until `stop`."""
        memory = SumoMemory.open(folder)
        if memory.said.newest() is not None:
            _give_up(memory, "its process has ended", stop)
            return
        memory.say(How.STARTING)  # libsumo may take this process with it, and would again and again
        try:
            traffic = SumoTraffic(self.traffic, self._around())
        except ProfileError as problem:
            memory.say(How.REFUSED, str(problem))
            _wait(stop)
            return
        try:
            self._follow(memory, traffic, stop)
        finally:
            traffic.close()
        if traffic.lost is not None:
            _give_up(memory, traffic.lost, stop)

    def _around(self) -> Surroundings:
        world = open_world(self.world)
        roads = roads_of(world)
        assert roads is not None, "a road map has roads"
        return Surroundings(
            road_map=roads.road_map,
            net=read_map(self.world.map),
            legs=roads.legs,
            tick_hz=self.tick_hz,
            egos=(Box(*self.ego),),
            duration_s=self.duration_s,
            ground=world.ground,
        )

    def _follow(self, memory: SumoMemory, traffic: SumoTraffic, stop: Callable[[], bool]) -> None:
        """Answer the core, until it ends or SUMO fails."""
        answers = _Answers(memory, traffic, signal_bytes(traffic.road_map))
        answers.put(0)
        memory.say(How.RUNS)
        done, stood = 0, 0
        while traffic.lost is None and not stop():
            newest = memory.asked.newest
            if newest == done:
                time.sleep(LOOK_S)
                continue
            steps = memory.asked.since(done)[-MOST_AT_ONCE:]
            if (late := newest - done - len(steps)) > 0:
                traffic.stand(late)
                if not stood:
                    _logger.warning("SUMO is too slow for the drive: its time stands still for %d steps at first", late)
                stood += late
            for record in steps:
                done = record.number
                _step(memory, traffic, record)
                if traffic.lost is None:
                    answers.put(done)


def sumo_worker(resolved: "ResolvedSession", tick_hz: int, ego: Box) -> SumoWorker | None:
    """Return the worker of a session whose vehicle starts at `ego`, None where it has no SUMO."""
    traffic, world = resolved.session.environment.traffic, resolved.world
    if traffic is None or traffic.sumo is None or not isinstance(world, RoadsProfile):
        return None
    return SumoWorker(
        traffic=traffic, world=world, tick_hz=tick_hz, ego=ego, duration_s=resolved.session.scenario.duration_s
    )


class _Answers:
    """What SUMO's steps bring, on its way to the core."""

    def __init__(self, memory: SumoMemory, traffic: SumoTraffic, room: int) -> None:
        self._memory, self._traffic, self._room = memory, traffic, room
        self._told: RunningNow = NONE_RUNNING
        self._changes = 0

    def put(self, step: int) -> None:
        """Answer a step; signals first, so that whoever sees the answer finds them."""
        signals = self._traffic.signals.now
        if signals is not self._told:
            self._told, self._changes = signals, self._changes + 1
            self._memory.signals.write(self._changes, signals_within(signals, self._room))
        values = np.empty(RECORD_WIDTH + 1)
        values[:RECORD_WIDTH] = to_record(self._traffic.road_users())
        values[RECORD_WIDTH] = self._traffic.ego_error_m
        self._memory.answered.write(values, step, self._changes)


def _step(memory: SumoMemory, traffic: SumoTraffic, record: Record) -> None:
    for text in memory.pushed.take():
        number, change_mps = msgspec.json.decode(text, type=tuple[float, float])
        traffic.push(number, change_mps)
    traffic.step(Box(*record.values.tolist()))


def _give_up(memory: SumoMemory, why: str, stop: Callable[[], bool]) -> None:
    memory.say(How.LOST, why)
    _logger.error("traffic has failed: %s", why)
    _wait(stop)


def _wait(stop: Callable[[], bool]) -> None:
    while not stop():
        time.sleep(0.05)
