"""Drives over the urban course with the path tracker in the loop: whole, and from any state of an earlier drive."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from copy import copy
from functools import cache, cached_property
from typing import Any, NamedTuple

import msgspec
import numpy as np

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.drivers.path_tracker.tracker import Tracker
from simconsole.faults.schedule import with_faults
from simconsole.profiles.faults import Fault
from simconsole.profiles.files.loader import parse
from simconsole.profiles.session import SessionProfile
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.resolution import resolve
from simconsole.tick.advance import Console, ConsoleState
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.tick.isolation import isolated
from simconsole.tick.loop import Components, Pace, run
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import Row
from simconsole.values.protocols import Output
from simconsole.values.signals import (
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
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import open_world
from simconsole.world.route import Route

HZ = 250
PERIOD_TICKS = 5
SESSION = "schema: 1\nenvironment: {world: urban}\nscenario: {vehicle: hatchback}\ndevices: {driver: none}\n"
ENGAGE_TICK = 2 * HZ
REST_S = 2.0
"""Who stands for so long is at rest: nothing new comes in such a drive."""
LANE_M = 3.5
CAR_M = 1.8
STANDING_MPS = 0.1
ASTRAY_M = 0.2
PLACES = {"straight": 150.0, "bend": 330.0, "roundabout": 1010.0}
"""Where on the course a fault comes, in m from its start."""


REACTION_S = 1.15
"""The benchmark driver of UN R157: 0.4 s to see the risk, 0.75 s to the first deceleration."""
BRAKE = 0.4
CRUISING = 0.2
"""Throttle of a person who holds the speed; they give more by 1 per m/s that is missing."""


class Crew(NamedTuple):
    """Who is there. The controller drives, or the person `by_hand`; an `attentive` person answers the alarm."""

    controller: bool = True
    by_hand: bool = False
    attentive: bool = False


AUTOPILOT = Crew()
WATCHED = Crew(attentive=True)
BY_HAND = Crew(by_hand=True)
BY_HAND_ALONE = Crew(controller=False, by_hand=True)


class Person:
    """Sits with hands and feet at rest. An attentive one brakes and steers along the lane once the alarm has lasted.

    The alarm is the minimal-risk stop, or the car leaving its lane.
    """

    def __init__(self, resolved: ResolvedSession, tracker: Tracker | None, ratio: float) -> None:
        self._settings = cockpit_settings(resolved.cockpit, HZ)
        self._rest = raw_sample(Intent(), self._settings)
        self._sample = self._rest
        self._tracker = tracker
        self._ratio = ratio
        self._alarmed = 0

    def publish(self, snapshot: Snapshot) -> None:
        if self._tracker is None or snapshot.tick % PERIOD_TICKS:
            return
        v, mode = snapshot.vehicle, snapshot.arbitration.mode
        taken = self._alarmed >= REACTION_S * HZ
        answer = self._tracker.step(VehicleMotion(v.x_m, v.y_m, v.yaw_rad, v.vx_mps, v.vy_mps, v.yaw_rate_radps), taken)
        astray = abs(self._tracker.lateral_m) > ASTRAY_M
        if taken or mode == Mode.MINIMAL_RISK or astray:
            self._alarmed += PERIOD_TICKS
        if taken:
            intent = Intent(brake=BRAKE, hand_wheel_rad=self._ratio * answer.road_wheel_rad)
            self._sample = raw_sample(intent, self._settings)

    def poll(self, tick: int) -> DeviceSample:
        return self._sample

    def close(self) -> None:
        pass


class PersonAtTheWheel:
    """Has taken over by hand before the first tick, and steers along the lane at the speed that the car had.

    When the console stops the car, feet off the pedals and hands with the wheels; an attentive one brakes then.
    """

    def __init__(
        self, resolved: ResolvedSession, tracker: Tracker, ratio: float, start: Snapshot, attentive: bool
    ) -> None:
        self._settings = cockpit_settings(resolved.cockpit, HZ)
        self._tracker = tracker
        self._ratio = ratio
        self._attentive = attentive
        self._alarmed = 0
        self._speed_mps = start.vehicle.vx_mps
        self._intent = Intent(hand_wheel_rad=ratio * start.command.road_wheel_rad)

    def publish(self, snapshot: Snapshot) -> None:
        if snapshot.tick % PERIOD_TICKS:
            return
        v = snapshot.vehicle
        answer = self._tracker.step(VehicleMotion(v.x_m, v.y_m, v.yaw_rad, v.vx_mps, v.vy_mps, v.yaw_rate_radps))
        stopping = snapshot.arbitration.mode == Mode.MINIMAL_RISK
        self._alarmed += PERIOD_TICKS if stopping or self._alarmed else 0
        throttle = 0.0 if self._alarmed else min(1.0, max(0.0, CRUISING + self._speed_mps - v.vx_mps))
        brake = BRAKE if self._attentive and self._alarmed >= REACTION_S * HZ else 0.0
        angle = snapshot.command.road_wheel_rad if stopping else answer.road_wheel_rad
        self._intent = Intent(throttle=throttle, brake=brake, hand_wheel_rad=self._ratio * angle)

    def poll(self, tick: int) -> DeviceSample:
        return raw_sample(self._intent, self._settings)

    def close(self) -> None:
        pass


class LoopTracker:
    """The path tracker as command source and as reader of the state: one command every 20 ms, one tick later.

    What operators ask for comes the same way: `asks` by tick.
    """

    def __init__(self, tracker: Tracker, asks: Mapping[int, Event], silent: bool) -> None:
        self._tracker = tracker
        self._asks, self._silent = asks, silent
        self._command, self._received = NO_COMMAND, 0
        self._sequence = 0.0

    def publish(self, snapshot: Snapshot) -> None:
        if snapshot.tick % PERIOD_TICKS:
            return
        v = snapshot.vehicle
        engaged = snapshot.arbitration.mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED)
        answer = self._tracker.step(
            VehicleMotion(v.x_m, v.y_m, v.yaw_rad, v.vx_mps, v.vy_mps, v.yaw_rate_radps), engaged
        )
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
        events = EventInput(float(self._asks[tick])) if tick in self._asks else NO_EVENTS
        if self._silent or not self._sequence:
            return NO_COMMAND, events
        return self._command._replace(age_ticks=float(tick - self._received)), events


class Rest:
    """Whether a drive is over: the car stands, and has for a while."""

    def __init__(self) -> None:
        self._ticks = 0

    def __call__(self, snapshot: Snapshot) -> bool:
        self._ticks = self._ticks + 1 if abs(snapshot.vehicle.vx_mps) < STANDING_MPS else 0
        return self._ticks >= REST_S * HZ


class Driven(NamedTuple):
    """A drive that is over."""

    vectors: Any  # [ticks, columns]
    first_tick: int
    columns: Sequence[str]
    course: Route

    def column(self, name: str) -> Any:
        return self.vectors[:, self.columns.index(name)]

    def only(self, columns: Sequence[str]) -> "Driven":
        """The drive with these columns alone: a drive of 20 s is 14 MB, and there are a hundred of them."""
        return self._replace(vectors=self.vectors[:, [self.columns.index(one) for one in columns]], columns=columns)

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
        return bool(abs(self.column("vehicle.vx_mps")[-1]) < STANDING_MPS)


class Rows:
    """Keeps some columns alone, for all of a drive over the whole course are 200 MB, or all; no hash, as a log has."""

    digest = b""

    def __init__(self, ticks: int, width: int, columns: Sequence[int] | None) -> None:
        self._room = np.empty((ticks, width if columns is None else len(columns)))
        self._columns = columns
        self.ticks = 0

    @property
    def vectors(self) -> Row:
        return self._room[: self.ticks]

    def write(self, snapshot: Snapshot) -> int:
        return self.write_block(snapshot.tick, snapshot.vector[np.newaxis])[1]

    def write_block(self, tick: int, vectors: Row) -> tuple[int, int]:
        """Keep the ticks from `tick` on."""
        begin, self.ticks = self.ticks, self.ticks + len(vectors)
        self._room[begin : self.ticks] = vectors if self._columns is None else vectors[:, self._columns]
        return len(vectors), 0


class Circuit:
    """One compiled console, drives over the course from its start, and any number of drives from their rows."""

    def __init__(self) -> None:
        self.resolved = resolve(parse(SESSION, SessionProfile, "session"))
        assert self.resolved.world is not None
        self.course = open_world(self.resolved.world).route
        self.tracker = Tracker(self.course)  # fresh: its copies drive
        self.console: Console
        self.console, self.start = assemble(self.resolved, compiled)
        self.columns = self.console.columns
        self._states: dict[float, ConsoleState] = {}

    @cached_property
    def whole(self) -> Driven:
        """The drive over the whole course, as far as tests look at it."""
        return self.drive(self.start, 300.0, columns=("vehicle.distance_m", "ros_link.implausible"))

    def drive(
        self,
        state: ConsoleState,
        seconds: float,
        faults: Sequence[Fault] = (),
        crew: Crew = AUTOPILOT,
        pace: Pace | None = None,
        outputs: Sequence[Output] = (),
        controller: LoopTracker | None = None,
        finished: Callable[[Snapshot], bool] = lambda _: False,
        columns: Sequence[str] | None = None,
    ) -> Driven:
        """Drive on from a state, for so long or until it is `finished`; keep these columns, or all."""
        scenario = msgspec.structs.replace(self.resolved.session.scenario, faults=tuple(faults))
        session = msgspec.structs.replace(self.resolved.session, scenario=scenario)
        resolved = msgspec.structs.replace(self.resolved, session=session)
        start = Snapshot(state.tick, HZ, state.vector)
        asks = {
            ENGAGE_TICK: Event.REQUEST_AUTONOMOUS,
            **({state.tick + 1: Event.REQUEST_MANUAL} if crew.by_hand else {}),
        }
        tracker = controller or LoopTracker(copy(self.tracker), asks, not crew.controller)
        kept = self.columns if columns is None else tuple(columns)
        chosen = None if columns is None else [self.columns.index(name) for name in kept]
        recorder = Rows(round(seconds * HZ), len(self.columns), chosen)
        ratio = self.console.platform.steering_ratio
        person = (
            PersonAtTheWheel(resolved, copy(self.tracker), ratio, start, crew.attentive)
            if crew.by_hand
            else Person(resolved, copy(self.tracker) if crew.attentive else None, ratio)
        )
        components = Components(person, tracker, recorder, (tracker, person, *outputs), pace or UnpacedPacer())
        if state.tick:
            tracker.publish(start)
        isolated_components = isolated(with_faults(components, resolved, HZ), UnpacedPacer)
        ticks = round(seconds * HZ)
        run(self.console, state, isolated_components, ticks, finished)
        return Driven(recorder.vectors, state.tick + 1, kept, self.course)

    def state_at(self, distance_m: float) -> ConsoleState:
        """The state in which a drive over the course has come this far: a row is the whole state."""
        self.pass_by([distance_m])
        return self._states[distance_m]

    def pass_by(self, distances_m: Iterable[float]) -> None:
        """Drive once, and keep the state at each of these distances, where the controller has just had its period."""
        left = sorted(distance_m for distance_m in distances_m if distance_m not in self._states)

        def passed(shot: Snapshot) -> bool:
            while left and shot.tick % PERIOD_TICKS == 0 and shot.vehicle.distance_m >= left[0]:
                self._states[left.pop(0)] = ConsoleState(shot.tick, shot.vector.copy())
            return not left

        if left:
            self.drive(self.start, 300.0, finished=passed, columns=())


@cache
def circuit() -> Circuit:
    """The one circuit of this test run."""
    return Circuit()
