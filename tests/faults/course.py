"""Drives over the urban course with the path tracker inline: whole, and from any row of a drive that went before."""

from collections.abc import Sequence
from copy import copy
from functools import cache
from typing import Any, NamedTuple

import msgspec
import numpy as np

from simconsole.assembly import ResolvedSession, assemble
from simconsole.autonomy.tracker import Sighting, Tracker
from simconsole.compiling import compiled
from simconsole.devices.settings import settings
from simconsole.devices.uncalibrate import Intent, uncalibrate
from simconsole.drive import Cast, run
from simconsole.faulting import with_faults
from simconsole.isolation import isolated
from simconsole.memory import MemoryRecorder
from simconsole.pacing import UnpacedPacer
from simconsole.pipeline import Console, ConsoleState
from simconsole.profile_files import parse
from simconsole.profiles.faults import Fault
from simconsole.profiles.session import SessionProfile
from simconsole.rows import Snapshot
from simconsole.session_files import resolve
from simconsole.signals import (
    NO_COMMAND,
    NO_EVENTS,
    DeviceSample,
    Event,
    EventInput,
    Mode,
    Reason,
    RemoteCommand,
    RemoteKind,
)
from simconsole.world.course import Course

HZ = 250
PERIOD_TICKS = 5
SESSION = "schema: 1\nenvironment: {world: urban}\nscenario: {vehicle: hatchback}\ndevices: {driver: none}\n"
ENGAGE_TICK = 2 * HZ
LANE_M = 3.5
CAR_M = 1.8
ASTRAY_M = 0.2
PLACES = {"straight": 150.0, "bend": 330.0, "roundabout": 1010.0}
"""Where on the course a fault comes, in m from its start."""


REACTION_S = 1.15
"""The benchmark driver of UN R157: 0.4 s to see the risk, 0.75 s to the first deceleration."""
BRAKE = 0.4


class Person:
    """Sits with hands and feet at rest. An attentive one brakes and steers along the lane once the alarm has lasted.

    The alarm is the minimal-risk stop, or the car leaving its lane.
    """

    def __init__(self, resolved: ResolvedSession, tracker: Tracker | None, ratio: float) -> None:
        self._settings = settings(resolved.cockpit, HZ)
        self._rest = uncalibrate(Intent(), self._settings)
        self._sample = self._rest
        self._tracker = tracker
        self._ratio = ratio
        self._alarmed = 0

    def publish(self, snapshot: Snapshot) -> None:
        if self._tracker is None or snapshot.tick % PERIOD_TICKS:
            return
        v, mode = snapshot.vehicle, snapshot.arbitration.mode
        taken = self._alarmed >= REACTION_S * HZ
        answer = self._tracker.step(Sighting(v.x_m, v.y_m, v.yaw_rad, v.vx_mps, v.vy_mps, v.yaw_rate_radps), taken)
        astray = abs(self._tracker.lateral_m) > ASTRAY_M
        if taken or mode == Mode.MINIMAL_RISK or astray:
            self._alarmed += PERIOD_TICKS
        if taken:
            intent = Intent(brake=BRAKE, hand_wheel_rad=self._ratio * answer.road_wheel_rad)
            self._sample = uncalibrate(intent, self._settings)

    def poll(self, tick: int) -> DeviceSample:
        return self._sample

    def close(self) -> None:
        pass


class InlineTracker:
    """The path tracker as command source and as reader of the state: one command every 20 ms, one tick later."""

    def __init__(self, tracker: Tracker) -> None:
        self._tracker = tracker
        self._command, self._received = NO_COMMAND, 0
        self._sequence = 0.0

    def publish(self, snapshot: Snapshot) -> None:
        if snapshot.tick % PERIOD_TICKS:
            return
        v = snapshot.vehicle
        engaged = snapshot.arbitration.mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED)
        answer = self._tracker.step(Sighting(v.x_m, v.y_m, v.yaw_rad, v.vx_mps, v.vy_mps, v.yaw_rate_radps), engaged)
        self._sequence += 1.0
        self._received = snapshot.tick + 1
        self._command = NO_COMMAND._replace(
            kind=float(RemoteKind.ACCELERATION),
            sequence=self._sequence,
            road_wheel_rad=answer.road_wheel_rad,
            road_wheel_radps=answer.road_wheel_radps,
            speed_mps=answer.speed_mps,
            accel_mps2=answer.accel_mps2,
        )

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        age = float(tick - self._received) if self._sequence else NO_COMMAND.age_ticks
        events = EventInput(float(Event.REQUEST_AUTONOMOUS)) if tick == ENGAGE_TICK else NO_EVENTS
        return self._command._replace(age_ticks=age), events


class Driven(NamedTuple):
    """A drive that is over."""

    rows: Any  # [ticks, columns]
    first_tick: int
    columns: tuple[str, ...]
    course: Course

    def column(self, name: str) -> Any:
        return self.rows[:, self.columns.index(name)]

    def tick_of(self, mode: Mode) -> int:
        """The first tick in a mode."""
        return self.first_tick + int(np.flatnonzero(self.column("arbitration.mode") == mode)[0])

    @property
    def modes(self) -> list[Mode]:
        """The modes, one after the other."""
        values = self.column("arbitration.mode")
        return [Mode(int(values[0])), *(Mode(int(value)) for value in values[1:][np.diff(values) != 0.0])]

    @property
    def reasons(self) -> list[Reason]:
        values = self.column("arbitration.mode")
        at = np.flatnonzero(np.diff(values, prepend=values[0]))
        return [Reason(int(value)) for value in self.column("arbitration.reason")[at]]

    @property
    def lateral_m(self) -> float:
        """How far from the lane's centre the car is at the end."""
        x, y, yaw = (float(self.column(f"vehicle.{name}")[-1]) for name in ("x_m", "y_m", "yaw_rad"))
        return self.course.project(x, y, None, yaw).lateral_m

    @property
    def at_rest(self) -> bool:
        return bool(abs(self.column("vehicle.vx_mps")[-1]) < 0.1)


class Circuit:
    """One compiled console, one drive over the whole course, and any number of drives from its rows."""

    def __init__(self) -> None:
        self.resolved = resolve(parse(SESSION, SessionProfile, "session"))
        assert self.resolved.world is not None
        self.course = Course(self.resolved.world)
        self._tracker = Tracker(self.course)  # fresh: its copies drive
        self.console: Console
        self.console, self.start = assemble(self.resolved, compiled)
        self.whole = self.drive(self.start, 300.0)

    def drive(
        self, state: ConsoleState, seconds: float, faults: Sequence[Fault] = (), attentive: bool = False
    ) -> Driven:
        """Drive on from a state."""
        scenario = msgspec.structs.replace(self.resolved.session.scenario, faults=tuple(faults))
        session = msgspec.structs.replace(self.resolved.session, scenario=scenario)
        resolved = msgspec.structs.replace(self.resolved, session=session)
        tracker = InlineTracker(copy(self._tracker))
        recorder = MemoryRecorder(round(seconds * HZ), self.console.width)
        person = Person(resolved, copy(self._tracker) if attentive else None, self.console.platform.steering_ratio)
        cast = Cast(person, tracker, recorder, (tracker, person), UnpacedPacer())
        if state.tick:
            tracker.publish(Snapshot(state.tick, HZ, state.row))
        run(self.console, state, isolated(with_faults(cast, resolved, HZ)), round(seconds * HZ))
        return Driven(recorder.rows, state.tick + 1, self.console.columns, self.course)

    def state_at(self, distance_m: float) -> ConsoleState:
        """The state in which the whole drive had come this far: a row is the whole state."""
        driven = self.whole.column("vehicle.distance_m")
        index = int(np.flatnonzero(driven >= distance_m)[0]) // PERIOD_TICKS * PERIOD_TICKS + PERIOD_TICKS - 1
        return ConsoleState(index + 1, self.whole.rows[index].copy())


@cache
def circuit() -> Circuit:
    """The one circuit of this test run."""
    return Circuit()
