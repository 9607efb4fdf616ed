"""What the car's own way through the world sounds like: tyres on the road, wind, squeal."""

import math
from typing import Final

import numpy as np

from simconsole.hud.sound.directions import BACK_LEFT, BACK_RIGHT, CHANNELS, FRONT_LEFT, FRONT_RIGHT, LOW, Samples
from simconsole.hud.sound.heard import Heard
from simconsole.hud.sound.loops import Needle, noise_loop

CORNERS: Final = (FRONT_LEFT, FRONT_RIGHT, BACK_LEFT, BACK_RIGHT)
FULL_MPS: Final = 36.0
"""The speed at which road and wind have their full loudness."""
ROAD_LEVEL: Final = 0.16
WIND_LEVEL: Final = 0.12
SQUEAL_LEVEL: Final = 0.28
ROAD_POWER: Final = 1.5
"""The sound pressure of rolling tyres grows with about the 1.5th power of speed: 30 dB a decade."""
WIND_POWER: Final = 3.0
"""That of wind grows by 60 dB a decade: a dipole's sound power goes with the sixth power of the speed."""


class RoadNoise:
    """Noises in the four corners of the car, each elsewhere in its loop: nothing sounds from the middle."""

    def __init__(self, seed: int = 11) -> None:
        self._road = _corners(noise_loop(seed, 40.0, 700.0, -4.0))
        self._wind = _corners(noise_loop(seed + 1, 250.0, 3_000.0, -3.0))
        self._squeal = _corners(noise_loop(seed + 2, 850.0, 1_150.0))
        self._levels = np.zeros(3 * len(CORNERS))

    def add(self, block: Samples, heard: Heard) -> None:
        """Add the next samples to `block`, float32 [samples, 6]; levels glide from the last ones."""
        count = len(block)
        share = heard.speed_mps / FULL_MPS
        road = ROAD_LEVEL * min(1.5, share) ** ROAD_POWER
        wind = WIND_LEVEL * min(1.5, share) ** WIND_POWER
        axles = (heard.squeal_front, heard.squeal_front, heard.squeal_rear, heard.squeal_rear)
        wanted = np.array([road] * 4 + [wind] * 4 + [SQUEAL_LEVEL * level for level in axles])
        ramp = (np.arange(1, count + 1) / count).astype(np.float32)
        pitches = (0.6 + 0.8 * min(1.5, share), 0.8 + 0.4 * min(1.5, share), 0.9 + 0.2 * max(axles))
        needles = (*self._road, *self._wind, *self._squeal)
        for number, (needle, before, now) in enumerate(zip(needles, self._levels, wanted, strict=True)):
            if before == 0.0 and now == 0.0:
                continue
            sound = (before + (now - before) * ramp) * needle.read(count, pitches[number // len(CORNERS)])
            block[:, CORNERS[number % len(CORNERS)]] += sound
            if number < len(CORNERS):
                block[:, LOW] += 0.5 * sound
        self._levels = wanted


def _corners(loop: Samples) -> tuple[Needle, ...]:
    return tuple(Needle(loop, corner / math.sqrt(CHANNELS + corner)) for corner in range(len(CORNERS)))
