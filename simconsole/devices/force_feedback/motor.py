"""The console's end of the wheel's motor: when a level is written, when the effect is started again, when it ends.

Pure: time comes in with the clock, the device is a `HapticPort`. The effect lasts 200 ms and is started again every
50 ms while ticks come: when the loop stands still or the process is stopped, the force ends by itself.
"""

from collections.abc import Callable
from typing import Final, NamedTuple, Protocol

from simconsole.devices.force_feedback.simulated_wheel import SimulatedWheel
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError
from simconsole.values.labels import eased_label, is_eased
from simconsole.values.latency import Hop
from simconsole.values.signals import MOTOR_UNKNOWN, DeviceSample
from simconsole.values.state_vector import Snapshot

EFFECT_S: Final = 0.2
REARM_S: Final = 0.05
_ROUNDING_S: Final = 1e-6


class Capability(NamedTuple):
    """What a wheel's motor can do."""

    name: str
    constant: bool = False  # force at all
    gain: bool = False
    autocentre: bool = False
    damper: bool = False


class HapticPort(Protocol):
    """One wheel's motor. Every method may raise DeviceError, after which the wheel counts as one without."""

    @property
    def capability(self) -> Capability:
        """What it can do; without `constant` the other methods do nothing."""

    def write(self, level: float) -> None:
        """Set the level of the constant effect, -1 to 1, in the device's own sign. It acts while the effect runs."""

    def start(self) -> None:
        """Start the effect, or start it again: it runs for EFFECT_S from now."""

    def stop(self) -> None:
        """End every effect at once. Twice is harmless."""

    def close(self) -> None:
        """Stop, set gain and autocentre for other programs, release the device. A second call does nothing."""


class NoHaptics:
    """A wheel without a motor, or one whose motor cannot be reached."""

    def __init__(self, reason: str = "no force feedback") -> None:
        self._reason = reason

    @property
    def capability(self) -> Capability:
        """Nothing."""
        return Capability(self._reason)

    def write(self, level: float) -> None:
        """Nothing."""

    def start(self) -> None:
        """Nothing."""

    def stop(self) -> None:
        """Nothing."""

    def close(self) -> None:
        """Nothing."""


class SimulatedWheelPort:
    """The motor of a simulated wheel, with effects that end by themselves."""

    def __init__(self, wheel: SimulatedWheel) -> None:
        self._wheel = wheel
        self._open = True

    @property
    def capability(self) -> Capability:
        """Constant force; no gain, autocentre or damper."""
        return Capability("simulated wheel", constant=self._open)

    def write(self, level: float) -> None:
        """Set the level."""
        self._need_open()
        self._wheel.write(level)

    def start(self) -> None:
        """Start the effect."""
        self._need_open()
        self._wheel.run(EFFECT_S)

    def stop(self) -> None:
        """End it."""
        if self._open:
            self._wheel.run(0.0)

    def close(self) -> None:
        """Let go."""
        self.stop()
        self._open = False

    def _need_open(self) -> None:
        if not self._open:
            raise DeviceError("simulated wheel: motor: value closed: an open port")


class WheelMotor:
    """An `Output` that turns each tick's torque into the device's effect."""

    hop = Hop.TORQUE

    def __init__(
        self,
        port: HapticPort,
        force: ForceFeedback,
        clock_s: Callable[[Snapshot], float],
        say: Callable[[str], None] = lambda line: None,
    ) -> None:
        """Open without force.

        Args:
            port: The device.
            force: Its profile.
            clock_s: The time of a snapshot in s: real in a paced drive, simulated in any other.
            say: Called with one line when there is no force, when it is lost, when it is back, and when the wheel
                gives less of the car's torque than there is, once in a drive.
        """
        self._port = port
        self._force = force
        self._sign = 1.0 if force.level_pushes == "left" else -1.0
        self._clock_s = clock_s
        self._gap_s = 1.0 / force.update_hz
        self._written_s = -1e9
        self._started_s = -1e9
        self._level = 0.0
        self._runs = False
        self._say = say
        self._eased = False  # somebody has been told
        self.failure: str | None = None
        self._tell(first=True)

    @property
    def obeys(self) -> bool:
        """Whether the motor is there and has not failed."""
        return self.failure is None and self._port.capability.constant

    @property
    def reason(self) -> str:
        """Why there is no force, where there is none."""
        return self.failure or self._port.capability.name

    def publish(self, snapshot: Snapshot) -> None:
        """Write one tick's torque to the device, on change and within its rate; only this keeps the effect running."""
        if not self.obeys:
            return
        try:
            torque = snapshot.torque
            if not self._eased and is_eased(torque.enabled, torque.car_share):
                self._eased = True
                self._say(f"{eased_label(torque.car_share)}: more of the car's torque would make this wheel swing")
            if torque.enabled > 0.0:
                self._drive(torque.torque_nm, self._clock_s(snapshot))
            elif self._runs:
                self._release()
        except DeviceError as error:
            self.failure = str(error)
            self._say(f"force feedback ends: {error}; everything else goes on")

    def exchange(self, port: HapticPort) -> None:
        """Take another device's motor, after the wheel was plugged in again."""
        self.close()
        self._port, self.failure = port, None
        self._tell(first=False)

    def _tell(self, first: bool) -> None:
        if not self.obeys:
            self._say(f"no force feedback: {self.reason}; everything else works")
        elif not first:
            self._say("force feedback is back")

    def close(self) -> None:
        """Release the wheel; a device that is gone already is no error."""
        self._runs, self._level = False, 0.0
        try:
            self._port.close()
        except DeviceError as error:
            self.failure = str(error)

    def _drive(self, torque_nm: float, now_s: float) -> None:
        steps = self._force.motor.level_steps
        share = min(1.0, max(-1.0, torque_nm / self._force.max_torque_nm))
        level = self._sign * round(share * steps) / steps
        if level != self._level and now_s - self._written_s >= self._gap_s - _ROUNDING_S:
            self._port.write(level)
            self._level, self._written_s = level, now_s
        if not self._runs or now_s - self._started_s >= REARM_S - _ROUNDING_S:
            self._port.start()
            self._runs, self._started_s = True, now_s

    def _release(self) -> None:
        self._runs, self._level = False, 0.0
        self._port.stop()
        self._port.write(0.0)


class Source(Protocol):
    """A `DeviceSource`."""

    def poll(self, tick: int) -> DeviceSample:
        """Return the newest sample."""

    def close(self) -> None:
        """Release the devices."""


class MotorisedSource:
    """A cockpit whose samples say whether the wheel's motor obeys: the console must know what may move the wheel."""

    def __init__(
        self, source: Source, motor: WheelMotor, replugged: Callable[[], HapticPort | None], known: bool = True
    ) -> None:
        """Wrap a source.

        Args:
            source: The cockpit.
            motor: Of its wheel.
            replugged: Returns a new port once after the wheel came back as a new device, else None.
            known: Whether its figures are, so that it may turn the wheel by itself.
        """
        self._source = source
        self._motor = motor
        self._replugged = replugged
        self._obeying = 1.0 if known else MOTOR_UNKNOWN

    def poll(self, tick: int) -> DeviceSample:
        """Return the newest sample for `tick`."""
        sample = self._source.poll(tick)
        port = self._replugged()
        if port is not None:
            self._motor.exchange(port)
        there = sample.wheel_age_ticks == 0.0 and self._motor.obeys
        return sample._replace(wheel_motor=self._obeying if there else 0.0)

    def close(self) -> None:
        """Release the devices."""
        self._source.close()
