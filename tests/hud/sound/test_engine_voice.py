"""The engine's tone is the one of its speed and its cylinders."""

import math
from itertools import pairwise

import numpy as np
import pytest

from simconsole.hud.sound.directions import Samples
from simconsole.hud.sound.engine_voice import LOW_HZ, EngineVoice
from simconsole.hud.sound.loops import RATE_HZ
from tests.samples import Sample

BLOCK = 1024


def loudest_hz(sound: Samples) -> float:
    spectrum = np.abs(np.fft.rfft(sound * np.hanning(len(sound))))
    return float(spectrum.argmax() * RATE_HZ / len(sound))


def steady(rpm: float, cylinders: int, load: float, blocks: int = 100) -> Samples:
    voice = EngineVoice(cylinders)
    return np.concatenate([voice.block(BLOCK, rpm * math.pi / 30.0, load)[0] for _ in range(blocks)])[BLOCK:]


def test_the_loudest_tone_is_that_of_the_firings(sample: Sample) -> None:
    chance = np.random.default_rng(sample.seed)
    for _ in range(sample.of(12, 400)):
        rpm, cylinders, load = chance.uniform(700.0, 7_000.0), int(chance.choice((3, 4, 5, 6, 8))), chance.uniform()
        assert loudest_hz(steady(rpm, cylinders, load)) == pytest.approx(rpm / 60.0 * cylinders / 2.0, rel=0.01)


def test_more_load_is_louder_and_sharper() -> None:
    quiet, loud = steady(3_000.0, 4, 0.0), steady(3_000.0, 4, 1.0)
    assert np.square(loud).mean() > 4.0 * np.square(quiet).mean()
    above = [np.square(np.abs(np.fft.rfft(sound))[len(sound) * 300 // RATE_HZ :]).sum() for sound in (quiet, loud)]
    whole = [np.square(np.abs(np.fft.rfft(sound))).sum() for sound in (quiet, loud)]
    assert above[1] / whole[1] > above[0] / whole[0]


def test_a_change_of_speed_has_no_click() -> None:
    voice = EngineVoice(4)
    pieces = [voice.block(BLOCK, radps, 0.5)[0] for radps in (100.0, 300.0, 300.0, 150.0, 600.0)]
    joints = [abs(float(after[0] - before[-1])) for before, after in pairwise(pieces)]
    within = max(float(np.abs(np.diff(piece)).max()) for piece in pieces)
    assert max(joints) <= within


def test_a_standing_engine_is_silent_and_fades_on_the_way() -> None:
    voice = EngineVoice(4)
    assert not voice.block(BLOCK, 0.0, 1.0)[0].any()
    assert voice.block(BLOCK, 100.0, 0.2)[0].any()
    assert voice.block(BLOCK, 0.0, 0.0)[0].any()
    assert not voice.block(BLOCK, 0.0, 0.0)[0].any()


def test_low_frequencies_are_low() -> None:
    voice = EngineVoice(4)
    low = np.concatenate([voice.block(BLOCK, 2_000.0 * math.pi / 30.0, 1.0)[1] for _ in range(100)])[BLOCK:]
    power = np.square(np.abs(np.fft.rfft(low * np.hanning(len(low)))))
    hz = np.fft.rfftfreq(len(low), 1.0 / RATE_HZ)
    assert power[hz > 1.1 * LOW_HZ].sum() < 1e-4 * power.sum()
