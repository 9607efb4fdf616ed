"""The scale of a motor's torque, from a weight that hangs on the rim. Pure.

The wheel is held straight, then swept slowly to and fro. Up it takes the weight plus friction, down the weight less
friction: their mean is the weight alone, in N m as the profile takes them.
"""

import math
from collections.abc import Callable
from typing import Final

from simconsole.devices.force_feedback.gentle_push import Turn
from simconsole.devices.force_feedback.identification import Identified
from simconsole.values.errors import DeviceError
from simconsole.values.kernels import clip
from simconsole.values.units import RAD_PER_DEG

HANG_S: Final = 8.0
"""Time to hang the weight on, while the motor holds the wheel."""
TAKE_OFF_S: Final = 8.0
SWEEP_RAD: Final = 3.0 * RAD_PER_DEG
SWEEP_RADPS: Final = 4.0 * RAD_PER_DEG
SWEEPS: Final = 3
SETTLE_SHARE: Final = 0.4
"""Of a sweep, until it moves evenly."""
STIFF_RADPS: Final = 10.0
"""Natural frequency of the hold, critically damped: stable with any delay that is allowed."""
LEARNS_PER_S: Final = 2.5


class _Hold:
    """Holds the wheel at a target that moves, its friction fed forward: a short sweep is no time to learn it."""

    def __init__(self, turn: Turn, found: Identified, limit_nm: float, tick_hz: int) -> None:
        self._turn, self._limit_nm, self._tick_hz = turn, limit_nm, tick_hz
        self._stiff = STIFF_RADPS**2 / found.accel_per_nm
        self._damping = 2.0 * STIFF_RADPS / found.accel_per_nm
        self._friction_nm = found.friction_radps2 / found.accel_per_nm
        self._learnt_nm = self._radps = 0.0
        self._rad = turn(0.0)

    def tick(self, target_rad: float, target_radps: float) -> tuple[float, float]:
        """Let a tick pass and return torque and angle."""
        off = target_rad - self._rad
        self._learnt_nm += LEARNS_PER_S * self._stiff * off / self._tick_hz
        self._learnt_nm = clip(self._learnt_nm, -self._limit_nm, self._limit_nm)
        torque_nm = self._learnt_nm + self._stiff * off + self._damping * (target_radps - self._radps)
        if target_radps != 0.0:
            torque_nm += math.copysign(self._friction_nm, target_radps)
        torque_nm = clip(torque_nm, -self._limit_nm, self._limit_nm)
        before, self._rad = self._rad, self._turn(torque_nm)
        self._radps += 0.3 * ((self._rad - before) * self._tick_hz - self._radps)
        return torque_nm, self._rad


def weighed(
    turn: Turn, found: Identified, weight_nm: float, limit_nm: float, tick_hz: int, take_off: Callable[[], None]
) -> float:
    """Return the motor's true torque per N m of the profile.

    Args:
        turn: The wheel; the weight is hung on its right side, level with the hub, while it is held.
        found: Its figures by strokes.
        weight_nm: Mass times gravity times the radius at which it hangs.
        limit_nm: Most torque of the profile to use.
        tick_hz: Rate of `turn`.
        take_off: Called when the weight may go; the wheel is held for another TAKE_OFF_S.

    Raises:
        DeviceError: the weight is not there, or more than the motor may hold.
    """
    hold = _Hold(turn, found, limit_nm, tick_hz)
    for _ in range(round(HANG_S * tick_hz)):
        hold.tick(0.0, 0.0)
    means, target, most_nm = [], 0.0, 0.0
    for sweep in range(2 * SWEEPS):
        side = 1.0 if sweep % 2 == 0 else -1.0
        ticks = round((SWEEP_RAD - side * target) / SWEEP_RADPS * tick_hz)
        held = []
        for _ in range(ticks):
            target = clip(target + side * SWEEP_RADPS / tick_hz, -SWEEP_RAD, SWEEP_RAD)
            torque_nm, rad = hold.tick(target, side * SWEEP_RADPS)
            held.append((torque_nm / math.cos(rad), abs(torque_nm)))
        if sweep:  # the first is half a sweep
            even = held[round(SETTLE_SHARE * ticks) :]
            means.append(sum(nm for nm, _ in even) / len(even))
            most_nm = max(most_nm, *(nm for _, nm in even))
    up = means[1::2]
    down = means[0::2][: len(up)]
    mean_nm = 0.5 * (sum(up) / len(up) + sum(down) / len(down))
    take_off()
    for _ in range(round(TAKE_OFF_S * tick_hz)):
        target -= clip(target, -SWEEP_RADPS / tick_hz, SWEEP_RADPS / tick_hz)
        hold.tick(target, 0.0)
    turn(0.0)
    if mean_nm < 0.1 * limit_nm:
        raise DeviceError(f"weight: torque: value {mean_nm:.2f} N m: a weight on the right side of the rim")
    if most_nm >= limit_nm:
        raise DeviceError(
            f"weight: torque: value {weight_nm:.2f} N m: a lighter one, which the motor can move up with the "
            f"{limit_nm:.2f} N m that it may use"
        )
    return weight_nm / mean_nm
