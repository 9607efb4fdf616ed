"""The whole console around a simulated wheel: torque out, angle in, a controller that drives the urban course."""

import math

import msgspec

from simconsole.assembly import ResolvedSession, assemble
from simconsole.compiling import compiled
from simconsole.devices.motor import SimulatedWheelPort, WheelMotor
from simconsole.devices.settings import settings
from simconsole.devices.simulated_wheel import RELAXED, Arm, SimulatedWheel, step_wheel
from simconsole.devices.uncalibrate import Intent, uncalibrate, wheel_raw
from simconsole.pipeline import advance
from simconsole.profiles.force_feedback import Motor
from simconsole.rows import Snapshot, TickInputs
from simconsole.session_files import load_session, resolve
from simconsole.signals import NO_COMMAND, NO_EVENTS, Event, EventInput, Mode, RemoteCommand, RemoteKind
from simconsole.world.course import Course

SPEED_MPS = 10.0
LATERAL_MPS2 = 2.0
WHEELBASE_M = 2.6
CONTROL_HZ = 50


def resolved(tick_hz: int) -> ResolvedSession:
    session = load_session("demo")
    mode = msgspec.structs.replace(session.mode, tick_hz=tick_hz)
    return resolve(msgspec.structs.replace(session, mode=mode))


class Controller:
    """Steers by the course's curvature at the distance driven, lap after lap: the wheel's work, not a tracker's."""

    def __init__(self, session: ResolvedSession, tick_hz: int) -> None:
        assert session.world is not None
        self.course = Course(session.world)
        self.length_m = session.world.length_m
        self.period = tick_hz // CONTROL_HZ
        self.command = NO_COMMAND
        self.age = 1e9

    def take(self, tick: int, distance_m: float) -> RemoteCommand:
        self.age += 1.0
        if tick % self.period == 0:
            s_m = distance_m % self.length_m
            bend = max(abs(self.course.curvature_at((s_m + ahead) % self.length_m)) for ahead in (0.0, 5.0, 10.0, 20.0))
            self.age = 0.0
            self.command = NO_COMMAND._replace(
                kind=float(RemoteKind.SPEED),
                sequence=self.command.sequence + 1.0,
                direction=1.0,
                speed_mps=min(SPEED_MPS, math.sqrt(LATERAL_MPS2 / max(bend, 1e-4))),
                road_wheel_rad=math.atan(WHEELBASE_M * self.course.curvature_at(s_m)),
            )
        return self.command._replace(age_ticks=self.age)


class Loop:
    """One drive, tick by tick."""

    def __init__(self, tick_hz: int = 250, motor: Motor | None = None) -> None:
        """`motor`: what the wheel really is, where the profile is mistaken about it."""
        self.session = resolved(tick_hz)
        self.tick_hz = tick_hz
        self.console, self.state = assemble(self.session, compiled)
        cockpit = self.session.cockpit
        assert cockpit.force_feedback is not None
        self.force = cockpit.force_feedback
        self.settings = settings(cockpit, tick_hz)
        true = self.force if motor is None else msgspec.structs.replace(self.force, motor=motor)
        self.wheel = SimulatedWheel(true, cockpit.wheel.lock_to_lock_deg, tick_hz=tick_hz, step=compiled(step_wheel))
        self.motor = WheelMotor(SimulatedWheelPort(self.wheel), self.force, lambda shot: shot.t_s)
        self.rest = uncalibrate(Intent(), self.settings)._replace(wheel_motor=1.0)
        self.snapshot = Snapshot(0, tick_hz, self.state.row)
        self.controller = Controller(self.session, tick_hz)

    def tick(
        self, arm: Arm = RELAXED, hands_rad: float | None = None, events: EventInput = NO_EVENTS, **raw: float
    ) -> Snapshot:
        """One tick; `raw` replaces what the cockpit reads."""
        axis = wheel_raw(self.wheel.turn(arm, hands_rad), self.settings)
        sample = self.rest._replace(wheel_axis=round(axis * 32767.0) / 32768.0)
        if raw:
            sample = sample._replace(**raw)
        remote = self.controller.take(self.state.tick + 1, self.snapshot.vehicle.distance_m)
        self.state, self.snapshot = advance(self.state, TickInputs(sample, remote, events), self.console)
        self.motor.publish(self.snapshot)
        return self.snapshot

    def engage(self) -> None:
        """Hand over to the controller."""
        for _ in range(self.tick_hz):
            self.tick()
        self.tick(events=EventInput(float(Event.REQUEST_AUTONOMOUS)))
        assert self.snapshot.arbitration.mode == Mode.AUTONOMOUS, self.snapshot.arbitration

    def seconds(self, duration_s: float) -> range:
        return range(round(duration_s * self.tick_hz))
