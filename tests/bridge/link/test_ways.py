import pytest

from simconsole.bridge.link.ways import Draws, ticks_on_the_way
from simconsole.profiles.link import WayProfile
from simconsole.values.draws import Channel
from tests.samples import Sample

TICK_HZ = 250
COUNT = 20_000


def ways(way: WayProfile, seed: int) -> list[int | None]:
    draws = Draws(seed, Channel.JITTER, Channel.LOSS)
    return [ticks_on_the_way(way, draws, number, TICK_HZ) for number in range(COUNT)]


def test_a_plain_delay_is_the_same_for_all(sample: Sample) -> None:
    assert set(ways(WayProfile(delay_ms=22.0), sample.seed)) == {6}  # 5.5 ticks, to the even one
    assert set(ways(WayProfile(), sample.seed)) == {0}


def test_jitter_is_spread_evenly_and_loss_is_as_large_as_said(sample: Sample) -> None:
    way = WayProfile(delay_ms=20.0, jitter_ms=40.0, loss_share=0.2)
    seen = ways(way, sample.seed)
    late = [ticks for ticks in seen if ticks is not None]
    assert len(late) / COUNT == pytest.approx(0.8, abs=0.02)
    assert set(late) == set(range(5, 16))
    assert sum(late) / len(late) == pytest.approx(10.0, abs=0.15)
    assert seen == ways(way, sample.seed), "drawn anew it is the same"
    assert seen != ways(way, sample.seed + 1)
