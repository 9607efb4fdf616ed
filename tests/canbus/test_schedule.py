import random

import pytest

from simconsole.canbus.schedule import Phase, Schedule


def ticks_of(period_ms: int, tick_hz: int, ticks: int) -> list[int]:
    schedule = Schedule([period_ms], tick_hz)
    return [tick for tick in range(ticks) if schedule.due(tick)]


def test_deadlines_are_absolute() -> None:
    assert ticks_of(10, 250, 13) == [0, 3, 5, 8, 10]
    assert ticks_of(20, 250, 13) == [0, 5, 10]
    assert ticks_of(100, 50, 13) == [0, 5, 10]


@pytest.mark.parametrize("tick_hz", [50, 100, 125, 200, 250, 500, 1000])
@pytest.mark.parametrize("period_ms", [10, 20, 100])
def test_rate_is_exact_over_ten_seconds(tick_hz: int, period_ms: int) -> None:
    assert len(ticks_of(period_ms, tick_hz, 10 * tick_hz)) == min(10 * tick_hz, 10_000 // period_ms)


def test_skipped_ticks_cost_their_messages_and_are_counted() -> None:
    schedule = Schedule([10, 100], 1000)
    assert schedule.due(0) == [0, 1]
    assert schedule.due(55) == [0]
    assert schedule.missed == [4, 0]
    assert schedule.due(60) == [0]
    assert schedule.missed == [4, 0]


def test_beginning_late_misses_nothing() -> None:
    schedule = Schedule([10], 1000)
    assert schedule.due(100_000) == [0]
    assert schedule.missed == [0]


def test_same_or_earlier_tick_has_nothing() -> None:
    schedule = Schedule([10], 100)
    assert schedule.due(5) == [0]
    assert schedule.due(5) == []
    assert schedule.due(4) == []


@pytest.mark.parametrize("tick_hz", [50, 125, 250, 1000])
def test_next_tick_is_the_next_that_is_due(tick_hz: int) -> None:
    schedule, ahead = Schedule([10, 20, 100], tick_hz), Schedule([10, 20, 100], tick_hz)
    due = [tick for tick in range(tick_hz) if ahead.due(tick)]
    for tick in due[:-1]:
        schedule.due(tick)
        assert schedule.next_tick() == due[due.index(tick) + 1]


def test_nothing_planned_has_no_next_tick() -> None:
    assert Schedule([], 250).next_tick() is None


def test_late_looks_do_not_add_up() -> None:
    seed = 5
    late = random.Random(seed)
    phase = Phase(250)
    assert phase.expected_s(3) == 0.0
    for tick in range(0, 5000, 5):
        phase.saw(tick, 100.0 + tick / 250 + late.uniform(0.0, 0.0003) + (0.003 if tick % 50 else 0.0))
        if tick > 500:
            error_s = phase.expected_s(tick + 5) - (100.0 + (tick + 5) / 250)
            assert 0.0 <= error_s < 0.001, f"seed {seed}"


def test_phase_follows_a_core_that_slipped() -> None:
    phase = Phase(250)
    phase.saw(0, 0.0)
    for tick in range(1, 2001):
        phase.saw(tick, tick / 250 + 0.05)
    assert phase.expected_s(2001) == pytest.approx(2001 / 250 + 0.05, abs=1e-3)
