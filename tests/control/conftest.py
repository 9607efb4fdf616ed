"""A seat, a controller and a vehicle of three lines around arbitration and gate, tick by tick."""

from collections.abc import Callable

import pytest

from simconsole.control.arbitration import arbitrate
from simconsole.control.gate import gate
from simconsole.control.requests.control_settings import ControlSettings, settings
from simconsole.control.requests.tick_context import TickContext
from simconsole.profiles.control import ControlProfile
from simconsole.values.signals import (
    NEVER_TICKS,
    ArbiterMemory,
    Arbitration,
    Button,
    Commander,
    DriverInput,
    Event,
    EventInput,
    Link,
    Mode,
    Reason,
    RemoteCommand,
    RemoteKind,
    Request,
    Validity,
    VehicleCommand,
    VehicleState,
)

RATIO = 15.0
LOCK_RAD = 0.6
WHEELBASE_M = 2.6
HZ = 250

PERSON = DriverInput(*(0.0,) * len(DriverInput._fields))._replace(
    wheel_validity=float(Validity.LIVE),
    throttle_validity=float(Validity.LIVE),
    brake_validity=float(Validity.LIVE),
    clutch_validity=float(Validity.LIVE),
    shifter_validity=float(Validity.LIVE),
)
NOBODY = DriverInput(*(0.0,) * len(DriverInput._fields))
SILENT = RemoteCommand(*(0.0,) * len(RemoteCommand._fields))._replace(age_ticks=NEVER_TICKS)
NO_LINK = Link(*(0.0,) * len(Link._fields))
VEHICLE = VehicleState(*(0.0,) * len(VehicleState._fields))._replace(
    engine_running=1.0, gear=1.0, coast_accel_mps2=-0.3, full_throttle_accel_mps2=3.0, full_brake_accel_mps2=-9.0
)
COMMAND = VehicleCommand(*(0.0,) * len(VehicleCommand._fields))


class Rig:
    """One drive of control/ alone. `vehicle` answers the pedals with what it says they give."""

    def __init__(
        self, tick_hz: int = HZ, profile: ControlProfile | None = None, preferred: Commander = Commander.ROS
    ) -> None:
        self.tick_hz = tick_hz
        self.tick_s = 1.0 / tick_hz
        self.settings: ControlSettings = settings(
            profile or ControlProfile(), RATIO, LOCK_RAD, WHEELBASE_M, tick_hz, preferred
        )
        self.driver = PERSON
        self.remote = SILENT
        self.ecu = SILENT
        self.ros_link = self.ecu_link = NO_LINK
        self.ages_before = (NEVER_TICKS, NEVER_TICKS)
        self.sending = False
        self.ecu_sending = False
        self.period_ticks = max(1, tick_hz // 50)
        self.vehicle = VEHICLE
        self.memory = ArbiterMemory(*(0.0,) * len(ArbiterMemory._fields))
        self.arbitration = Arbitration(*(0.0,) * len(Arbitration._fields))
        self.command = COMMAND
        self.request: Request | None = None
        self.human_nm = 0.0
        self.wheel_motor = 0.0
        self.ticks = 0

    @property
    def mode(self) -> Mode:
        return Mode(int(self.arbitration.mode))

    @property
    def reason(self) -> Reason:
        return Reason(int(self.arbitration.reason))

    @property
    def refusal(self) -> Reason | None:
        return Reason(int(self.arbitration.refusal)) if self.arbitration.refusal else None

    def tick(self, event: Event | int = 0, edge: Button | int = 0, ecu_event: Event | int = 0) -> None:
        """Advance by one tick with these edges."""
        self.ticks += 1
        if self.sending and self.ticks % self.period_ticks == 0:
            self.remote = self.remote._replace(sequence=self.remote.sequence + 1.0, age_ticks=0.0)
        elif self.remote.sequence > 0.0:
            self.remote = self.remote._replace(age_ticks=self.remote.age_ticks + 1.0)
        if self.ecu_sending and self.ticks % self.period_ticks == 0:
            self.ecu = self.ecu._replace(sequence=self.ecu.sequence + 1.0, age_ticks=0.0)
        elif self.ecu.sequence > 0.0:
            self.ecu = self.ecu._replace(age_ticks=self.ecu.age_ticks + 1.0)
        self.memory, self.ros_link, self.ecu_link, self.arbitration, self.request = arbitrate(
            self.moment(event, edge, ecu_event)
        )
        self.ages_before = (self.remote.age_ticks, self.ecu.age_ticks)
        remote = self.ecu if self.arbitration.commander == Commander.ECU else self.remote
        self.command = gate(
            self.request, remote, self.arbitration, self.command, self.vehicle, self.settings, self.tick_s, 0.0
        )
        self._move()

    def moment(self, event: Event | int = 0, edge: Button | int = 0, ecu_event: Event | int = 0) -> TickContext:
        """Return what arbitration would decide from now."""
        return TickContext(
            self.driver._replace(edges=float(edge), pressed=float(int(self.driver.pressed) | int(edge))),
            self.remote,
            self.ecu,
            EventInput(float(event), ecu_events=float(ecu_event)),
            self.vehicle,
            self.memory,
            self.ros_link,
            self.ecu_link,
            *self.ages_before,
            self.arbitration,
            self.command,
            0.0,
            0.0,
            self.human_nm,
            0.0,
            0.0,
            self.wheel_motor,
            self.settings,
            self.tick_s,
        )

    def _move(self) -> None:
        v = self.vehicle
        accel = v.coast_accel_mps2
        accel += self.command.throttle * (v.full_throttle_accel_mps2 - v.coast_accel_mps2)
        accel += self.command.brake * (v.full_brake_accel_mps2 - v.coast_accel_mps2)
        speed = max(0.0, v.vx_mps + accel * self.tick_s)
        self.vehicle = v._replace(
            vx_mps=speed, ax_mps2=(speed - v.vx_mps) / self.tick_s, road_wheel_rad=self.command.road_wheel_rad
        )

    def run(self, seconds: float) -> None:
        """Advance by at least this long."""
        for _ in range(round(seconds * self.tick_hz + 0.499)):
            self.tick()

    def until(self, mode: Mode, limit_ticks: int = 100_000) -> int:
        """Advance until `mode`, and return how many ticks that took."""
        for count in range(limit_ticks):
            if self.mode is mode:
                return count
            self.tick()
        raise AssertionError(f"still {self.mode.name} after {limit_ticks} ticks, not {mode.name}")

    def send(self, kind: RemoteKind = RemoteKind.ACCELERATION, **fields: float) -> None:
        """Let the controller send at 50 Hz from now on."""
        base = SILENT._replace(age_ticks=0.0, refused=self.remote.refused, direction=1.0)
        self.remote = base._replace(kind=float(kind), sequence=self.remote.sequence + 1.0, **fields)
        self.sending = True

    def send_ecu(self, kind: RemoteKind = RemoteKind.ACCELERATION, **fields: float) -> None:
        """Let the ECU send at 50 Hz from now on."""
        base = SILENT._replace(age_ticks=0.0, direction=1.0)
        self.ecu = base._replace(kind=float(kind), sequence=self.ecu.sequence + 1.0, **fields)
        self.ecu_sending = True

    def refuse(self, count: int = 1) -> None:
        """Let the bridge refuse commands of the controller."""
        self.remote = self.remote._replace(refused=self.remote.refused + count)

    def drive(self, mode: Mode, speed_mps: float = 10.0) -> "Rig":
        """Get into `mode` the way it is got into, at a speed."""
        standing = mode in (Mode.PARKED, Mode.STOPPED)
        if mode is Mode.PARKED:
            self.driver = NOBODY
            self.tick()
            return self
        self.run(1.0)
        assert self.mode is Mode.MANUAL
        self.vehicle = self.vehicle._replace(vx_mps=0.0 if standing else speed_mps)
        self.send()
        self.run(0.3)
        if mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED):
            self.tick(Event.REQUEST_AUTONOMOUS)
        if mode is Mode.TAKEOVER_REQUESTED:
            self.tick(Event.REQUEST_TAKEOVER)
        if mode is Mode.SHARED:
            self.tick(Event.REQUEST_SHARED)
        if mode in (Mode.MINIMAL_RISK, Mode.STOPPED):
            self.tick(Event.LOOP_STALL)
        if mode is Mode.STOPPED:
            self.until(mode)
        if mode is Mode.EMERGENCY_STOP:
            self.tick(Event.EMERGENCY_STOP)
        assert self.mode is mode
        return self


@pytest.fixture
def rig() -> Rig:
    return Rig()


@pytest.fixture
def make_rig() -> Callable[..., Rig]:
    return Rig


@pytest.fixture
def control() -> ControlSettings:
    return settings(ControlProfile(), RATIO, LOCK_RAD, WHEELBASE_M, HZ)
