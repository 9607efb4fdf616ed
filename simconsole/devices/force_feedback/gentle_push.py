"""Torque for a wheel whose motor is not known yet: pushes and moves that stay slow and short whatever it is.

Pure. Every rule is scaled by the inertia of the profile and holds where the wheel's true inertia or torque is half or
twice as large, its friction 0.03 to 0.3 N m and its delay up to 32 ms: at most 15 deg and 120 deg/s.
"""

import math
from collections.abc import Callable
from typing import Final, NamedTuple, TypeAlias

from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.kernels import approach, clip
from simconsole.values.units import RAD_PER_DEG

PUSH_S: Final = 0.3
"""Longest push. Its torque grows all the while, so that friction is overcome slowly, by a little more than itself."""
MOVED_RAD: Final = 0.5 * RAD_PER_DEG
"""From here on the wheel turns, and the push is over."""
LIMIT_RAD: Final = 12.0 * RAD_PER_DEG
"""A wheel that is further off is let go of; what is left to 15 deg is for the delay."""
TRIES: Final = 5
"""Pushes until a wheel turns: each begins a little below what could not turn it before."""
RELEASED: Final = 0.9
SETTLE_S: Final = 1.5
BACK_S: Final = 6.0
_RAMP_PER_S3: Final = 30.0
_BRAKE_PER_S: Final = 3.2
_MOVE_RADPS: Final = 15.0 * RAD_PER_DEG
_MOVE_PER_S: Final = 3.0
REST_RADPS: Final = 2.0 * RAD_PER_DEG
_REST_S: Final = 0.08
_RATE_SHARE: Final = 0.5

Turn: TypeAlias = Callable[[float], float]
"""Lets one tick pass with this torque (N m, left-positive by the profile) and returns the wheel's angle in rad."""


class Gentle(NamedTuple):
    """How torque is put on, at a tick rate."""

    ramp_nm: float  # per tick
    brake_nms: float
    limit_nm: float
    tick_hz: int


def gentle(force: ForceFeedback, strength: float, tick_hz: int) -> Gentle:
    """Return the rules for a motor, with at most the share `strength` of its torque."""
    inertia = force.motor.inertia_kgm2
    return Gentle(
        ramp_nm=_RAMP_PER_S3 * inertia / tick_hz,
        brake_nms=_BRAKE_PER_S * inertia,
        limit_nm=strength * force.max_torque_nm,
        tick_hz=tick_hz,
    )


class Pushed(NamedTuple):
    """What a push did."""

    turned_rad: float  # 0 beyond noise where the wheel did not move
    sense: float  # 1: the wheel went where it was pushed, -1: the other way, 0: it did not move
    torque_nm: float  # the largest, left-positive


class _Watched:
    """The wheel's angle and rate, tick by tick."""

    def __init__(self, turn: Turn, tick_hz: int) -> None:
        self._turn = turn
        self._tick_hz = tick_hz
        self.rad = turn(0.0)
        self.radps = 0.0

    def tick(self, torque_nm: float) -> None:
        before, self.rad = self.rad, self._turn(torque_nm)
        self.radps += _RATE_SHARE * ((self.rad - before) * self._tick_hz - self.radps)

    def settle(self, brake_nms: float, limit_nm: float) -> None:
        """Brake by the wheel's own rate, for at most SETTLE_S; a negative `brake_nms` is for a reversed motor."""
        rested = 0
        for _ in range(round(SETTLE_S * self._tick_hz)):
            self.tick(clip(-brake_nms * self.radps, -limit_nm, limit_nm))
            rested = rested + 1 if abs(self.radps) < REST_RADPS else 0
            if rested > _REST_S * self._tick_hz:
                break
        self.tick(0.0)


def push(turn: Turn, rules: Gentle, direction: float) -> Pushed:
    """Push until the wheel turns by MOVED_RAD, a few times for PUSH_S at most, then brake it; the ways add up.

    Args:
        turn: The wheel.
        rules: Of its motor.
        direction: 1 to the left, -1 to the right.
    """
    torque_nm, start_rad = 0.0, turn(0.0)
    for _ in range(TRIES):
        wheel = _Watched(turn, rules.tick_hz)
        torque_nm *= RELEASED
        for _ in range(round(PUSH_S * rules.tick_hz)):
            torque_nm = min(rules.limit_nm, torque_nm + rules.ramp_nm)
            wheel.tick(direction * torque_nm)
            moved = wheel.rad - start_rad
            if abs(moved) >= MOVED_RAD:
                sense = 1.0 if moved * direction > 0.0 else -1.0
                wheel.settle(sense * rules.brake_nms, rules.limit_nm)
                return Pushed(wheel.rad - start_rad, sense, direction * torque_nm)
        wheel.settle(0.0, 0.0)
    return Pushed(0.0, 0.0, direction * torque_nm)


def move(turn: Turn, rules: Gentle, target_rad: float, sense: float, *, moving: bool = False) -> float:
    """Turn the wheel slowly to an angle; return where it is.

    Args:
        turn: The wheel.
        rules: Of its motor.
        target_rad: Where to.
        sense: Of its motor, as a push found it (1 or -1).
        moving: Return on the way, with its torque on, while it still speeds up.
    """
    wheel = _Watched(turn, rules.tick_hz)
    held_nm = before_radps = 0.0
    for _ in range(round(BACK_S * rules.tick_hz)):
        off_rad = target_rad - wheel.rad
        if abs(off_rad) < MOVED_RAD and abs(wheel.radps) < REST_RADPS:
            break
        speeds_up = REST_RADPS < abs(wheel.radps) > abs(before_radps)
        if moving and speeds_up and wheel.radps * off_rad > 0.0:
            return wheel.rad
        before_radps = wheel.radps
        miss = clip(_MOVE_PER_S * off_rad, -_MOVE_RADPS, _MOVE_RADPS) - wheel.radps
        if abs(wheel.radps) < REST_RADPS:  # it sticks: more, until it does not
            held_nm = approach(held_nm, math.copysign(rules.limit_nm, off_rad), 0.5 * rules.ramp_nm)
        elif miss * held_nm < 0.0:  # too fast: friction needs less than what it took to break away
            held_nm = approach(held_nm, 0.0, rules.ramp_nm)
        wheel.tick(sense * clip(held_nm + rules.brake_nms * miss, -rules.limit_nm, rules.limit_nm))
    wheel.settle(sense * rules.brake_nms, rules.limit_nm)
    return wheel.rad
