"""Loudness follows direction, and goes all around."""

import math

import numpy as np
import pytest

from simconsole.hud.sound.directions import (
    BACK_LEFT,
    BACK_RIGHT,
    CENTRE,
    FOLD,
    FRONT_LEFT,
    FRONT_RIGHT,
    LOW,
    gains,
    samples,
    to_stereo,
)

LOUDSPEAKERS = {0.0: CENTRE, 30.0: FRONT_LEFT, -30.0: FRONT_RIGHT, 110.0: BACK_LEFT, -110.0: BACK_RIGHT}


@pytest.mark.parametrize(("bearing_deg", "loudspeaker"), LOUDSPEAKERS.items())
def test_from_where_a_loudspeaker_stands_only_that_one_plays(bearing_deg: float, loudspeaker: int) -> None:
    found = gains(math.radians(bearing_deg))
    assert found[loudspeaker] == pytest.approx(1.0)
    assert sum(abs(gain) for gain in found) == pytest.approx(1.0, abs=1e-6)


def test_all_around_the_loudness_is_the_same_and_never_jumps() -> None:
    bearings = np.linspace(-2.0 * math.pi, 2.0 * math.pi, 2_000)
    found = np.array([gains(bearing) for bearing in bearings])
    assert np.square(found).sum(axis=1) == pytest.approx(1.0)
    assert np.abs(np.diff(found, axis=0)).max() < 0.03
    assert (found[:, LOW] == 0.0).all()
    assert (found >= 0.0).all()


def test_left_is_left_and_behind_is_behind() -> None:
    left, behind = gains(math.radians(90.0)), gains(math.pi)
    assert left[FRONT_LEFT] + left[BACK_LEFT] > 1.0 > 1e-9 > left[FRONT_RIGHT] + left[BACK_RIGHT]
    assert behind[BACK_LEFT] == pytest.approx(behind[BACK_RIGHT])


def test_two_loudspeakers_have_all_but_the_low_frequencies() -> None:
    block = samples(np.eye(6))
    left, right = to_stereo(block).T
    assert left == pytest.approx([1.0, 0.0, FOLD, 0.0, FOLD, 0.0])
    assert right == pytest.approx([0.0, 1.0, FOLD, 0.0, 0.0, FOLD])
