"""`simconsole devices feel`: each force once, announced and gentle, the sign test first.

Pushes turn a wheel that nobody holds and are judged by its own motion; what is for hands on the wheel is asked about.
"""

import math
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.force_feedback.gentle_push import (
    LIMIT_RAD,
    REST_RADPS,
    Gentle,
    Pushed,
    gentle,
    move,
    push,
)
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
from simconsole.values.kernels import clip
from simconsole.values.signals import NO_TORQUE
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from simconsole.values.units import DEG_PER_RAD, RAD_PER_DEG

LET_GO_S: Final = 0.25
WATCH_S: Final = 0.1
COUNTDOWN_S: Final = 3
_TEXTURE_HZ: Final = 20.0
_AWAY_RAD: Final = 6.0 * RAD_PER_DEG
"""The wheel is let go of on its way from here through the centre: room enough on both sides."""
_DAMPING_PER_S: Final = 3.2
_CENTRE_PER_S2: Final = 20.0
_CENTRE_MOST_PER_S2: Final = 10.0
"""Of the profile's inertia: gains that are stable, and a release that is slow, whatever half of it turns out to be."""


class Force(NamedTuple):
    """A force to feel with the hands on the wheel: N m from (time in s, angle, rate of the wheel, motor's inertia)."""

    name: str
    length_s: float
    torque: Callable[[float, float, float, float], float]
    question: str


def _friction(t: float, rad: float, radps: float, inertia: float) -> float:
    return -_CENTRE_MOST_PER_S2 * inertia * radps / (abs(radps) + _CENTRE_MOST_PER_S2 / _DAMPING_PER_S)


def _centre(t: float, rad: float, radps: float, inertia: float) -> float:
    spring = clip(-_CENTRE_PER_S2 * rad, -_CENTRE_MOST_PER_S2, _CENTRE_MOST_PER_S2)
    return inertia * (spring - _DAMPING_PER_S * radps)


def _texture(t: float, rad: float, radps: float, inertia: float) -> float:
    return 8.0 * inertia * math.cos(2.0 * math.pi * _TEXTURE_HZ * t)  # a cosine: it leaves no speed behind


def _damping(t: float, rad: float, radps: float, inertia: float) -> float:
    return -_DAMPING_PER_S * inertia * radps


PUSHES: Final = {"sign": 1.0, "right": -1.0}
"""Pushes with hands off, and where to: 1 is to the left."""
FORCES: Final = (
    Force("texture", 1.0, _texture, "A fine shiver?"),
    Force("damping", 3.0, _damping, "Turn it: does it resist turning fast?"),
    Force("friction", 3.0, _friction, "Turn it: does it drag?"),
    Force("centre", 3.0, _centre, "Turn it: does it come back?"),
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
    pressed: Callable[[], bool] = lambda: False,
) -> dict[str, Any]:
    """Play each force and judge it: by the wheel's own motion where it turned, else by the person's word.

    Args:
        cockpit: With force feedback.
        say: Prints a line.
        ask: Puts a question; asked only where the wheel did not turn by itself.
        strength: Most of the motor's torque that a force may use, 0.05 to 0.6.
        virtual: On a simulated wheel behind virtual devices.
        tick_hz: Rate of the loop.
        pace: Makes a pace for a rate.
        pressed: Whether a key was pressed since it was asked last: it ends everything at once.

    Returns:
        Plain values; `ok` is False where a force was not as it should be.

    Raises:
        DeviceError: a device is missing, or the cockpit or its driver has no force feedback, or the wheel runs away.
        KeyboardInterrupt: a key was pressed.
    """
    force = cockpit.force_feedback
    if force is None:
        raise DeviceError(f"{cockpit.title}: force_feedback: value missing: a profile of a wheel with a motor")
    if not 0.05 <= strength <= 0.6:
        raise DeviceError(f"strength: value {strength:g}: 0.05 to 0.6")
    results: dict[str, dict[str, Any]] = {}
    with ExitStack() as stack:
        bench = _Bench(cockpit, force, virtual, tick_hz, pace, pressed, say, stack)
        if not bench.motor.obeys:
            raise DeviceError(f"{cockpit.title}: no force feedback: {bench.motor.reason}")
        rules = gentle(force, strength, tick_hz)
        say(f"{cockpit.title}: at most {rules.limit_nm:.1f} N m. Any key lets go at once.")
        for name, direction in PUSHES.items():
            _announce(bench, name, "Hands OFF, fingers away from the spokes.", ask, say)
            pushed = push(bench.turn, rules, direction)
            results[name] = _judge_push(name, direction, pushed, ask, say, force)
            if pushed.sense:
                move(bench.turn, rules, 0.0, pushed.sense)
            if not results[name]["ok"]:
                break  # every other force would have the wrong sign, too
        else:
            _announce(bench, "let go", "Hands OFF.", ask, say)
            results["let go"] = _let_go(bench, rules, say)
            for kind in FORCES if results["let go"]["ok"] else ():
                _announce(bench, kind.name, "Hands ON.", ask, say)
                bench.play(kind, force.motor.inertia_kgm2, rules.limit_nm)
                ok = answer(ask, f"{kind.name}: {kind.question} [y/n]: ").strip().lower()[:1] == "y"
                results[kind.name] = _result(kind.name, ok, "felt" if ok else "not felt", 0.0, say)
    complete = len(results) == len(PUSHES) + 1 + len(FORCES)
    ok = complete and all(result["ok"] for result in results.values())
    return {"cockpit": cockpit.title, "ok": ok, "forces": results}


def _announce(bench: "_Bench", name: str, text: str, ask: Callable[[str], str], say: Say) -> None:
    """Wait for Enter, then count down: nobody is pushed who does not expect it."""
    answer(ask, f"{name}: {text} Enter starts it. ")
    for left_s in range(COUNTDOWN_S, 0, -1):
        say(f"{left_s}")
        bench.rest(1.0)


def _judge_push(
    name: str, direction: float, pushed: Pushed, ask: Callable[[str], str], say: Say, force: ForceFeedback
) -> dict[str, Any]:
    turned_deg = pushed.turned_rad * DEG_PER_RAD
    sense = pushed.sense
    how = f"turned {abs(turned_deg):.1f} deg to the {'left' if turned_deg > 0.0 else 'right'}"
    if not sense:
        typed = answer(ask, f"{name}: Which way did it pull? [l]eft, [r]ight, [n]ot at all: ").strip().lower()[:1]
        sense = direction * {"l": 1.0, "r": -1.0}.get(typed, 0.0)
        how = {"l": "left", "r": "right"}.get(typed, "not at all")
    if sense < 0.0:
        other = "right" if force.level_pushes == "left" else "left"
        say(f"force_feedback.level_pushes: value {force.level_pushes}: {other}; this motor pushes the other way")
    return _result(name, sense > 0.0, how, turned_deg, say)


def _result(name: str, ok: bool, how: str, turned_deg: float, say: Say) -> dict[str, Any]:
    say(f"{name}: {how}: {'good' if ok else 'WRONG'}")
    return {"ok": ok, "how": how, "turned_deg": round(turned_deg, 1)}


def _let_go(bench: "_Bench", rules: Gentle, say: Say) -> dict[str, Any]:
    """Test by the wheel's motion that an effect which is not started again ends by itself; return the result."""
    moved_deg, slows = bench.abandon(rules)
    how = "the effect ended by itself" if slows else "the effect did not end by itself"
    return _result("let go", slows, how, moved_deg, say)


class _Bench:
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
        self._tick_hz = tick_hz
        self._pace = pace
        self._pressed = pressed
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
        self._watchdog = None if virtual else open_watchdog(self._identity, say)
        if self._watchdog is not None:
            stack.callback(self._watchdog.close)
        self._ticks = 0
        self.motor = WheelMotor(self._port(force), force, lambda snapshot: snapshot.t_s)
        stack.callback(self.motor.close)
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

    def play(self, kind: Force, inertia_kgm2: float, limit_nm: float) -> None:
        """Play a force for hands on the wheel."""
        self._begin()
        for tick in range(1, round(kind.length_s * self._tick_hz) + 1):
            torque_nm = kind.torque(tick / self._tick_hz, self._rad - self._first_rad, self._radps, inertia_kgm2)
            self._tick(clip(torque_nm, -limit_nm, limit_nm))
        self._tick(0.0)

    def abandon(self, rules: Gentle) -> tuple[float, bool]:
        """Set the wheel moving, then publish nothing more: return how far it went in deg, and whether it slows down."""
        move(self.turn, rules, -_AWAY_RAD, 1.0)
        start_rad = self._rad
        move(self.turn, rules, _AWAY_RAD, 1.0, moving=True)
        for _ in range(round(LET_GO_S * self._tick_hz)):
            self._look()
        ended_radps = abs(self._radps)
        for _ in range(round(WATCH_S * self._tick_hz)):
            self._look()
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
        if self._pressed():
            row[LAYOUT.torque.slice] = NO_TORQUE
            self.motor.publish(Snapshot(self._ticks, self._tick_hz, row))
            raise KeyboardInterrupt

    def _look(self) -> None:
        self._ticks += 1
        self._waited += 1
        self._wait(self._waited)
        if self._wheel is not None and self._plugged is not None:
            self._wheel.turn(HANDS_OFF)
            self._plugged.write(raw_sample(Intent(hand_wheel_rad=self._wheel.state.rad), self._settings))
        before, self._rad = self._rad, self._angle()
        self._radps += 0.5 * ((self._rad - before) * self._tick_hz - self._radps)

    def _angle(self) -> float:
        axis = self._source.poll(self._ticks).wheel_axis
        return (axis - self._settings.wheel_centre_raw) * self._settings.wheel_rad_per_raw

    def _port(self, force: ForceFeedback) -> HapticPort:
        if self._wheel is not None:
            return SimulatedWheelPort(self._wheel)
        number = self._source.instance_id("wheel")
        assert number is not None  # the source refuses a cockpit without one
        return with_watchdog(open_motor(number, self._identity, force), self._watchdog)
