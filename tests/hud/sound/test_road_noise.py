import numpy as np
import pytest

from simconsole.hud.sound.directions import BACK_LEFT, BACK_RIGHT, CENTRE, FRONT_LEFT, FRONT_RIGHT, Samples
from simconsole.hud.sound.heard import Heard
from simconsole.hud.sound.road_noise import RoadNoise

BLOCK = 1024


def noise(heard: Heard, blocks: int = 60) -> Samples:
    road = RoadNoise()
    found = []
    for _ in range(blocks):
        block = np.zeros((BLOCK, 6), np.float32)
        road.add(block, heard)
        found.append(block)
    return np.concatenate(found[2:])


def levels(sound: Samples) -> Samples:
    return np.asarray(np.sqrt(np.square(sound).mean(axis=0)), np.float32)


def test_a_standing_car_makes_no_noise_and_a_fast_one_more_than_a_slow_one() -> None:
    assert not noise(Heard()).any()
    slow, middle, fast = (levels(noise(Heard(speed_mps=speed)))[FRONT_LEFT] for speed in (8.0, 16.0, 32.0))
    assert middle > 2.5 * slow
    assert fast > 2.5 * middle


def test_noise_of_the_road_comes_from_everywhere_and_not_from_the_middle() -> None:
    sound = noise(Heard(speed_mps=25.0))
    corners = levels(sound)[[FRONT_LEFT, FRONT_RIGHT, BACK_LEFT, BACK_RIGHT]]
    assert corners.min() > 0.7 * corners.max()
    assert levels(sound)[CENTRE] == 0.0
    assert abs(np.corrcoef(sound[:, FRONT_LEFT], sound[:, FRONT_RIGHT])[0, 1]) < 0.2


@pytest.mark.parametrize(
    ("heard", "loud", "quiet"),
    [
        (Heard(speed_mps=5.0, squeal_front=1.0), FRONT_LEFT, BACK_LEFT),
        (Heard(speed_mps=5.0, squeal_rear=1.0), BACK_RIGHT, FRONT_RIGHT),
    ],
)
def test_the_axle_that_slides_is_the_one_that_squeals(heard: Heard, loud: int, quiet: int) -> None:
    found = levels(noise(heard))
    assert found[loud] > 5.0 * found[quiet]


def test_noise_sets_in_and_ends_without_a_click() -> None:
    road = RoadNoise()
    found = []
    for speed in (0.0, 30.0, 30.0, 0.0, 0.0):
        block = np.zeros((BLOCK, 6), np.float32)
        road.add(block, Heard(speed_mps=speed))
        found.append(block)
    sound = np.concatenate(found)
    assert np.abs(sound[BLOCK]).max() < 0.01
    assert np.abs(sound[4 * BLOCK - 1]).max() < 0.01
    assert not found[-1].any()
