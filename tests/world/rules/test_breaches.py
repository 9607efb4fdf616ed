"""Broken rules: told once they have lasted, over once they have been over for a while."""

import pytest

from simconsole.values.signals import FAR, NO_RULES_BROKEN, NO_SITUATION, Rules, SignalState, Situation
from simconsole.world.rules.breaches import (
    JUNCTION_M,
    OFF_ROAD_S,
    SHOWN_S,
    SPEEDING_MPS,
    SPEEDING_S,
    WRONG_WAY_S,
    Breach,
    Place,
    failed_to_yield,
    held,
    judged,
    passed_red,
)

TICK_S = 0.004
LIMIT_MPS = 10.0
HERE = NO_SITUATION._replace(lane=3.0, speed_limit_mps=LIMIT_MPS)
DRIVING = Place(outside_m=-1.5, along=1.0, in_junction=0.0, speed_mps=8.0)


class Judge:
    """Judges tick after tick in one place."""

    def __init__(self) -> None:
        self.rules = NO_RULES_BROKEN
        self.was = HERE

    def after(self, s: float, place: Place = DRIVING, now: Situation = HERE, touched: float = 0.0) -> Rules:
        for _ in range(round(s / TICK_S)):
            self.rules = judged(self.rules, self.was, now, place, touched, TICK_S)
            self.was = now
        return self.rules


def before_line(distance_m: float, state: SignalState) -> Situation:
    return HERE._replace(signal_distance_m=distance_m, signal_state=float(state))


def test_who_obeys_breaks_nothing() -> None:
    assert Judge().after(5.0) == NO_RULES_BROKEN


def test_speed_that_wavers_about_the_limit_is_one_breach() -> None:
    judge, begun = Judge(), 0
    for _ in range(40):
        for speed in (LIMIT_MPS + SPEEDING_MPS + 0.1, LIMIT_MPS + 0.1):
            before = judge.rules.speeding
            begun += judge.after(0.6, DRIVING._replace(speed_mps=speed)).speeding > before
    assert begun == 1
    assert judge.after(SPEEDING_S - 0.01).speeding == 1.0
    assert judge.after(0.02).speeding == 0.0


def test_short_speeding_and_speed_within_the_tolerance_are_none() -> None:
    judge = Judge()
    assert judge.after(SPEEDING_S - 0.01, DRIVING._replace(speed_mps=20.0)).speeding == 0.0
    assert judge.after(10.0, DRIVING._replace(speed_mps=LIMIT_MPS + SPEEDING_MPS - 0.1)).speeding == 0.0
    assert judge.after(SPEEDING_S + 0.01, DRIVING._replace(speed_mps=-20.0)).speeding == 1.0  # backwards, too


@pytest.mark.parametrize("state", list(SignalState))
def test_a_stop_line_passed_at_red_is_an_event_that_is_shown_for_a_while(state: SignalState) -> None:
    judge = Judge()
    judge.after(0.1, now=before_line(0.01, state))
    red = state in (SignalState.STOP_AND_REMAIN, SignalState.PRE_MOVEMENT)
    assert judge.after(TICK_S, now=before_line(-0.01, state)).red_light == float(red)
    assert judge.after(SHOWN_S - 0.1, now=before_line(-3.0, state)).red_light == float(red)
    assert judge.after(0.2).red_light == 0.0


def test_red_behind_the_line_or_of_another_lane_is_no_event() -> None:
    red = SignalState.STOP_AND_REMAIN
    assert not passed_red(before_line(-0.1, red), before_line(-0.2, red))
    assert not passed_red(before_line(0.1, red), before_line(-0.2, red)._replace(lane=4.0))
    assert not passed_red(before_line(0.2, red), before_line(0.1, red))


def test_wrong_way_is_against_the_lane_and_not_inside_a_junction() -> None:
    against = DRIVING._replace(along=-0.9)
    assert Judge().after(WRONG_WAY_S + 0.01, against).wrong_way == 1.0
    assert Judge().after(WRONG_WAY_S - 0.01, against).wrong_way == 0.0
    assert Judge().after(5.0, against._replace(in_junction=1.0)).wrong_way == 0.0
    assert Judge().after(5.0, against._replace(speed_mps=-5.0)).wrong_way == 0.0  # reverses where it came from


def test_off_the_road_is_the_whole_car_and_junctions_are_wide() -> None:
    outside = DRIVING._replace(outside_m=1.3)
    judge = Judge()
    assert judge.after(OFF_ROAD_S + 0.01, outside).off_road == 1.0
    assert judge.after(3.0, outside._replace(outside_m=0.8)).off_road == 1.0  # not back yet
    assert judge.after(OFF_ROAD_S + 0.01).off_road == 0.0
    assert Judge().after(3.0, outside._replace(in_junction=1.0)).off_road == 0.0
    assert Judge().after(3.0, outside._replace(outside_m=1.3 + JUNCTION_M, in_junction=1.0)).off_road == 1.0


def test_patience_counts_the_opposite_only() -> None:
    assert held(0.0, 0.0, True, False, 0.4, 0.1) == Breach(0.0, 0.1)
    assert held(0.0, 0.35, True, False, 0.4, 0.1) == Breach(1.0, 0.0)
    assert held(0.0, 0.35, False, True, 0.4, 0.1) == Breach(0.0, 0.0)
    assert held(1.0, 0.35, True, False, 0.4, 0.1) == Breach(1.0, 0.0)


@pytest.mark.parametrize(
    ("was_m", "now_m", "now_s", "fails"),
    [
        (0.5, -0.1, 0.0, True),
        (0.5, -0.1, 1.9, True),
        (0.5, -0.1, 4.0, False),  # whoever comes is far enough away
        (FAR, -0.1, 0.0, False),  # the duty came when the line was passed already
        (-0.1, -0.6, 0.0, False),
        (0.5, 0.1, 0.0, False),
    ],
)
def test_who_drives_on_before_somebody_who_goes_first_fails_to_yield(
    was_m: float, now_m: float, now_s: float, fails: bool
) -> None:
    was, now = HERE._replace(yield_m=was_m, yield_s=now_s), HERE._replace(yield_m=now_m, yield_s=now_s)
    assert failed_to_yield(was, now) == fails
    judge = Judge()
    judge.was = was
    assert judge.after(TICK_S, now=now).failing_to_yield == float(fails)
    assert judge.after(SHOWN_S + 0.1).failing_to_yield == 0.0
