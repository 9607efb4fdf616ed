"""What is ahead: as the state vector tells it, and nothing where it tells nothing."""

import math
from types import SimpleNamespace
from typing import Any

import pytest

from simconsole.drivers.simulated_person.situation import NOTHING_AHEAD, Light, ahead_in, with_display
from simconsole.world.rules.speed_advice import NO_ADVICE, STOP, Advice, Advised

FAR = 1e9
T_S = 12.004


def told(**situation: float) -> Any:
    empty = {"lead_gap_m": FAR, "lead_speed_mps": 0.0, "signal_state": 0.0, "signal_distance_m": FAR, "yield_m": FAR}
    return SimpleNamespace(situation=SimpleNamespace(**{**empty, **situation}), t_s=T_S)


def test_an_empty_road_has_nobody_and_no_line() -> None:
    assert ahead_in(told()) == NOTHING_AHEAD
    assert (NOTHING_AHEAD.lead_gap_m, NOTHING_AHEAD.line_m, NOTHING_AHEAD.yield_m) == (math.inf,) * 3


@pytest.mark.parametrize(
    ("state", "light"), [(3.0, Light.RED), (4.0, Light.RED), (7.0, Light.AMBER), (6.0, Light.GREEN), (9.0, Light.NONE)]
)
def test_lights_are_told_by_their_standard_numbers(state: float, light: Light) -> None:
    seen = ahead_in(told(signal_state=state, signal_distance_m=30.0, lead_gap_m=12.0, lead_speed_mps=5.0))
    assert seen == NOTHING_AHEAD._replace(light=float(light), line_m=30.0, lead_gap_m=12.0, lead_speed_mps=5.0)


def test_a_line_that_is_behind_is_no_line() -> None:
    assert ahead_in(told(signal_state=3.0, signal_distance_m=-4.0)) == NOTHING_AHEAD


def test_of_a_band_on_the_display_its_middle_is_seen_and_nothing_of_what_is_no_speed() -> None:
    asked = list[int]()

    def seen(advice: Advice) -> float:
        def newest(now_ns: int) -> Advice:
            asked.append(now_ns)
            return advice

        found = with_display(newest)(told(lead_gap_m=12.0))
        assert found._replace(advised_mps=math.inf) == ahead_in(told(lead_gap_m=12.0))
        return found.advised_mps

    assert seen(Advice(Advised.SPEED, 8.0, 11.0, 10.5)) == 9.5
    assert seen(STOP) == seen(NO_ADVICE) == math.inf
    assert set(asked) == {12_004_000_000}
