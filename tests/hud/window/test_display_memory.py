import numpy as np
import pytest

from simconsole.hud.view import HudSettings
from simconsole.hud.window.display_memory import DisplayMemory, Freshness
from simconsole.values.state_vector import PLATFORM_AT, Snapshot


def snapshot(tick: int) -> Snapshot:
    return Snapshot(tick, 250, np.zeros(PLATFORM_AT))


def test_age_runs_from_the_last_change_of_the_tick() -> None:
    freshness = Freshness()
    assert [freshness.age_s(tick, now) for tick, now in ((1, 10.0), (1, 10.4), (2, 10.5), (2, 11.5))] == [
        0.0, 0.40000000000000036, 0.0, 1.0,
    ]  # fmt: skip


def test_nothing_is_shown_as_stale_before_the_first_tick_and_after_half_a_second_of_silence() -> None:
    memory = DisplayMemory(HudSettings())
    assert memory.content(None, 1.0, None, None).stale
    assert not memory.content(snapshot(1), 1.1, None, None).stale
    assert not memory.content(snapshot(1), 1.5, None, None).stale
    assert memory.content(snapshot(1), 1.7, None, None).stale
    assert not memory.content(snapshot(2), 1.8, None, None).stale


def test_bus_and_link_are_shown_as_told() -> None:
    shown = DisplayMemory(HudSettings()).content(snapshot(1), 0.0, True, "down")
    assert (shown.can_up, shown.link) == (True, "down")


def test_a_frozen_tick_ages_and_a_new_one_is_fresh() -> None:
    freshness = Freshness()
    assert freshness.age_s(7, 100.0) == 0.0
    assert freshness.age_s(7, 100.6) == pytest.approx(0.6)
    assert freshness.age_s(8, 100.7) == 0.0
    assert freshness.age_s(3, 100.8) == 0.0  # a drive that starts anew
