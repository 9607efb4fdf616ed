"""The engine: a sum of its orders, multiples of half the crankshaft's speed.

A four-stroke engine fires cylinders / 2 times in a turn: that order is the loudest, its multiples fall off, and what
differs from cylinder to cylinder gives the half orders between them.
"""

import math
from typing import Final

import numpy as np

from simconsole.hud.sound.directions import Samples, samples
from simconsole.hud.sound.loops import RATE_HZ

HALF_ORDERS: Final = 36
HIGHEST_HZ: Final = 9_000.0
LOW_HZ: Final = 120.0
"""Up to here the loudspeaker for low frequencies plays along."""
IDLE_LEVEL: Final = 0.35
"""Loudness without load, as a share of that with full load."""
STILL_RADPS: Final = 15.0
"""Below this the crankshaft is nearly at rest: nothing to hear."""


class EngineVoice:
    """One engine, block after block without a break."""

    def __init__(self, cylinders: int, seed: int = 7) -> None:
        self._halves = np.arange(1, HALF_ORDERS + 1)
        firing = max(1, cylinders)  # in half orders
        multiple = self._halves / firing
        is_harmonic = self._halves % firing == 0
        self._quiet = np.where(is_harmonic, multiple**-1.6, 0.10 / np.sqrt(self._halves))
        self._loud = np.where(is_harmonic, multiple**-1.0, 0.22 / np.sqrt(self._halves))
        self._offsets = np.random.default_rng(seed).uniform(0.0, 2.0 * math.pi, HALF_ORDERS)
        self._turns = 0.0  # of a half order
        self._radps = 0.0
        self._level = 0.0
        self._load = 0.0

    def block(self, count: int, engine_radps: float, load: float) -> tuple[Samples, Samples]:
        """Return the next samples, all of them and their low frequencies alone; speed and loudness glide to these.

        Args:
            count: how many samples.
            engine_radps: the crankshaft's speed at their end.
            load: 0 to 1.
        """
        level = 0.0
        if engine_radps > STILL_RADPS:
            level = (IDLE_LEVEL + (1.0 - IDLE_LEVEL) * load) * min(1.0, engine_radps / 80.0)
        ramp = np.arange(1, count + 1) / count
        half_hz = (self._radps + (engine_radps - self._radps) * ramp) / (4.0 * math.pi)
        turns = self._turns + np.cumsum(half_hz) / RATE_HZ
        loudness = self._level + (level - self._level) * ramp
        mean_load = 0.5 * (self._load + load)
        self._turns = float(turns[-1]) % 1.0
        self._radps, self._level, self._load = engine_radps, level, load
        if not loudness.any():
            silence = np.zeros(count, np.float32)
            return silence, silence
        amplitudes = self._quiet + (self._loud - self._quiet) * mean_load
        top_hz = float(half_hz.max())
        heard = self._halves * top_hz < HIGHEST_HZ
        halves, offsets = self._halves[heard], self._offsets[heard]
        waves = np.sin(2.0 * math.pi * np.outer(halves, turns) + offsets[:, None]) * amplitudes[heard][:, None]
        low = waves[halves * top_hz < LOW_HZ].sum(axis=0)
        return samples(loudness * waves.sum(axis=0)), samples(loudness * low)
