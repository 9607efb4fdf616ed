import numpy as np
import pytest

from simconsole.hud.audio.speaker_test import LOW_TONE_HZ, TONE_HZ, TONE_S, play_tones
from simconsole.hud.sound.directions import LOW, NAMES, Samples
from simconsole.hud.sound.loops import RATE_HZ


class Kept:
    """Loudspeakers that keep what they get."""

    def __init__(self) -> None:
        self.starved = 0
        self.blocks: list[Samples] = []
        self.busy = False

    def wants(self) -> bool:
        self.busy = not self.busy
        return self.busy

    def play(self, block: Samples) -> None:
        self.blocks.append(block)


def test_each_loudspeaker_in_turn_says_its_name_and_plays_alone() -> None:
    said: list[str] = []
    starts: list[int] = []
    kept = Kept()

    def say(name: str) -> None:
        said.append(name)
        starts.append(sum(len(block) for block in kept.blocks))

    waits: list[float] = []
    results = play_tones(kept, say, waits.append)
    assert said == list(NAMES) == results["loudspeakers"]
    assert waits, "asked whether there is room"
    sound = np.concatenate(kept.blocks)
    for channel, start in enumerate(starts):
        part = sound[start : start + round(TONE_S * RATE_HZ)]
        others = np.delete(part, channel, axis=1)
        assert not others.any()
        hz = float(np.abs(np.fft.rfft(part[:, channel])).argmax()) / TONE_S
        assert hz == pytest.approx(LOW_TONE_HZ if channel == LOW else TONE_HZ, abs=1.0)
