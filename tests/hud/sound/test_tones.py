"""Tones have the pitch of their pattern, repeat, and neither begin nor end with a click."""

import numpy as np
import pytest

from simconsole.hud.sound.directions import Samples
from simconsole.hud.sound.heard import Heard, Tone
from simconsole.hud.sound.loops import RATE_HZ
from simconsole.hud.sound.tones import HORN_HZ, PATTERNS, Held, Telling

BLOCK = 1024


def told(telling: Telling, tone: Tone, seconds: float) -> Samples:
    return np.concatenate([telling.tone(BLOCK, tone) for _ in range(round(seconds * RATE_HZ / BLOCK))])


def loudest_hz(sound: Samples) -> float:
    return float(np.abs(np.fft.rfft(sound)).argmax() * RATE_HZ / len(sound))


@pytest.mark.parametrize("tone", PATTERNS)
def test_each_tone_begins_at_once_with_the_pitch_of_its_first_beep(tone: Tone) -> None:
    beep = PATTERNS[tone].beeps[0]
    sound = told(Telling(), tone, beep.for_s)
    assert loudest_hz(sound) == pytest.approx(beep.hz, abs=12.0)
    assert np.abs(sound).max() == pytest.approx(PATTERNS[tone].level, rel=0.05)


@pytest.mark.parametrize("tone", PATTERNS)
def test_what_is_urgent_repeats_and_a_chime_does_not(tone: Tone) -> None:
    telling = Telling()
    told(telling, tone, 2.0)
    assert told(telling, tone, 2.0).any() == (PATTERNS[tone].period_s > 0.0)


def test_the_more_urgent_the_louder_and_the_faster() -> None:
    asked, urgent = PATTERNS[Tone.TAKE_OVER], PATTERNS[Tone.TAKE_OVER_NOW]
    assert urgent.level > asked.level > PATTERNS[Tone.WARNING].level
    assert urgent.period_s < 0.5 * asked.period_s


def test_no_change_of_tone_clicks() -> None:
    telling = Telling()
    order = (Tone.TAKE_OVER, Tone.TAKE_OVER_NOW, Tone.NONE, Tone.STOPPING, Tone.ENGAGED, Tone.NONE, Tone.NONE)
    sound = np.concatenate([telling.tone(BLOCK, tone) for tone in order for _ in range(3)])
    steepest = max(2.0 * np.pi * beep.hz * p.level / RATE_HZ for p in PATTERNS.values() for beep in p.beeps)
    assert np.abs(np.diff(sound)).max() < 1.6 * steepest


def test_the_relay_ticks_with_the_lamps() -> None:
    telling = Telling()
    clicks = []
    for number in range(round(4.0 * RATE_HZ / BLOCK)):
        heard = Heard(indicators=True, t_s=number * BLOCK / RATE_HZ)
        clicks.append(bool(np.abs(telling.relay(BLOCK, heard)).max() > 0.1))
    assert sum(clicks) == 12, "lit and out, 90 times a minute, for 4 s"
    assert not telling.relay(BLOCK, Heard(t_s=4.0)).max() > 0.1


def test_a_held_sound_comes_and_goes_softly() -> None:
    horn = Held(HORN_HZ, 6, 0.35)
    assert not horn.block(BLOCK, on=False).any()
    sound = np.concatenate([horn.block(BLOCK, on=on) for on in (True, True, True, False, False)])
    assert not sound[-BLOCK:].any()
    assert np.abs(np.diff(sound)).max() < 0.2
    both = np.concatenate([horn.block(BLOCK, on=True) for _ in range(60)])[2 * BLOCK :]
    spectrum = np.abs(np.fft.rfft(both))
    first, second = (round(hz * len(both) / RATE_HZ) for hz in HORN_HZ)
    for peak in (first, second):
        assert spectrum[peak - 3 : peak + 4].max() > 0.5 * spectrum.max()
