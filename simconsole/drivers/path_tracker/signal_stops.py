"""Where to stop for traffic lights: from what they show, and for how long, to a place on the route. Pure.

A light is obeyed as by a careful driver. At red the car stops before the line. It does not enter on a green that ends
before it arrives. At yellow it stops where it can do so comfortably, and drives on where it cannot.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

from simconsole.drivers.path_tracker.speed_profile import SpeedProfile, Stop
from simconsole.values.signals import SignalState
from simconsole.world.rules.approaches import StopLine
from simconsole.world.rules.speed_advice import Greens

AHEAD_M: Final = 150.0
"""A line further away than this asks for nothing yet."""
GAP_M: Final = 1.0
"""So far before the line the car's front stops."""
GENTLE_MPS2: Final = 1.4
FIRM_MPS2: Final = 2.1
"""The strongest deceleration that is planned for a light; the speed control adds what it needs to follow."""
OLD_S: Final = 1.0
"""A light of which nothing was heard for longer counts as red."""
OVERTAKEN_S: Final = 2.0
"""What is older than the newest by more than a link's longest delay is of a drive that begins."""
_SET_OFF_MPS2: Final = 1.2
_RISING_S: Final = 0.4  # way that is driven before the deceleration is there: it rises, and fades, with bounded jerk
_FADING_M: Final = 0.7
_SPARE_S: Final = 1.0  # the front must be over the line so long before the green ends
_STANDING_MPS: Final = 0.3

_GO: Final = frozenset(
    (
        SignalState.PERMISSIVE_MOVEMENT_ALLOWED,
        SignalState.PROTECTED_MOVEMENT_ALLOWED,
        SignalState.CAUTION_CONFLICTING_TRAFFIC,
        SignalState.DARK,
        SignalState.UNAVAILABLE,
    )
)
_YELLOW: Final = frozenset((SignalState.PERMISSIVE_CLEARANCE, SignalState.PROTECTED_CLEARANCE))


class Light(NamedTuple):
    """What one link of a signal shows, as it was told at `stamp_s`."""

    state: int  # `SignalState`
    next_state: int
    change_s: float  # until the next state; negative: never
    stamp_s: float
    greens_s: tuple[tuple[float, float], ...] = ()  # the next times of green, from then; the end infinite: not known


class Approach(NamedTuple):
    """The way to the next line."""

    line_m: float  # where base_link is then
    left_m: float
    greens: Greens | None  # None: nothing was told


class SignalStops:
    """Decides for one stop line after the other; it is asked once in a period."""

    def __init__(self, lines: Sequence[StopLine], ids: Sequence[str], front_m: float) -> None:
        """Obey the lights at these stop lines of an open route; `ids` are the names of the map's signals.

        `front_m` is how far the car's front is ahead of base_link.
        """
        self._lines, self._ids, self._front_m = sorted(lines), tuple(ids), front_m
        self._shown: dict[tuple[str, int], Light] = {}
        self._stopping: StopLine | None = None
        self._brake_mps2 = GENTLE_MPS2  # as decided when the stop was: a plan that follows the car would never bite
        self._at_green = False

    def see(self, lights: Mapping[tuple[str, int], Light]) -> None:
        """Take what lights show, by the signal's name and link; what newer messages have overtaken tells nothing."""
        for name, light in lights.items():
            known = self._shown.get(name)
            if known is None or not known.stamp_s - OVERTAKEN_S <= light.stamp_s < known.stamp_s:
                self._shown[name] = light

    def state(self, signal: int, link: int) -> int:
        """Return what a link was told to show last, by the places of signal and link in the map; red if nothing was."""
        light = self._shown.get((self._ids[signal], link))
        return SignalState.STOP_AND_REMAIN if light is None else light.state

    def approach(self, s_m: float) -> Approach | None:
        """Return the next line, and what its light was told to do; None: there is none ahead."""
        front_m = s_m + self._front_m
        line = next((line for line in self._lines if line.s_m > front_m), None)
        if line is None:
            return None
        light = self._shown.get((self._ids[line.signal], line.link))
        greens = None if light is None else Greens(light.greens_s, light.stamp_s)
        return Approach(line.s_m - self._front_m, line.s_m - front_m, greens)

    def stop(self, s_m: float, speed_mps: float, plan: SpeedProfile, now_s: float) -> Stop | None:
        """Return where base_link is to stop, None to drive on, while it is at `s_m` and follows `plan`."""
        front_m = s_m + self._front_m
        line = next((line for line in self._lines if line.s_m > front_m), None)
        if line is None or line.s_m - front_m > AHEAD_M or not self._shown:
            self._stopping = None
            return None
        stop_m = line.s_m - self._front_m - GAP_M
        needed = needed_mps2(stop_m - s_m, speed_mps)
        state, left_s = self._light(line, now_s)
        goes, kept = state in _GO, line == self._stopping
        if goes:
            late = arrival_s(plan, s_m, line.s_m - self._front_m, speed_mps) + _SPARE_S > left_s
            stops = (kept and self._at_green) or (late and needed <= FIRM_MPS2)
        else:
            stops = kept or state not in _YELLOW or needed <= FIRM_MPS2
        if stops and not kept:
            self._brake_mps2 = min(max(needed, GENTLE_MPS2), FIRM_MPS2)
        self._stopping, self._at_green = line if stops else None, goes
        return Stop(stop_m, self._brake_mps2) if stops else None

    def _light(self, line: StopLine, now_s: float) -> tuple[int, float]:
        """Return what a line's light shows now, and for how many seconds a car may go on if it is green."""
        light = self._shown.get((self._ids[line.signal], line.link))
        if light is None or now_s - light.stamp_s > OLD_S:
            return SignalState.STOP_AND_REMAIN, 0.0
        if light.change_s < 0.0 or light.next_state in _GO:
            return light.state, math.inf
        return light.state, light.change_s - (now_s - light.stamp_s)


def needed_mps2(left_m: float, speed_mps: float) -> float:
    """Return the deceleration with which a car comes to rest in `left_m`; infinite where it cannot."""
    if speed_mps < _STANDING_MPS:
        return 0.0
    braking_m = left_m - _FADING_M - speed_mps * _RISING_S
    return 0.5 * speed_mps**2 / braking_m if braking_m > 0.0 else math.inf


def arrival_s(plan: SpeedProfile, from_m: float, to_m: float, speed_mps: float) -> float:
    """Return how long a car of `speed_mps` takes at least to a place, at the planned speeds."""
    first, last = (round(place / plan.step_m) for place in (from_m, to_m))
    planned = plan.speed_mps[max(first, 0) : max(last, 0)]
    if not len(planned):
        return 0.0
    way_m, top = to_m - from_m, float(planned.max())
    gained = max(top - speed_mps, 0.0)
    rising_m = gained / _SET_OFF_MPS2 * (speed_mps + 0.5 * gained)
    if rising_m >= way_m:
        accelerating_s = (math.sqrt(speed_mps**2 + 2.0 * _SET_OFF_MPS2 * way_m) - speed_mps) / _SET_OFF_MPS2
    else:
        accelerating_s = gained / _SET_OFF_MPS2 + (way_m - rising_m) / top
    return max(float((plan.step_m / planned).sum()), accelerating_s)
