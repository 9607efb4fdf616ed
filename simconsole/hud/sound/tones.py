"""Sounds that tell something: chimes, warnings, the take-over call, the indicators' relay, the horn, a grinding gear.

Each has a pattern of beeps that repeats; a tone that ends or gives way fades within a few milliseconds.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from simconsole.hud.dial import lamps_on
from simconsole.hud.sound.directions import Samples, samples
from simconsole.hud.sound.heard import Heard, Tone
from simconsole.hud.sound.loops import RATE_HZ

EDGE_S: Final = 0.008
"""A beep's rise and fall: an edge of no length would click."""


class Beep(NamedTuple):
    """A part of a pattern: from when, for how long, how high."""

    from_s: float
    for_s: float
    hz: float


class Pattern(NamedTuple):
    """Beeps that repeat after a period; without one (0) they sound once."""

    beeps: tuple[Beep, ...]
    period_s: float
    level: float


PATTERNS: Final[dict[Tone, Pattern]] = {
    Tone.ENGAGED: Pattern((Beep(0.0, 0.16, 660.0), Beep(0.18, 0.26, 880.0)), 0.0, 0.35),
    Tone.RELEASED: Pattern((Beep(0.0, 0.16, 880.0), Beep(0.18, 0.26, 660.0)), 0.0, 0.35),
    Tone.WARNING: Pattern((Beep(0.0, 0.12, 740.0), Beep(0.2, 0.12, 740.0)), 0.0, 0.35),
    Tone.TAKE_OVER: Pattern((Beep(0.0, 0.14, 950.0), Beep(0.22, 0.14, 950.0)), 1.0, 0.5),
    Tone.TAKE_OVER_NOW: Pattern((Beep(0.0, 0.11, 1250.0), Beep(0.16, 0.11, 1250.0)), 0.32, 0.75),
    Tone.STOPPING: Pattern((Beep(0.0, 0.35, 620.0), Beep(0.4, 0.35, 520.0)), 0.9, 0.6),
}
"""Between 500 and 1,300 Hz, where hearing is good at any age; the more urgent, the faster, higher and louder."""

RELAY_HZ: Final = 2_300.0
RELAY_FALL_S: Final = 0.004
HORN_HZ: Final = (410.0, 490.0)
HORN_HARMONICS: Final = 6
GRIND_HZ: Final = 95.0
RAMP_S: Final = 0.012


class Telling:
    """The tone that is told now, the one before it while it fades, and the relay."""

    def __init__(self) -> None:
        self._tone = Tone.NONE
        self._since = 0  # samples
        self._fading: Samples = np.zeros(0, np.float32)
        self._relay_lit = False
        self._click: Samples = np.zeros(0, np.float32)

    def tone(self, count: int, tone: Tone) -> Samples:
        """Return the next samples of what is told."""
        if tone is not self._tone:
            left = round(RAMP_S * RATE_HZ)
            fall = np.linspace(1.0, 0.0, left, dtype=np.float32)
            self._fading = fall * _beeps(PATTERNS.get(self._tone), self._since, left)
            self._tone, self._since = tone, 0
        block = _beeps(PATTERNS.get(tone), self._since, count)
        self._since += count
        taken, self._fading = self._fading[:count], self._fading[count:]
        block[: len(taken)] += taken
        return block

    def relay(self, count: int, heard: Heard) -> Samples:
        """Return the relay of the indicators: a tick when the lamps light, a tock when they go out."""
        lit = heard.indicators and lamps_on(heard.t_s)
        if lit != self._relay_lit:
            self._relay_lit = lit
            times_s = np.arange(round(10.0 * RELAY_FALL_S * RATE_HZ)) / RATE_HZ
            hz = RELAY_HZ if lit else 0.8 * RELAY_HZ
            self._click = samples(0.25 * np.exp(-times_s / RELAY_FALL_S) * np.sin(2.0 * math.pi * hz * times_s))
        block = np.zeros(count, np.float32)
        taken, self._click = self._click[:count], self._click[count:]
        block[: len(taken)] = taken
        return block


class Held:
    """A sound that lasts while something does: it comes and goes within RAMP_S."""

    def __init__(self, frequencies_hz: tuple[float, ...], harmonics: int, level: float) -> None:
        self._hz = np.array([number * hz for hz in frequencies_hz for number in range(1, harmonics + 1)])
        parts = [1.0 / number for _ in frequencies_hz for number in range(1, harmonics + 1)]
        self._parts = level * np.array(parts) / np.sqrt(np.square(parts).sum())
        self._phases = np.zeros(self._hz.size)
        self._gain = 0.0

    def block(self, count: int, *, on: bool) -> Samples:
        """Return the next samples."""
        step = 1.0 / (RAMP_S * RATE_HZ)
        ways = np.arange(1, count + 1) * (step if on else -step)
        gain = np.clip(self._gain + ways, 0.0, 1.0)
        self._gain = float(gain[-1])
        if not gain.any():
            return np.zeros(count, np.float32)
        angles = self._phases[:, None] + 2.0 * math.pi / RATE_HZ * np.outer(self._hz, np.arange(count))
        self._phases = (self._phases + 2.0 * math.pi / RATE_HZ * self._hz * count) % (2.0 * math.pi)
        return samples(gain * (self._parts @ np.sin(angles)))


def _beeps(pattern: Pattern | None, since: int, count: int) -> Samples:
    """Return `count` samples of a pattern, from its sample `since` on."""
    block = np.zeros(count)
    if pattern is None:
        return samples(block)
    times_s = (since + np.arange(count)) / RATE_HZ
    if pattern.period_s > 0.0:
        times_s = times_s % pattern.period_s
    for beep in pattern.beeps:
        inside_s = np.minimum(times_s - beep.from_s, beep.from_s + beep.for_s - times_s)
        envelope = np.clip(inside_s / EDGE_S, 0.0, 1.0)
        block += envelope * np.sin(2.0 * math.pi * beep.hz * (times_s - beep.from_s))
    return samples(pattern.level * block)
