"""All sounds together."""

import math

import numpy as np
import pytest

from simconsole.hud.sound.directions import BACK_LEFT, CENTRE, FRONT_LEFT, FRONT_RIGHT, LOW, Samples
from simconsole.hud.sound.heard import Heard, OtherHeard, Tone
from simconsole.hud.sound.mix import Mixer
from simconsole.profiles.view import SoundProfile

BLOCK = 1024
BUSY = Heard(
    engine_radps=600.0,
    load=1.0,
    speed_mps=50.0,
    squeal_front=1.0,
    squeal_rear=1.0,
    grind=True,
    indicators=True,
    horn=True,
    tone=Tone.TAKE_OVER_NOW,
    others=tuple(OtherHeard(float(n), 1.0 * n, 2.0, 30.0, 5.0) for n in range(6)),
)


PLAIN = SoundProfile()


def mixed(heard: Heard, profile: SoundProfile = PLAIN, blocks: int = 50) -> Samples:
    mixer = Mixer(4, profile)
    return np.concatenate([mixer.block(heard, BLOCK) for _ in range(blocks)])[BLOCK:]


def levels(sound: Samples) -> Samples:
    return np.asarray(np.sqrt(np.square(sound).mean(axis=0)), np.float32)


def test_everything_at_once_stays_within_full_scale() -> None:
    sound = mixed(BUSY)
    assert sound.dtype == np.float32
    assert np.abs(sound).max() < 1.0
    assert np.isfinite(sound).all()
    assert (levels(sound) > 0.05).all()


def test_the_same_moments_give_the_same_samples() -> None:
    assert (mixed(BUSY) == mixed(BUSY)).all()


def test_nothing_to_hear_is_silence() -> None:
    assert not mixed(Heard()).any()


def test_a_warning_is_heard_with_the_volume_down_and_over_a_loud_drive() -> None:
    driving = Heard(engine_radps=400.0, load=0.8, speed_mps=36.0)
    down = mixed(driving._replace(tone=Tone.TAKE_OVER_NOW), SoundProfile(volume=0.0))
    assert levels(down)[CENTRE] > 0.1
    beside, alone = levels(mixed(driving))[CENTRE], levels(mixed(Heard(tone=Tone.TAKE_OVER_NOW)))[CENTRE]
    assert alone > beside


def test_shares_of_the_profile_count() -> None:
    engine = Heard(engine_radps=300.0, load=1.0)
    assert not mixed(engine, SoundProfile(engine=0.0)).any()
    assert not mixed(Heard(speed_mps=30.0), SoundProfile(road=0.0)).any()
    passing = Heard(others=(OtherHeard(1.0, math.pi / 2.0, 5.0, 14.0, 0.0),))
    assert not mixed(passing, SoundProfile(others=0.0)).any()
    quiet = levels(mixed(engine, SoundProfile(volume=0.4)))
    assert quiet == pytest.approx(0.5 * levels(mixed(engine, SoundProfile(volume=0.8))), rel=0.02)


def test_a_loudspeaker_can_be_switched_off() -> None:
    sound = mixed(BUSY, SoundProfile(gains=(1.0, 0.0, 1.0, 1.0, 1.0, 1.0)))
    assert not sound[:, FRONT_RIGHT].any()
    assert sound[:, FRONT_LEFT].any()


def test_the_engine_is_in_front_and_in_the_floor() -> None:
    found = levels(mixed(Heard(engine_radps=90.0, load=1.0)))
    assert found[FRONT_LEFT] == pytest.approx(found[FRONT_RIGHT])
    assert found[FRONT_LEFT] > 2.0 * found[BACK_LEFT] > 0.0
    assert found[LOW] > 0.0
