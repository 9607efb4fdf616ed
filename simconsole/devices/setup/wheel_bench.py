"""The wheel on a bench, for the set-up commands: torque in, angle out, guarded; any key lets go."""

from collections.abc import Callable
from contextlib import ExitStack
from typing import Final, TypeAlias

import numpy as np

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.force_feedback.gentle_push import LIMIT_RAD, REST_RADPS, Gentle, move
from simconsole.devices.force_feedback.motor import HapticPort, SimulatedWheelPort, WheelMotor
from simconsole.devices.force_feedback.simulated_wheel import HANDS_OFF, SimulatedWheel
from simconsole.devices.haptics.back_ends import open_motor
from simconsole.devices.haptics.watchdog_client import open_watchdog, with_watchdog
from simconsole.devices.setup.device_commands import Pace, Say
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError
from simconsole.values.kernels import approach, clip
from simconsole.values.signals import NO_TORQUE
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from simconsole.values.units import DEG_PER_RAD, RAD_PER_DEG

Torque: TypeAlias = Callable[[float, float, float, float], float]
"""N m from (time in s, angle, rate of the wheel, motor's inertia)."""
LET_GO_S: Final = 0.25
WATCH_S: Final = 0.1
_AWAY_RAD: Final = 6.0 * RAD_PER_DEG
"""The wheel is let go of on its way from here through the centre: room enough on both sides."""


class WheelBench:
    """The wheel on a bench: torque in, angle out."""

    def __init__(
        self,
        cockpit: CockpitProfile,
        force: ForceFeedback,
        virtual: bool,
        tick_hz: int,
        pace: Callable[[int], Pace],
        pressed: Callable[[], bool],
        say: Say,
        stack: ExitStack,
    ) -> None:
        """Open the wheel and its motor; `stack` closes them.

        Args:
            cockpit: Whose wheel it is.
            force: Its force feedback.
            virtual: On a simulated wheel behind virtual devices; `hung_nm` is then a weight on its right side.
            tick_hz: Rate of the loop.
            pace: Makes a pace for a rate.
            pressed: Whether a key was pressed since it was asked last: it ends everything at once.
            say: Prints a line.
            stack: Closes what is opened here.

        Raises:
            DeviceError: a device is missing, or its motor cannot be reached.
        """
        self._tick_hz = tick_hz
        self._pace = pace
        self._pressed = pressed
        self._say = say
        self._begin()
        self._settings = cockpit_settings(cockpit, tick_hz)
        self._identity = next((at.vendor_id, at.product_id) for at in cockpit.roles if at.role == "wheel")
        self._plugged: VirtualCockpit | None = None
        self._wheel: SimulatedWheel | None = None
        if virtual:
            self._plugged = VirtualCockpit(cockpit)
            stack.callback(self._plugged.close)
            self._wheel = SimulatedWheel(force, cockpit.wheel.lock_to_lock_deg, tick_hz=tick_hz)
        self._source = SdlSource(cockpit)
        stack.callback(self._source.close)
        self.hung_nm = self._pull_nm = 0.0
        self._watchdog = None if virtual else open_watchdog(self._identity, say)
        if self._watchdog is not None:
            stack.callback(self._watchdog.close)
        self._ticks = 0
        self.motor = WheelMotor(self._port(force), force, lambda snapshot: snapshot.t_s)
        stack.callback(self.motor.close)
        if not self.motor.obeys:
            raise DeviceError(f"{cockpit.title}: no force feedback: {self.motor.reason}")
        self._rad = self._first_rad = self._angle()
        self._radps = 0.0

    def turn(self, torque_nm: float) -> float:
        """Let one tick pass with this torque and return the wheel's angle from where it was at first, in rad.

        Raises:
            DeviceError: the motor failed, or the wheel is further off than any push may turn it.
            KeyboardInterrupt: a key was pressed.
        """
        self._tick(torque_nm)
        if abs(self._rad - self._first_rad) > LIMIT_RAD:
            self._tick(0.0)
            raise DeviceError(f"wheel: angle: beyond {LIMIT_RAD * DEG_PER_RAD:.0f} deg by itself: the motor let go")
        return self._rad - self._first_rad

    def rest(self, seconds: float) -> None:
        """Let time pass without torque."""
        self._begin()
        for _ in range(round(seconds * self._tick_hz)):
            self._tick(0.0)

    def play(self, torque: Torque, length_s: float, inertia_kgm2: float, limit_nm: float) -> None:
        """Play a force for hands on the wheel."""
        self._begin()
        for tick in range(1, round(length_s * self._tick_hz) + 1):
            torque_nm = torque(tick / self._tick_hz, self._rad - self._first_rad, self._radps, inertia_kgm2)
            self._tick(clip(torque_nm, -limit_nm, limit_nm))
        self._tick(0.0)

    def abandon(self, rules: Gentle) -> tuple[float, bool]:
        """Set the wheel moving, then publish nothing more: return how far it went in deg, and whether it slows down."""
        move(self.turn, rules, -_AWAY_RAD, 1.0)
        start_rad = self._rad
        move(self.turn, rules, _AWAY_RAD, 1.0, moving=True)
        for _ in range(round(LET_GO_S * self._tick_hz)):
            self._look()
            self._heed_keys()
        ended_radps = abs(self._radps)
        for _ in range(round(WATCH_S * self._tick_hz)):
            self._look()
            self._heed_keys()
            if abs(self._rad - self._first_rad) > LIMIT_RAD:
                break
        slows = abs(self._radps) <= max(0.95 * ended_radps, REST_RADPS)
        moved_deg = (self._rad - start_rad) * DEG_PER_RAD
        self._tick(0.0)
        if slows:
            move(self.turn, rules, 0.0, 1.0)
        return moved_deg, slows

    def _begin(self) -> None:
        self._wait, self._waited = self._pace(self._tick_hz), 0

    def _tick(self, torque_nm: float) -> None:
        row = np.zeros(PLATFORM_AT)
        row[LAYOUT.torque.slice] = NO_TORQUE._replace(torque_nm=torque_nm, ramp=1.0, enabled=float(torque_nm != 0.0))
        self._look()
        self.motor.publish(Snapshot(self._ticks, self._tick_hz, row))
        if self.motor.failure is not None:
            raise DeviceError(self.motor.failure)
        self._heed_keys()

    def _heed_keys(self) -> None:
        """Let go of the wheel and give up where a key was pressed."""
        if self._pressed():
            row = np.zeros(PLATFORM_AT)
            row[LAYOUT.torque.slice] = NO_TORQUE
            self.motor.publish(Snapshot(self._ticks, self._tick_hz, row))
            self._say("A key was pressed: the wheel is let go, and that was all.")
            raise KeyboardInterrupt

    def _look(self) -> None:
        self._ticks += 1
        self._waited += 1
        self._wait(self._waited)
        if self._wheel is not None and self._plugged is not None:
            self._swing(self._wheel)
            self._plugged.write(raw_sample(Intent(hand_wheel_rad=self._wheel.state.rad), self._settings))
        before, self._rad = self._rad, self._angle()
        self._radps += 0.5 * ((self._rad - before) * self._tick_hz - self._radps)

    def _swing(self, wheel: SimulatedWheel) -> None:
        """Let a tick pass for the simulated wheel; a weight is hung on it, or taken off, within two seconds."""
        step_nm = max(self.hung_nm, self._pull_nm) / (2.0 * self._tick_hz)
        self._pull_nm = approach(self._pull_nm, self.hung_nm, step_nm)
        if self._pull_nm < 1e-3:
            wheel.turn(HANDS_OFF)
        else:
            wheel.turn(HANDS_OFF._replace(stiffness_nm_per_rad=1e4, limit_nm=self._pull_nm), wheel.state.rad - 1.0)

    def _angle(self) -> float:
        axis = self._source.poll(self._ticks).wheel_axis
        return (axis - self._settings.wheel_centre_raw) * self._settings.wheel_rad_per_raw

    def _port(self, force: ForceFeedback) -> HapticPort:
        if self._wheel is not None:
            return SimulatedWheelPort(self._wheel)
        number = self._source.instance_id("wheel")
        assert number is not None  # the source refuses a cockpit without one
        return with_watchdog(open_motor(number, self._identity, force), self._watchdog)
