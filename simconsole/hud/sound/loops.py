"""Noise that repeats without a seam, made once from a seed, and a needle that reads it at any pitch."""

import math
from typing import Final

import numpy as np

from simconsole.hud.sound.directions import Samples

RATE_HZ: Final = 48_000
LOOP_S: Final = 4.0


def noise_loop(seed: int, low_hz: float, high_hz: float, slope_db_per_octave: float = 0.0) -> Samples:
    """Return LOOP_S of noise between two frequencies, of an effective value of 1; its end fits its start.

    Args:
        seed: the same one gives the same samples.
        low_hz: where its spectrum begins, with a soft slope.
        high_hz: where it ends.
        slope_db_per_octave: how its spectrum falls (negative) or rises between them.
    """
    count = round(RATE_HZ * LOOP_S)
    hz = np.fft.rfftfreq(count, 1.0 / RATE_HZ)[1:]
    octaves = np.log2(hz / low_hz)
    shape = 10.0 ** (slope_db_per_octave * octaves / 20.0)
    shape /= np.sqrt((1.0 + (low_hz / hz) ** 4) * (1.0 + (hz / high_hz) ** 8))
    phases = np.random.default_rng(seed).uniform(0.0, 2.0 * math.pi, hz.size)
    spectrum = np.concatenate(([0.0], shape * np.exp(1j * phases)))
    wave = np.fft.irfft(spectrum, count)
    return np.asarray(wave / np.sqrt(np.mean(wave**2)), np.float32)


class Needle:
    """Reads a loop; `pitch` 1 reads it as it was made, 2 an octave higher."""

    def __init__(self, loop: Samples, start_share: float = 0.0) -> None:
        self._loop = loop
        self._at = start_share * len(loop)

    def read(self, count: int, pitch: float = 1.0) -> Samples:
        """Return the next `count` samples."""
        length = len(self._loop)
        places = self._at + pitch * np.arange(count)
        self._at = (self._at + pitch * count) % length
        whole = places.astype(np.int64)
        share = (places - whole).astype(np.float32)
        before, after = self._loop[whole % length], self._loop[(whole + 1) % length]
        return np.asarray(before + share * (after - before), np.float32)
