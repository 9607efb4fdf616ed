"""Compliance and benefit of speed advice, by a drive past three lights."""

from collections.abc import Iterator, Sequence

import numpy as np
import pytest

from simconsole.evaluation.metrics.advice_metrics import advice_metrics
from simconsole.evaluation.metrics.table import Drive
from simconsole.evaluation.metrics.track import Track
from simconsole.recording.recorded_advice import AdviceAt

HZ, LIMIT_MPS = 10, 10.0


def driven(speeds: Sequence[float], distance: Sequence[float], advice: tuple[AdviceAt, ...]) -> tuple[Drive, Track]:
    def read(names: Sequence[str]) -> Iterator[np.ndarray]:
        assert names == ("situation.signal_distance_m",)
        yield np.array(distance, dtype=float).reshape(-1, 1)

    count = len(speeds)
    way = Track(
        distance_m=np.cumsum(speeds) / HZ,
        speed_mps=np.array(speeds, dtype=float),
        mode=np.zeros(count, np.int8),
        lateral_m=np.zeros(0),
        limit_mps=np.full(count, LIMIT_MPS),
    )
    return Drive(read, count, HZ, advice=advice), way


def approach(speeds: Sequence[float], left_m: float) -> tuple[list[float], list[float]]:
    """Speeds, and distances to a line that is passed with the last of them."""
    left = left_m - np.cumsum(speeds) / HZ
    assert left[-2] >= 0.0 > left[-1]
    return list(speeds), left.tolist()


def test_compliance_and_costs_are_those_of_the_drive() -> None:
    slow = approach([10.0] * 10 + [5.0] * 90, 54.9)  # advised from the beginning, followed after a second
    rush = approach([10.0] * 40 + [0.0] * 50 + [10.0] * 20, 59.5)  # advised, not followed: it stands for 5 s
    free = approach([10.0] * 50, 49.5)  # nothing was advised
    speeds, distance = (slow[k] + rush[k] + free[k] for k in (0, 1))
    advice = (AdviceAt(1, 1, 4.8, 5.2), AdviceAt(101, 1, 4.0, 6.0), AdviceAt(211, 0, 0.0, 0.0))
    found = advice_metrics(*driven(speeds, distance, advice))
    assert found is not None
    assert (found["lights"], found["advised"]) == (3, 2)
    ripe = 100 - 15 + 110 - 15
    assert found["compliance"] == pytest.approx(85 / ripe)
    kept, others = found["followed"], found["not_followed"]
    assert (kept["lights"], kept["stops"], kept["waiting_s"], kept["energy_jpkg"]) == (1, 0.0, 0.0, 0.0)
    assert kept["time_loss_s"] == pytest.approx(4.5, abs=0.1)
    assert (others["lights"], others["stops"]) == (2, 0.5)
    assert others["waiting_s"] == pytest.approx(2.5)
    assert others["time_loss_s"] == pytest.approx(2.5)
    assert others["energy_jpkg"] == pytest.approx(0.5 * 50.0)


def test_where_nobody_was_advised_or_no_light_was_passed_there_is_nothing_to_tell() -> None:
    speeds, distance = approach([10.0] * 50, 49.5)
    assert advice_metrics(*driven(speeds, distance, ())) is None
    assert advice_metrics(*driven(speeds, [50.0] * 50, (AdviceAt(1, 1, 5.0, 9.0),))) is None
