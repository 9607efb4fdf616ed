"""What a wheel's motor is like, from strokes of a free wheel: its delay, torque over inertia, friction over inertia.

Pure. While the wheel turns one way, its angle is linear in what is sought: where and how fast it began, the torque that
was asked for, integrated twice, friction times the square of the time, damping times the way. All such stretches are
fitted at once by least squares, for each delay; the delay with the smallest remainder is the wheel's.
"""

from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.devices.force_feedback.gentle_push import Gentle, Turn, gentle, move, push
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError
from simconsole.values.kernels import clip
from simconsole.values.units import RAD_PER_DEG

Array = NDArray[np.float64]

STROKES: Final = 8
STROKE_RAD: Final = 4.0 * RAD_PER_DEG
"""Way of a stroke until it is braked; the delay adds to it."""
RAISED: Final = 1.4
"""A stroke that was too weak is tried again with so many times its torque."""
STROKE_RADPS: Final = 45.0 * RAD_PER_DEG
LET_GO_RAD: Final = 11.0 * RAD_PER_DEG
LET_GO_RADPS: Final = 70.0 * RAD_PER_DEG
"""A wheel that is further off or faster is let go of: what is left to 15 deg and 120 deg/s is for the delay. One that
nobody holds stays below 9 deg and 50 deg/s, whatever its motor (inertia and torque half to twice the profile's)."""
RATE_S: Final = 0.012
"""A rate is the way of so long: a wheel's angle comes in steps."""
PULSE_S: Final = 0.12
HELD_TICKS: Final = 2
"""A torque is held for so many ticks: no device's rate of updates is slower."""
DELAYS_S: Final = 0.06
"""Longest delay that is looked for."""
STEP_S: Final = 0.0005
MOVING_RADPS: Final = 4.0 * RAD_PER_DEG
SHORTEST_S: Final = 0.04
_PHYSICAL: Final = ((0, 1, 2), (0, 1), (0, 2), (0,))
"""Columns of a fit that may be left out, so that none is negative: no wheel drives itself."""


class Identified(NamedTuple):
    """A motor's figures; torque is in N m as the profile takes them."""

    delay_s: float  # from the command to the torque, the motor's own lag included
    accel_per_nm: float  # torque over inertia: rad/s2 per N m asked for
    friction_radps2: float  # friction over inertia
    damping_per_s: float  # damping over inertia
    remainder_rad: float  # RMS of what the fit leaves


class Tape:
    """A `Turn` that keeps what was asked for and what was read, and asks only for levels that the device has.

    It lets go of a wheel that is too fast or too far off: somebody has held it, and the motor pushed against them.
    """

    def __init__(self, turn: Turn, force: ForceFeedback, tick_hz: int) -> None:
        self._turn = turn
        self._step_nm = force.max_torque_nm / force.motor.level_steps
        self.tick_hz = tick_hz
        self.asked_nm: list[float] = []
        self.rad: list[float] = []

    def turn(self, torque_nm: float) -> float:
        """Let a tick pass; a new torque begins at every second tick only.

        Raises:
            DeviceError: the wheel is beyond LET_GO_RAD or LET_GO_RADPS; it has been let go of.
        """
        if len(self.asked_nm) % HELD_TICKS:
            torque_nm = self.asked_nm[-1]
        else:
            torque_nm = round(torque_nm / self._step_nm) * self._step_nm
        rad = self._turn(torque_nm)
        self.asked_nm.append(torque_nm)
        self.rad.append(rad)
        ticks = min(len(self.rad) - 1, round(RATE_S * self.tick_hz))
        radps = abs(rad - self.rad[-1 - ticks]) * self.tick_hz / max(ticks, 1)
        if abs(rad) > LET_GO_RAD or radps > LET_GO_RADPS:
            self._turn(0.0)
            raise DeviceError("wheel: motion: value too fast or too far: a wheel that nobody holds; identify again")
        return rad


def identify(
    turn: Turn, force: ForceFeedback, strength: float, tick_hz: int, say: Callable[[str], None] = lambda line: None
) -> Identified:
    """Find a motor's figures; the wheel stays within 15 deg and 120 deg/s.

    A wheel that somebody holds against the motor and then lets go of has the torque of those hands until the delay is
    over: with twice the profile's torque on half its inertia it has been seen at 170 deg/s before it was let go of.

    Args:
        turn: The wheel, free to turn: returns the angle from where it was at first, before this torque acts.
        force: Its profile.
        strength: Most of its torque, as a share.
        tick_hz: Rate of `turn`.
        say: Called with a line for each stage.

    Raises:
        DeviceError: the wheel does not turn, turns the other way, or does not move as a wheel with a motor does.
    """
    tape = Tape(turn, force, tick_hz)
    rules = gentle(force, strength, tick_hz)
    for direction in (1.0, -1.0):
        pushed = push(tape.turn, rules, direction)
        if pushed.sense <= 0.0:
            how = "does not turn" if pushed.sense == 0.0 else "turns the other way"
            raise DeviceError(f"wheel: it {how} with {pushed.torque_nm:.2f} N m: devices feel first, with --strength")
        move(tape.turn, rules, 0.0, 1.0)
    rough = fitted(tape)
    say(f"first look: delay {1000.0 * rough.delay_s:.0f} ms, {rough.accel_per_nm:.0f} rad/s2 per N m")
    for stroke in range(STROKES):
        raised = 1.0
        while not _stroke(tape, rough, rules, 1.0 if stroke % 2 == 0 else -1.0, raised):
            raised *= RAISED
    return fitted(tape)


def _stroke(tape: Tape, rough: Identified, rules: Gentle, direction: float, raised: float) -> bool:
    """Push the wheel to one side, let it roll, brake it, and bring it back.

    Returns whether it has gone far enough to say something, or cannot be pushed harder. A first look at a wheel that
    hardly turns may take its motor for a much stronger one; `raised` times the torque then do.
    """
    radps2 = min(STROKE_RADPS / PULSE_S, rules.limit_nm * rough.accel_per_nm - rough.friction_radps2)
    torque_nm = min(rules.limit_nm, raised * (radps2 + rough.friction_radps2) / rough.accel_per_nm)
    start_rad = rad = tape.turn(0.0)
    longest_s = min(3.0 * PULSE_S, STROKE_RADPS / max(radps2, 0.5))
    ticks = 0
    while ticks < longest_s * tape.tick_hz and abs(rad - start_rad) < 0.5 * STROKE_RAD:
        rad = tape.turn(direction * torque_nm)
        ticks += 1
    while ticks < 4 * longest_s * tape.tick_hz and abs(rad - start_rad) < STROKE_RAD:
        rad = tape.turn(0.0)
        ticks += 1
    told = abs(rad - start_rad) >= 0.5 * STROKE_RAD or torque_nm >= rules.limit_nm
    brake_nm = min(rules.limit_nm, torque_nm)
    radps = 1.0
    for _ in range(round(0.5 * tape.tick_hz)):
        before, rad = rad, tape.turn(clip(-direction * radps / 0.3, -1.0, 1.0) * brake_nm)
        radps += 0.3 * (direction * (rad - before) * tape.tick_hz - radps)
        if radps < 2.0 * RAD_PER_DEG:
            break
    tape.turn(0.0)
    move(tape.turn, rules, 0.0, 1.0)
    return told


def fitted(tape: Tape) -> Identified:
    """Return the figures that explain a tape best.

    Raises:
        DeviceError: the wheel hardly moved, or not as its motor pushed it.
    """
    rad = np.array(tape.rad)
    tick_s = 1.0 / tape.tick_hz
    stretches = _stretches(rad, tape.tick_hz)
    if not stretches:
        raise DeviceError("wheel: motion: value hardly any: a wheel that turns freely")
    asked = np.array(tape.asked_nm)
    delays = np.arange(0.0, DELAYS_S, STEP_S)
    fits = [_fit(rad, _twice_integrated(asked, delay, tick_s), stretches, tick_s) for delay in delays]
    best = int(np.argmin([remainder for _, remainder in fits]))
    (accel_per_nm, friction, damping), remainder = fits[best]
    if not np.isfinite(remainder):
        raise DeviceError("wheel: motion: value against its motor: a wheel that nobody holds")
    delay_s = float(delays[best])
    if 0 < best < len(delays) - 1:  # the vertex of the parabola through the three
        left, middle, right = (fits[best + side][1] ** 2 for side in (-1, 0, 1))
        delay_s += 0.5 * STEP_S * (left - right) / max(left - 2.0 * middle + right, 1e-30)
    return Identified(delay_s, accel_per_nm, friction, damping, remainder)


def _stretches(rad: Array, tick_hz: int) -> list[tuple[int, int, float]]:
    """Return (first, last, side) of each stretch in which the wheel turns one way."""
    window = max(2, round(0.012 * tick_hz))
    radps = np.zeros_like(rad)
    radps[window:-window] = (rad[2 * window :] - rad[: -2 * window]) * tick_hz / (2 * window)
    found = []
    for side in (1.0, -1.0):
        moving = np.flatnonzero(np.diff(np.concatenate(([0], (side * radps > MOVING_RADPS).astype(int), [0]))))
        for first, last in zip(moving[::2], moving[1::2], strict=True):
            if last - first >= SHORTEST_S * tick_hz:
                found.append((int(first), int(last), side))
    return found


def _twice_integrated(asked_nm: Array, delay_s: float, tick_s: float) -> Array:
    """Return the double integral of the torque at each tick, where a torque acts `delay_s` after its tick."""
    fine = 8
    step_s = tick_s / fine
    steps = np.repeat(asked_nm, fine)
    shift = delay_s / step_s
    whole, part = int(shift), shift - int(shift)
    late = np.concatenate((np.zeros(whole + 1), steps))[: len(steps) + 1]
    arrived = (1.0 - part) * late[1:] + part * late[:-1]
    once = np.concatenate(([0.0], np.cumsum(arrived) * step_s))
    twice = np.concatenate(([0.0], np.cumsum(0.5 * (once[1:] + once[:-1])) * step_s))
    return np.asarray(twice[:-1:fine])


def _fit(
    rad: Array, torque: Array, stretches: list[tuple[int, int, float]], tick_s: float
) -> tuple[tuple[float, float, float], float]:
    """Return torque, friction and damping over inertia and the RMS of the remainder, infinite where none is possible.

    A wheel turns with its motor, and nothing but its motor drives it: a short look at a slow wheel would else be
    explained best by a motor that pulls back and friction that pushes.
    """
    rows, targets = [], []
    for first, last, side in stretches:
        t = np.arange(last - first) * tick_s
        torque_part = torque[first:last] - torque[first]
        angle = rad[first:last] - rad[first]
        way = np.concatenate(([0.0], np.cumsum(0.5 * (angle[1:] + angle[:-1])) * tick_s))
        block = np.stack([torque_part, -side * 0.5 * t * t, -way, angle], axis=1)
        own = np.stack([np.ones_like(t), t], axis=1)
        block -= own @ np.linalg.lstsq(own, block, rcond=None)[0]  # the stretch's own beginning
        rows.append(block[:, :3])
        targets.append(block[:, 3])
    left, right = np.concatenate(rows), np.concatenate(targets)
    fits = [_of_columns(left, right, used) for used in _PHYSICAL]
    possible = [(found, remainder) for found, remainder in fits if found[0] > 0.0 and min(found) >= 0.0]
    found, remainder = min(possible, key=lambda fit: fit[1], default=((0.0, 0.0, 0.0), np.inf))
    return found, remainder


def _of_columns(left: Array, right: Array, used: tuple[int, ...]) -> tuple[tuple[float, float, float], float]:
    """Return the least squares over some of the three columns, 0 for the others, and the RMS of the remainder."""
    found = np.zeros(3)
    found[list(used)], *_ = np.linalg.lstsq(left[:, used], right, rcond=None)
    remainder = float(np.sqrt(np.mean((left @ found - right) ** 2)))
    return (float(found[0]), float(found[1]), float(found[2])), remainder
