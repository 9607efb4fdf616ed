"""The whole console around a simulated wheel: torque out, angle in, a controller that drives the urban course."""

import math

import msgspec

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample, wheel_raw
from simconsole.devices.force_feedback.motor import SimulatedWheelPort, WheelMotor
from simconsole.devices.force_feedback.simulated_wheel import RELAXED, Arm, SimulatedWheel, step_wheel
from simconsole.profiles.force_feedback import ForceFeedback, Motor
from simconsole.session.resolution import load_session, override, resolve
from simconsole.tick.advance import advance_vector
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.host.jit import compiled
from simconsole.values.signals import (
    NO_COMMAND,
    NO_EVENTS,
    Event,
    EventInput,
    Mode,
    RemoteCommand,
    RemoteKind,
)
from simconsole.values.state_vector import LAYOUT, Snapshot, TickInputs, input_vector
from simconsole.world.kinds.worlds import open_world

SPEED_MPS = 10.0
LATERAL_MPS2 = 2.0
WHEELBASE_M = 2.6
CONTROL_HZ = 50
DISTANCE_AT = LAYOUT.vehicle.at("distance_m")
MODE_AT = LAYOUT.arbitration.at("mode")


def resolved(tick_hz: int) -> ResolvedSession:
    session = override(load_session("demo"), environment={"world": "urban", "traffic": None})
    mode = msgspec.structs.replace(session.mode, tick_hz=tick_hz)
    return resolve(msgspec.structs.replace(session, mode=mode))


class Controller:
    """Steers by the course's curvature at the distance driven, lap after lap: the wheel's work, not a tracker's."""

    def __init__(self, session: ResolvedSession, tick_hz: int, grid_m: float) -> None:
        assert session.world is not None
        course, self.grid_m = open_world(session.world).route, grid_m
        self.cells = round(course.length_m / grid_m)
        bends = [course.curvature_at(cell * grid_m) for cell in range(self.cells)]
        window = range(0, round(20.0 / grid_m), max(1, round(1.0 / grid_m)))
        ahead = [max(abs(bends[(cell + far) % self.cells]) for far in window) for cell in range(self.cells)]
        self.steers = [math.atan(WHEELBASE_M * bend) for bend in bends]
        self.speeds = [min(SPEED_MPS, math.sqrt(LATERAL_MPS2 / max(bend, 1e-4))) for bend in ahead]
        self.period = tick_hz // CONTROL_HZ
        self.command = NO_COMMAND
        self.age = 1e9

    def take(self, tick: int, distance_m: float) -> RemoteCommand:
        self.age += 1.0
        if tick % self.period == 0:
            cell = int(distance_m / self.grid_m) % self.cells
            self.age = 0.0
            self.command = NO_COMMAND._replace(
                kind=float(RemoteKind.SPEED),
                sequence=self.command.sequence + 1.0,
                direction=1.0,
                speed_mps=self.speeds[cell],
                road_wheel_rad=self.steers[cell],
            )
        return self.command._replace(age_ticks=self.age)


class Loop:
    """One drive, tick by tick."""

    def __init__(
        self,
        tick_hz: int = 250,
        motor: Motor | None = None,
        grid_m: float = 0.2,
        wheel: tuple[ForceFeedback, ForceFeedback] | None = None,
    ) -> None:
        """Start.

        Args:
            tick_hz: Of the session.
            motor: What the wheel really is, where the profile is mistaken about it.
            grid_m: How often the controller looks at the curvature: a coarse one steers in jerks.
            wheel: The wheel as it is, and as the profile says.
        """
        self.session = resolved(tick_hz)
        if wheel is not None:
            cockpit = msgspec.structs.replace(self.session.cockpit, force_feedback=wheel[1])
            self.session = msgspec.structs.replace(self.session, cockpit=cockpit)
        self.tick_hz = tick_hz
        self.console, state = assemble(self.session, compiled)
        cockpit = self.session.cockpit
        assert cockpit.force_feedback is not None
        self.force = cockpit.force_feedback
        self.settings = cockpit_settings(cockpit, tick_hz)
        true = self.force if wheel is None else wheel[0]
        true = true if motor is None else msgspec.structs.replace(true, motor=motor)
        self.wheel = SimulatedWheel(true, cockpit.wheel.lock_to_lock_deg, tick_hz=tick_hz, step=compiled(step_wheel))
        self.motor = WheelMotor(SimulatedWheelPort(self.wheel), self.force, lambda shot: shot.t_s)
        self.rest = raw_sample(Intent(), self.settings)._replace(wheel_motor=1.0)
        self.snapshot = Snapshot(0, tick_hz, state.vector)
        self.controller = Controller(self.session, tick_hz, grid_m)

    def tick(
        self, arm: Arm = RELAXED, hands_rad: float | None = None, events: EventInput = NO_EVENTS, **raw: float
    ) -> Snapshot:
        """One tick; `raw` replaces what the cockpit reads."""
        axis = wheel_raw(self.wheel.turn(arm, hands_rad), self.settings)
        sample = self.rest._replace(wheel_axis=round(axis * 32767.0) / 32768.0)
        if raw:
            sample = sample._replace(**raw)
        tick, before = self.snapshot.tick + 1, self.snapshot.vector
        remote = self.controller.take(tick, before[DISTANCE_AT])
        row = advance_vector(before, input_vector(TickInputs(sample, remote, events)), self.console)
        self.snapshot = Snapshot(tick, self.tick_hz, row)
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
