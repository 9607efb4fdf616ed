"""R06 with every rate and pattern: full lock as a step, a ramp, on and off, beside silence, by fast and slow senders.

The judge reads docs/faults.md, not the console: a command is wild if speed^2 tan(angle) / wheelbase is more than
10 m/s2 when it comes. Time counts from the last one that was not.
"""

import math
import random
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest

from simconsole.values.signals import NO_EVENTS, EventInput, Mode, Reason, RemoteCommand
from tests.faults.at_speed import LEFT_WITHIN_S, ready, said
from tests.samples import Measured, Sample

RATES_HZ = (50, 250, 1000)
WILD_MPS2 = 10.0
MOST_RADPS = 1.0
LOCK_RAD = math.radians(34.0)
Pattern = Callable[[float, random.Random], float | None]
"""The angle of a command sent so many seconds after the fault began; None: it is not sent."""

PATTERNS: dict[str, Pattern] = {
    "step": lambda t_s, chance: LOCK_RAD,
    "ramp": lambda t_s, chance: min(LOCK_RAD, LOCK_RAD * t_s),
    "on and off": lambda t_s, chance: -LOCK_RAD if int(t_s / 0.3) % 2 else 0.01,
    "left and right": lambda t_s, chance: math.copysign(LOCK_RAD, math.sin(12.0 * t_s)),
    "after silence": lambda t_s, chance: None if t_s < 0.19 else LOCK_RAD,
    "now and then": lambda t_s, chance: chance.choice((None, None, LOCK_RAD, -LOCK_RAD, 0.0)),
    "mostly missing": lambda t_s, chance: chance.choice((LOCK_RAD, 0.005, *(None,) * 12)),
}
ALWAYS = ("step", "left and right", "after silence")


class Sender:
    """A controller whose commands follow a pattern, at a rate of its own; before, it drove straight on."""

    def __init__(self, tick_hz: int, start: int, pattern: Pattern, period_s: float, seed: int) -> None:
        self._tick_hz, self._start, self._pattern = tick_hz, start, pattern
        self._period = max(1, round(period_s * tick_hz))
        self._chance = random.Random(seed)
        self._command, self._received = said(start, 0.0), start
        self.sent: dict[int, float] = {}

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        after = tick - self._start - 1
        angle = self._pattern(after / self._tick_hz, self._chance) if after % self._period == 0 else None
        if angle is not None:
            self.sent[tick] = angle
            self._command, self._received = said(tick, angle), tick
        return self._command._replace(age_ticks=float(tick - self._received)), NO_EVENTS


class Answer(NamedTuple):
    """What a pattern led to."""

    longest_s: float
    """The longest that the car was AUTONOMOUS after the last plausible command."""
    left: bool


def answer(tick_hz: int, pattern: Pattern, period_s: float, seed: int, seconds: float) -> Answer:
    """Drive a pattern; judge each tick of it."""
    at_speed = ready(tick_hz)
    start = at_speed.state.tick
    sender = Sender(tick_hz, start, pattern, period_s, seed)
    driven = at_speed.drive(sender, seconds)
    mode, angle = driven.column("arbitration.mode"), driven.column("command.road_wheel_rad")
    per_tangent = driven.column("vehicle.vx_mps")[:-1] ** 2 / driven.wheelbase_m  # as the car was before each tick
    # A command counts from when it came, if it is plausible at the speed of any tick in which it is the newest.
    came = np.array([start, *sorted(sender.sent)])
    tangents = np.array([0.0, *(math.tan(abs(sender.sent[tick])) for tick in sorted(sender.sent))])
    ticks = np.arange(start + 1, start + len(mode))
    newest = np.searchsorted(came, ticks, side="right") - 1
    plausible = per_tangent * tangents[newest] <= WILD_MPS2
    latest = np.maximum.accumulate(np.where(plausible, came[newest], start))
    autonomous = mode[1:] == Mode.AUTONOMOUS
    longest = int((ticks - latest)[autonomous].max()) + 1  # the tick that is not autonomous any more
    assert np.abs(np.diff(angle)).max() <= MOST_RADPS / tick_hz + 1e-9, "the rate of the wheels"
    still = mode[1:] == Mode.AUTONOMOUS
    assert (per_tangent * np.tan(np.abs(angle[1:])) <= WILD_MPS2)[still].all(), "a wild angle is never commanded"
    left = np.flatnonzero(~still)
    if len(left):
        reason = driven.column("arbitration.reason")[1:][left[0]]
        assert reason in (Reason.COMMAND_INVALID, Reason.COMMAND_STALE)
    return Answer(longest / tick_hz, bool(len(left)))


@pytest.mark.fault("R06")
@pytest.mark.parametrize("tick_hz", RATES_HZ)
def test_r06_autonomy_ends_in_time_after_the_last_plausible_command(
    tick_hz: int, sample: Sample, measured: Measured
) -> None:
    """Every pattern by senders of 100 Hz down to 4 Hz, and by some of any rate."""
    chance = random.Random(sample.seed)
    periods_s = [0.01, 0.02, 0.05, 0.1, 0.16, 0.19, 0.25] if sample.long else [0.01, 0.1, 0.19, 0.25]
    periods_s += [chance.uniform(0.004, 0.4) for _ in range(sample.of(1, 50))]
    bar_s = LEFT_WITHIN_S + 1.0 / tick_hz
    longest_s = 0.0
    for name, pattern in PATTERNS.items():
        for period_s in periods_s:
            seed = chance.randrange(1 << 30)
            found = answer(tick_hz, pattern, period_s, seed, sample.of(2, 3))
            longest_s = max(longest_s, found.longest_s)
            assert found.longest_s <= bar_s, (name, period_s, seed)
            assert found.left or name not in ALWAYS, (name, period_s, seed)
    seen = f"{1e3 * longest_s:.0f} ms, {len(PATTERNS) * len(periods_s)} drives"
    measured("R06", f"AUTONOMOUS after the last plausible command, {tick_hz} Hz", seen, f"{1e3 * bar_s:.0f} ms")
