"""Loudspeakers are never left without a block, on a clock of the test's own."""

import numpy as np

from simconsole.hud.audio.player import BLOCK, POLL_S, play
from simconsole.hud.sound.directions import Samples
from simconsole.hud.sound.heard import Heard
from simconsole.hud.sound.loops import RATE_HZ
from simconsole.hud.sound.mix import Mixer
from simconsole.profiles.view import SoundProfile
from tests.samples import Sample

MIX_S = 0.004
"""What mixing a block may take here: many times what it does."""


class Device:
    """A sound device with a clock: one block sounds, one waits."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.ends_s = 0.0
        self.waiting = False
        self.starved = 0
        self.blocks = 0

    def wants(self) -> bool:
        if self.waiting and self.now_s >= self.ends_s:
            self.ends_s += BLOCK / RATE_HZ
            self.waiting = False
        return not self.waiting

    def play(self, block: Samples) -> None:
        assert block.shape == (BLOCK, 6)
        self.now_s += MIX_S
        self.blocks += 1
        if self.now_s < self.ends_s:
            self.waiting = True
            return
        self.starved += self.blocks > 1
        self.ends_s = self.now_s + BLOCK / RATE_HZ


class Silent(Mixer):
    """A mixer that costs nothing: what it mixes is tests/hud/sound's matter."""

    def block(self, heard: Heard, count: int) -> Samples:
        return np.zeros((count, 6), np.float32)


def played(late_s: float, seed: int, blocks: int) -> Device:
    device, chance = Device(), np.random.default_rng(seed)

    def pause(seconds: float) -> None:
        assert seconds == POLL_S
        device.now_s += seconds + chance.uniform(0.0, late_s)

    play(lambda: Heard(), Silent(4, SoundProfile()), device, lambda: device.blocks >= blocks, pause)
    return device


def test_thirty_thousand_blocks_without_a_gap(sample: Sample) -> None:
    assert played(0.012, sample.seed, 30_000).starved == 0


def test_a_process_that_is_held_up_for_longer_than_a_block_leaves_gaps_that_are_counted(sample: Sample) -> None:
    assert played(0.060, sample.seed, 2_000).starved > 0


def test_it_stops_when_told() -> None:
    device = Device()
    play(lambda: Heard(), Silent(4, SoundProfile()), device, lambda: True, lambda _: None)
    assert device.blocks == 0
    assert device.now_s == 0.0
