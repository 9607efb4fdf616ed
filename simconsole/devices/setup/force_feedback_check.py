"""`simconsole devices feel`: each force once, announced and gentle, the sign test first.

Pushes turn a wheel that nobody holds and are judged by its own motion; what is for hands on the wheel is asked about.
"""

import math
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any, Final, NamedTuple

from simconsole.devices.force_feedback.gentle_push import Gentle, Pushed, gentle, move, push
from simconsole.devices.setup.device_commands import Pace, Say, answer, realtime
from simconsole.devices.setup.wheel_bench import Torque, WheelBench
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError
from simconsole.values.kernels import clip
from simconsole.values.units import DEG_PER_RAD

COUNTDOWN_S: Final = 3
_TEXTURE_HZ: Final = 20.0
_DAMPING_PER_S: Final = 3.2
_FRICTION_PER_S2: Final = 10.0
_CENTRE_PER_S2: Final = 20.0
_CENTRE_MOST_PER_S2: Final = 8.0
_CENTRE_DAMPING_PER_S: Final = 6.0
"""Of the profile's inertia: stable gains, and a wheel that is let go of stays below 120 deg/s, whatever it is like."""


class Force(NamedTuple):
    """A force to feel with the hands on the wheel: N m from (time in s, angle, rate of the wheel, motor's inertia)."""

    name: str
    length_s: float
    torque: Torque
    question: str


def _friction(t: float, rad: float, radps: float, inertia: float) -> float:
    return -_FRICTION_PER_S2 * inertia * radps / (abs(radps) + _FRICTION_PER_S2 / _DAMPING_PER_S)


def _centre(t: float, rad: float, radps: float, inertia: float) -> float:
    spring = clip(-_CENTRE_PER_S2 * rad, -_CENTRE_MOST_PER_S2, _CENTRE_MOST_PER_S2)
    return inertia * (spring - _CENTRE_DAMPING_PER_S * radps)


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
    Force("centre", 3.0, _centre, "Turn it: does it pull to the middle?"),
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
        bench = WheelBench(cockpit, force, virtual, tick_hz, pace, pressed, say, stack)
        rules = gentle(force, strength, tick_hz)
        say(f"{cockpit.title}: at most {rules.limit_nm:.1f} N m. Any key lets go at once.")
        for name, direction in PUSHES.items():
            announce(bench, name, "Hands OFF, fingers away from the spokes.", ask, say)
            pushed = push(bench.turn, rules, direction)
            results[name] = _judge_push(name, direction, pushed, ask, say, force)
            if pushed.sense:
                move(bench.turn, rules, 0.0, pushed.sense)
            if not results[name]["ok"]:
                break  # every other force would have the wrong sign, too
        else:
            announce(bench, "let go", "Hands OFF.", ask, say)
            results["let go"] = _let_go(bench, rules, say)
            for kind in FORCES if results["let go"]["ok"] else ():
                announce(bench, kind.name, "Hands ON.", ask, say)
                bench.play(kind.torque, kind.length_s, force.motor.inertia_kgm2, rules.limit_nm)
                ok = answer(ask, f"{kind.name}: {kind.question} [y/n]: ").strip().lower()[:1] == "y"
                results[kind.name] = _result(kind.name, ok, "felt" if ok else "not felt", 0.0, say)
    complete = len(results) == len(PUSHES) + 1 + len(FORCES)
    ok = complete and all(result["ok"] for result in results.values())
    return {"cockpit": cockpit.title, "ok": ok, "forces": results}


def announce(bench: WheelBench, name: str, text: str, ask: Callable[[str], str], say: Say) -> None:
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


def _let_go(bench: WheelBench, rules: Gentle, say: Say) -> dict[str, Any]:
    """Test by the wheel's motion that an effect which is not started again ends by itself; return the result."""
    moved_deg, slows = bench.abandon(rules)
    how = "the effect ended by itself" if slows else "the effect did not end by itself"
    return _result("let go", slows, how, moved_deg, say)
