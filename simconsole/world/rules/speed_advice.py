"""Speed advice for the next traffic light (GLOSA): which speeds bring the vehicle over the line at green. Pure.

It knows only what was told of the light: its next times of green, and when that was said. A band of speeds is
advised that holds until the line, from the speed that is driven now: after a time for reaction the vehicle changes
its speed steadily and then keeps it. No legal speed: prepare to stop.
"""

import math
from collections.abc import Callable, Sequence
from enum import IntEnum
from typing import Final, NamedTuple

import msgspec

REACH_M: Final = 300.0
"""A line further away asks for nothing yet: signals are not heard there."""
LEAST_MPS: Final = 5.0
"""Nobody is told to drive slower where that is allowed: the `min-speed` of SUMO's device for the same."""
SPARE_S: Final = 1.5
"""The line is passed so long after green has begun, and before it ends, where there is a choice."""
LEAST_SPARE_S: Final = 0.4
"""And at least so long."""
OLD_S: Final = 1.0
"""Nothing is advised on what was told longer ago."""
HOLD_S: Final = 1.0
"""A band is shown so long at least, as long as it leads to green."""
BETTER_MPS: Final = 1.0
"""A band is not shown for longer than that where one can drive so much faster: nobody creeps towards a green."""
UP_MPS2: Final = 1.2
DOWN_MPS2: Final = 1.0
"""How speed is changed for an advice: gently."""
_STANDING_MPS: Final = 1.0
_CLOSE_S: Final = 1.5  # so long before the line advice stays as it is: nobody reads any more
_BISECTIONS: Final = 24
_SAME_S: Final = 1.0  # times of one green differ by less from message to message


class Advised(IntEnum):
    """What is advised."""

    NOTHING = 0
    SPEED = 1
    STOP = 2  # no legal speed leads to green: prepare to stop


class Advice(NamedTuple):
    """What to do until the line."""

    kind: Advised = Advised.NOTHING
    low_mps: float = 0.0
    high_mps: float = 0.0
    target_mps: float = 0.0  # within the band


NO_ADVICE: Final = Advice()
STOP: Final = Advice(Advised.STOP)


def to_bytes(advice: Advice) -> bytes:
    """Return an advice as JSON."""
    return msgspec.json.encode(advice._asdict())


def from_bytes(content: bytes) -> Advice:
    """Return an advice from JSON.

    Raises:
        ValueError: it is none.
    """
    try:
        told = msgspec.json.decode(content, type=dict[str, float])
        return Advice(Advised(int(told.pop("kind"))), **told)
    except (msgspec.MsgspecError, KeyError, TypeError) as problem:
        raise ValueError(f"advice: {problem}") from None


class Greens(NamedTuple):
    """The next times of green of a link, from `stamp_s` on: (begin, end), 0: it is green, infinite: for good."""

    windows_s: tuple[tuple[float, float], ...]
    stamp_s: float


class _Found(NamedTuple):
    advice: Advice
    widest: tuple[float, float]  # speeds that lead to the same green with the least to spare (m/s)
    end_s: float  # of that green, by the clock


class SpeedAdvisor:
    """Advises one vehicle; it is asked again and again, and remembers what it has shown."""

    def __init__(self, reaction_s: float = 1.0, spare_s: float = SPARE_S) -> None:
        """Advise somebody who follows after `reaction_s`, and passes the line `spare_s` after green has begun."""
        self._reaction_s, self._spare_s = reaction_s, spare_s
        self._line: object = None
        self.reset()

    def reset(self) -> None:
        """Forget what was shown: the way to the line is another."""
        self._shown, self._since_s, self._end_s = NO_ADVICE, -math.inf, -math.inf

    def advise(
        self,
        left_m: float,
        speed_mps: float,
        limit_mps: float,
        greens: Greens | None,
        now_s: float,
        *,
        line: object = None,
    ) -> Advice:
        """Return what to show now.

        Args:
            left_m: from the vehicle's front to the line.
            speed_mps: of the vehicle.
            limit_mps: what is allowed all the way to the line.
            greens: as they were told; None: nothing was.
            now_s: by the clock of their stamp.
            line: which line it is, by any name; what was shown on the way to another does not hold for it.
        """
        if line != self._line:
            self._line = line
            self.reset()
        if greens is None or not 0.0 < left_m <= REACH_M or not -OLD_S <= now_s - greens.stamp_s <= OLD_S:
            return self._show(NO_ADVICE, now_s, -math.inf)
        shown = self._shown
        if speed_mps > _STANDING_MPS and left_m < _CLOSE_S * speed_mps and shown.kind is not Advised.NOTHING:
            return shown
        age_s = now_s - greens.stamp_s
        windows = [(begin - age_s, end - age_s) for begin, end in greens.windows_s if end > age_s]
        found = self._find(left_m, speed_mps, limit_mps, windows, now_s)
        if found is None:
            if speed_mps <= _STANDING_MPS:
                return self._show(NO_ADVICE, now_s, -math.inf)
            return self._show(STOP, now_s, -math.inf)
        low, high = found.widest
        if shown.kind is Advised.SPEED and _same(found.end_s, self._end_s):
            whole = low <= shown.low_mps and shown.high_mps <= high
            whole = whole and found.advice.target_mps - shown.target_mps < BETTER_MPS
            if low <= shown.target_mps <= high and (whole or now_s - self._since_s < HOLD_S):
                return shown
        return self._show(found.advice, now_s, found.end_s)

    def _show(self, advice: Advice, now_s: float, end_s: float) -> Advice:
        if advice != self._shown:
            self._shown, self._since_s = advice, now_s
        self._end_s = end_s
        return self._shown

    def _find(
        self, left_m: float, speed_mps: float, limit_mps: float, windows: Sequence[tuple[float, float]], now_s: float
    ) -> _Found | None:
        """Return the band for the first green that a legal speed leads to; None: there is none."""
        for green in windows:
            widest = band_of(left_m, speed_mps, limit_mps, green, reaction_s=self._reaction_s, spare_s=LEAST_SPARE_S)
            if widest is None:
                continue
            low, high = (
                band_of(left_m, speed_mps, limit_mps, green, reaction_s=self._reaction_s, spare_s=self._spare_s)
                or (0.5 * sum(widest),) * 2
            )
            return _Found(Advice(Advised.SPEED, low, high, high), widest, now_s + green[1])
        return None


def band_of(
    left_m: float,
    speed_mps: float,
    limit_mps: float,
    green_s: tuple[float, float],
    *,
    reaction_s: float,
    spare_s: float,
) -> tuple[float, float] | None:
    """Return the lowest and the highest legal speed that pass the line at green, None where none does."""
    begin_s, end_s = green_s
    first_s = begin_s + spare_s if begin_s > 0.0 else 0.0
    last_s = end_s - spare_s
    least, most = min(LEAST_MPS, limit_mps), limit_mps

    def arrives_s(speed: float) -> float:
        return arrival_s(left_m, speed_mps, speed, reaction_s)

    if last_s < first_s or most <= 0.0 or arrives_s(most) > last_s or arrives_s(least) < first_s:
        return None
    low = least if arrives_s(least) <= last_s else _where(arrives_s, last_s, least, most)[1]
    high = most if arrives_s(most) >= first_s else _where(arrives_s, first_s, least, most)[0]
    return (low, high) if low <= high else None


def rolling_mps(left_m: float) -> float:
    """Return how fast to drive where the advice is to prepare to stop, `left_m` before the place of the stop.

    As slowly as anybody is told to drive, and then braking gently all the way: the light may be green before the stop.
    """
    return min(LEAST_MPS, math.sqrt(2.0 * DOWN_MPS2 * max(left_m, 0.0)))


def _same(end_s: float, other_s: float) -> bool:
    return end_s == other_s or abs(end_s - other_s) < _SAME_S


def _where(arrives_s: Callable[[float], float], at_s: float, low: float, high: float) -> tuple[float, float]:
    """Return two speeds near that which arrives at a time: one that is there no earlier, one no later."""
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if arrives_s(middle) >= at_s else (low, middle)
    return low, high


def arrival_s(left_m: float, from_mps: float, to_mps: float, reaction_s: float) -> float:
    """Return how long a way takes: at one speed for the reaction, changed steadily to the other, and kept."""
    left_m -= from_mps * reaction_s
    if left_m <= 0.0:
        return reaction_s + left_m / from_mps
    change = UP_MPS2 if to_mps > from_mps else -DOWN_MPS2
    changing_m = 0.5 * (to_mps**2 - from_mps**2) / change
    if changing_m >= left_m:
        return reaction_s + (math.sqrt(from_mps**2 + 2.0 * change * left_m) - from_mps) / change
    return reaction_s + (to_mps - from_mps) / change + (left_m - changing_m) / to_mps
