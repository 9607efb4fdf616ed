"""All that is heard, as blocks of six columns."""

from typing import Final

import numpy as np

from simconsole.hud.sound.directions import (
    BACK_LEFT,
    BACK_RIGHT,
    CENTRE,
    CHANNELS,
    FRONT_LEFT,
    FRONT_RIGHT,
    LOW,
    Samples,
)
from simconsole.hud.sound.engine_voice import EngineVoice
from simconsole.hud.sound.heard import Heard
from simconsole.hud.sound.passing import Passing
from simconsole.hud.sound.road_noise import RoadNoise
from simconsole.hud.sound.tones import GRIND_HZ, HORN_HARMONICS, HORN_HZ, Held, Telling
from simconsole.profiles.view import SoundProfile

ENGINE_LEVEL: Final = 0.14
ENGINE_GAINS: Final = {FRONT_LEFT: 0.6, FRONT_RIGHT: 0.6, CENTRE: 0.4, BACK_LEFT: 0.25, BACK_RIGHT: 0.25}
LOW_GAIN: Final = 0.7
AHEAD: Final = {FRONT_LEFT: 0.5, FRONT_RIGHT: 0.5, CENTRE: 0.7}
"""What is told to the driver comes from ahead, also where there are two loudspeakers only."""


class Mixer:
    """Makes the next block of sound of what is heard; equal moments give equal samples."""

    def __init__(self, cylinders: int, profile: SoundProfile) -> None:
        self._profile = profile
        self._engine = EngineVoice(cylinders)
        self._road = RoadNoise()
        self._passing = Passing()
        self._telling = Telling()
        self._horn = Held(HORN_HZ, HORN_HARMONICS, 0.35)
        self._grind = Held((GRIND_HZ, 1.414 * GRIND_HZ), 14, 0.3)

    def block(self, heard: Heard, count: int) -> Samples:
        """Return `count` samples, float32 [count, 6] within -1 and 1."""
        profile = self._profile
        mixed = np.zeros((count, CHANNELS), np.float32)
        self._road.add(mixed, heard)
        mixed *= np.float32(profile.road)
        if profile.others > 0.0:
            around = np.zeros_like(mixed)
            self._passing.add(around, heard.others)
            mixed += np.float32(profile.others) * around
        engine, low = self._engine.block(count, heard.engine_radps, heard.load)
        loudness = np.float32(ENGINE_LEVEL * profile.engine)
        for channel, gain in ENGINE_GAINS.items():
            mixed[:, channel] += np.float32(gain) * loudness * engine
        mixed[:, LOW] += np.float32(LOW_GAIN) * loudness * low
        own = self._horn.block(count, on=heard.horn) + self._grind.block(count, on=heard.grind)
        mixed *= np.float32(profile.volume)
        told = self._telling.tone(count, heard.tone) + self._telling.relay(count, heard)
        ahead = np.float32(profile.volume) * own + np.float32(profile.warnings) * told
        for channel, gain in AHEAD.items():
            mixed[:, channel] += np.float32(gain) * ahead
        mixed *= np.array([profile.gains[channel] for channel in range(CHANNELS)], np.float32)
        return np.tanh(mixed)
