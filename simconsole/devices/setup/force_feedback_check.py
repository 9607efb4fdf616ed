"""`simconsole devices feel`: play every force once, gently, the sign test first. Measure those that turn the wheel."""

import math
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.force_feedback.motor import HapticPort, SimulatedWheelPort, WheelMotor
from simconsole.devices.force_feedback.simulated_wheel import HANDS_OFF, SimulatedWheel
from simconsole.devices.haptics.back_ends import open_motor
from simconsole.devices.haptics.watchdog_client import open_watchdog, with_watchdog
from simconsole.devices.setup.device_commands import Pace, Say, answer, realtime
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError
from simconsole.values.signals import NO_TORQUE
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from simconsole.values.units import DEG_PER_RAD

TURNED_DEG: Final = 3.0
"""From this angle on the wheel's own motion shows the direction of a steady force."""
PUSH_S: Final = 0.5
PAUSE_S: Final = 0.6
LET_GO_S: Final = 0.25
COAST_RADPS: Final = 0.05
_TEXTURE_HZ: Final = 20.0


class Force(NamedTuple):
    """One force to feel: its torque as a share of the strength, from (time in s, angle and rate of the wheel)."""

    name: str
    length_s: float
    torque: Callable[[float, float, float], float]
    turns: float  # 1: it turns the wheel to the left, -1: to the right, 0: it does not turn it
    question: str


FORCES: Final = (
    Force("sign", PUSH_S, lambda t, rad, radps: 1.0, 1.0, "Which way did the wheel pull?"),
    Force("left", PUSH_S, lambda t, rad, radps: 1.0, 1.0, "Did it pull to the LEFT?"),
    Force("right", PUSH_S, lambda t, rad, radps: -1.0, -1.0, "Did it pull to the RIGHT?"),
    Force("texture", 1.0, lambda t, rad, radps: 0.4 * math.sin(2.0 * math.pi * _TEXTURE_HZ * t), 0.0, "A fine shiver?"),
    Force("damping", 3.0, lambda t, rad, radps: -0.5 * radps, 0.0, "Turn it: does it resist turning fast?"),
    Force("friction", 3.0, lambda t, rad, radps: -radps / (abs(radps) + 1.0), 0.0, "Turn it: does it drag?"),
    Force("centre", 3.0, lambda t, rad, radps: -2.0 * rad - 0.3 * radps, 0.0, "Turn it: does it come back?"),
)


def check_force_feedback(
    cockpit: CockpitProfile,
    *,
    say: Say,
    ask: Callable[[str], str] = input,
    strength: float = 0.25,
    virtual: bool = False,
    tick_hz: int = 250,
    pace: Callable[[int], Pace] = realtime,
) -> dict[str, Any]:
    """Play each force and judge it: by the wheel's own motion where it turned, else by the person's word.

    Args:
        cockpit: With force feedback.
        say: Prints a line.
        ask: Puts a question; asked only where the wheel did not turn by itself.
        strength: Share of the motor's torque, 0.05 to 0.6.
        virtual: On a simulated wheel behind virtual devices.
        tick_hz: Rate of the loop.
        pace: Makes a pace for a rate.

    Returns:
        Plain values; `ok` is False where a force was not as it should be.

    Raises:
        DeviceError: a device is missing, or the cockpit or its driver has no force feedback.
    """
    force = cockpit.force_feedback
    if force is None:
        raise DeviceError(f"{cockpit.title}: force_feedback: value missing: a profile of a wheel with a motor")
    if not 0.05 <= strength <= 0.6:
        raise DeviceError(f"strength: value {strength:g}: 0.05 to 0.6")
    with ExitStack() as stack:
        bench = _Bench(cockpit, force, virtual, tick_hz, say, stack)
        if not bench.motor.obeys:
            raise DeviceError(f"{cockpit.title}: no force feedback: {bench.motor.reason}")
        say(f"{cockpit.title}: {len(FORCES)} forces at {strength:.0%}. Hands off, fingers away from the spokes.")
        peak_nm = strength * force.max_torque_nm
        results = {}
        for kind in FORCES:
            turned_deg = bench.play(kind, peak_nm, pace(tick_hz))
            results[kind.name] = _judge(kind, turned_deg, ask, say, force)
            if kind.name == "sign" and not results["sign"]["ok"]:
                break  # every other force would have the wrong sign, too
        results["let go"] = _let_go(bench, peak_nm, pace(tick_hz), say)
    return {
        "cockpit": cockpit.title,
        "ok": all(result["ok"] for result in results.values()) and len(results) == len(FORCES) + 1,
        "forces": results,
    }


def _judge(kind: Force, turned_deg: float, ask: Callable[[str], str], say: Say, force: ForceFeedback) -> dict[str, Any]:
    if kind.turns and abs(turned_deg) >= TURNED_DEG:
        ok = turned_deg * kind.turns > 0.0
        how = f"turned {abs(turned_deg):.0f} deg to the {'left' if turned_deg > 0.0 else 'right'}"
    elif kind.name == "sign":
        typed = answer(ask, f"{kind.question} [l]eft, [r]ight, [n]ot at all: ").strip().lower()[:1]
        ok, how = typed == "l", {"l": "left", "r": "right"}.get(typed, "not at all")
    else:
        ok = answer(ask, f"{kind.name}: {kind.question} [y/n]: ").strip().lower()[:1] == "y"
        how = "felt" if ok else "not felt"
    say(f"{kind.name}: {how}: {'good' if ok else 'WRONG'}")
    if kind.name == "sign" and not ok and how != "not at all":
        other = "right" if force.level_pushes == "left" else "left"
        say(f"force_feedback.level_pushes: value {force.level_pushes}: {other}; this motor pushes the other way")
    return {"ok": ok, "how": how, "turned_deg": round(turned_deg, 1)}


def _let_go(bench: "_Bench", peak_nm: float, wait: Pace, say: Say) -> dict[str, Any]:
    """Test by the wheel's motion that an effect which is not started again ends by itself; return the result."""
    moved_deg = bench.abandon(peak_nm, wait)
    say(f"let go: {moved_deg:.0f} deg further after {LET_GO_S:g} s without a tick")
    return {"ok": bench.is_slowing, "how": "the effect ended by itself", "turned_deg": round(moved_deg, 1)}


class _Bench:
    """The wheel on a bench: torque in, angle out."""

    def __init__(
        self, cockpit: CockpitProfile, force: ForceFeedback, virtual: bool, tick_hz: int, say: Say, stack: ExitStack
    ) -> None:
        self._tick_hz = tick_hz
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
        self._watchdog = None if virtual else open_watchdog(self._identity, say)
        if self._watchdog is not None:
            stack.callback(self._watchdog.close)
        self._ticks = 0
        self.motor = WheelMotor(self._port(force), force, lambda snapshot: snapshot.t_s)
        stack.callback(self.motor.close)
        self._rad = self._angle()
        self._radps = 0.0
        self.is_slowing = True

    def play(self, kind: Force, peak_nm: float, wait: Pace) -> float:
        """Play one force, then pause; return how far the wheel turned in deg, left-positive."""
        start_rad = self._rad
        ticks = round(kind.length_s * self._tick_hz)
        for tick in range(1, ticks + 1):
            wait(tick)
            share = kind.torque(tick / self._tick_hz, self._rad - start_rad, self._radps)
            self._step(min(1.0, max(-1.0, share)) * peak_nm, 1.0)
        turned_deg = (self._rad - start_rad) * DEG_PER_RAD
        for tick in range(ticks + 1, ticks + round(PAUSE_S * self._tick_hz) + 1):
            wait(tick)
            self._step(0.0, 0.0)
        return turned_deg

    def abandon(self, peak_nm: float, wait: Pace) -> float:
        """Push, then publish nothing more; return how far the wheel went after the effect must have ended."""
        push = round(0.1 * self._tick_hz)
        quiet = push + round(LET_GO_S * self._tick_hz)
        for tick in range(1, push + 1):
            wait(tick)
            self._step(peak_nm, 1.0)
        for tick in range(push + 1, quiet + 1):
            wait(tick)
            self._look()
        ended_rad, ended_radps = self._rad, abs(self._radps)
        for tick in range(quiet + 1, quiet + self._tick_hz // 2 + 1):
            wait(tick)
            self._look()
        self.is_slowing = abs(self._radps) <= max(ended_radps, COAST_RADPS)
        return (self._rad - ended_rad) * DEG_PER_RAD

    def _step(self, torque_nm: float, enabled: float) -> None:
        row = np.zeros(PLATFORM_AT)
        row[LAYOUT.torque.slice] = NO_TORQUE._replace(torque_nm=torque_nm, ramp=1.0, enabled=enabled)
        self._look()
        self.motor.publish(Snapshot(self._ticks, self._tick_hz, row))
        if self.motor.failure is not None:
            raise DeviceError(self.motor.failure)

    def _look(self) -> None:
        self._ticks += 1
        if self._wheel is not None and self._plugged is not None:
            self._wheel.turn(HANDS_OFF)
            self._plugged.write(raw_sample(Intent(hand_wheel_rad=self._wheel.state.rad), self._settings))
        before, self._rad = self._rad, self._angle()
        self._radps += 0.2 * ((self._rad - before) * self._tick_hz - self._radps)

    def _angle(self) -> float:
        axis = self._source.poll(self._ticks).wheel_axis
        return (axis - self._settings.wheel_centre_raw) * self._settings.wheel_rad_per_raw

    def _port(self, force: ForceFeedback) -> HapticPort:
        if self._wheel is not None:
            return SimulatedWheelPort(self._wheel)
        number = self._source.instance_id("wheel")
        assert number is not None  # the source refuses a cockpit without one
        return with_watchdog(open_motor(number, self._identity, force), self._watchdog)
