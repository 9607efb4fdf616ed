import numpy as np
import pytest

from simconsole.values.draws import Channel, bounded, even, normal, normals, wandering
from tests.samples import Sample


def test_equal_seed_channel_and_number_draw_equally() -> None:
    assert normal(3, Channel.X, 17) == normal(3, Channel.X, 17)
    assert len({normal(3, Channel.X, 17), normal(4, Channel.X, 17), normal(3, Channel.Y, 17)}) == 3


def test_the_bits_are_the_same_on_every_machine() -> None:
    assert even(1, Channel.LOSS, 1) == pytest.approx(0.8576723202370876, abs=0.0)
    assert normal(1, Channel.X, 1) == pytest.approx(-0.9572601318359375, abs=0.0)


@pytest.mark.parametrize("channel", [Channel.X, Channel.DRIFT_YAW])
def test_normal_numbers_are_normal_and_white(sample: Sample, channel: Channel) -> None:
    count = sample.of(20_000, 1_000_000)
    drawn = np.array([normal(sample.seed, channel, number) for number in range(count)])
    margin = 5.0 / np.sqrt(count)
    assert abs(drawn.mean()) < margin
    assert abs(drawn.std() - 1.0) < margin
    assert np.abs(drawn).max() <= 6.0
    assert abs((np.abs(drawn) < 1.0).mean() - 0.6827) < margin + 0.005  # twelve addends are not quite normal
    assert abs((drawn[1:] * drawn[:-1]).mean()) < margin


def test_even_numbers_fill_their_range(sample: Sample) -> None:
    count = sample.of(20_000, 1_000_000)
    drawn = np.array([even(sample.seed, Channel.LOSS, number) for number in range(count)])
    assert drawn.min() >= 0.0
    assert drawn.max() < 1.0
    counts, _ = np.histogram(drawn, 20, (0.0, 1.0))
    assert np.abs(counts / count - 0.05).max() < 5.0 * np.sqrt(0.05 / count)


def test_a_wandering_curve_goes_through_normal_numbers_without_a_corner(sample: Sample) -> None:
    knots = [wandering(sample.seed, Channel.PERSON_AIM, float(place)) for place in range(1, 20)]
    assert knots == [normal(sample.seed, Channel.PERSON_AIM, place) for place in range(1, 20)]
    assert wandering(sample.seed, Channel.PERSON_AIM, 0.0) == 0.0
    places = np.arange(0.0, 2000.0, 0.05)
    curve = np.array([wandering(sample.seed, Channel.PERSON_AIM, place) for place in places.tolist()])
    assert np.abs(np.diff(curve, 2)).max() < 0.2
    assert abs(curve.std() - 0.86) < 0.06


def test_bounded_numbers_spread_as_normal_ones_and_have_no_tails(sample: Sample) -> None:
    count = sample.of(20_000, 1_000_000)
    drawn = np.array([bounded(sample.seed, Channel.PERSON_AIM, number) for number in range(count)])
    assert abs(drawn.mean()) < 5.0 / np.sqrt(count)
    assert abs(drawn.std() - 1.0) < 5.0 / np.sqrt(count)
    assert np.abs(drawn).max() <= np.sqrt(3.0)
    assert wandering(sample.seed, Channel.PERSON_AIM, 7.0, bounded) == drawn[7]


def test_many_numbers_at_once_are_those_one_by_one(sample: Sample) -> None:
    for first in (0, 7, 2**40):
        found = normals(sample.seed, Channel.LIDAR, first, 300)
        assert found.tolist() == [normal(sample.seed, Channel.LIDAR, first + index) for index in range(300)]
