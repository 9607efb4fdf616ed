"""Behind others and up to lines: gaps that are kept, lights that are obeyed, who decides at amber."""

import math

import pytest

from simconsole.drivers.car_following import following_mps2
from simconsole.drivers.simulated_person.following import HARDEST_MPS2, Obedience, following, stopping_mps2
from simconsole.drivers.simulated_person.situation import NOTHING_AHEAD, Light, Situation
from simconsole.profiles.person import RoadHabits

ROAD = RoadHabits()
STEP_S = 0.05


def test_an_empty_road_allows_everything() -> None:
    assert following_mps2(math.inf, 0.0, 20.0, following(ROAD)) == ROAD.accelerate_mps2
    assert stopping_mps2(math.inf, 20.0, ROAD) == ROAD.accelerate_mps2


@pytest.mark.parametrize("lead_mps", [5.0, 15.0])
@pytest.mark.parametrize("speed_mps", [0.0, 20.0])
def test_behind_a_vehicle_the_gap_becomes_that_of_the_headway(lead_mps: float, speed_mps: float) -> None:
    gap_m, least_m = 60.0, math.inf
    for _ in range(4000):
        accel = following_mps2(gap_m, lead_mps, speed_mps, following(ROAD))
        speed_mps = max(0.0, speed_mps + accel * STEP_S)
        gap_m += (lead_mps - speed_mps) * STEP_S
        least_m = min(least_m, gap_m)
    assert speed_mps == pytest.approx(lead_mps, abs=0.01)
    assert gap_m == pytest.approx(ROAD.gap_m + lead_mps * ROAD.headway_s, abs=0.5)
    assert least_m > ROAD.gap_m


@pytest.mark.parametrize("speed_mps", [3.0, 13.0, 30.0])
@pytest.mark.parametrize("spare", [1.1, 2.0])
def test_a_line_is_stopped_before_and_neither_far_nor_beyond(speed_mps: float, spare: float) -> None:
    line_m = ROAD.gap_m + spare * speed_mps**2 / (2.0 * ROAD.brake_mps2)
    hardest = 0.0
    for _ in range(4000):
        accel = stopping_mps2(line_m, speed_mps, ROAD)
        hardest = min(hardest, accel)
        speed_mps = max(0.0, speed_mps + accel * STEP_S)
        line_m -= speed_mps * STEP_S
    assert speed_mps < 0.01
    assert 0.5 < line_m < ROAD.gap_m + 1.0
    assert hardest > -2.0 * ROAD.brake_mps2


def test_too_near_is_braked_for_with_all_there_is() -> None:
    assert stopping_mps2(1.0, 10.0, ROAD) == -HARDEST_MPS2
    assert following_mps2(0.0, 0.0, 20.0, following(ROAD)) == -HARDEST_MPS2


def signal(light: Light, line_m: float) -> Situation:
    return NOTHING_AHEAD._replace(light=float(light), line_m=line_m)


def test_red_is_stopped_at_and_green_is_not() -> None:
    assert Obedience().must_stop(signal(Light.RED, 20.0), 10.0)
    assert not Obedience().must_stop(signal(Light.GREEN, 20.0), 10.0)
    assert not Obedience().must_stop(NOTHING_AHEAD, 10.0)


def test_at_amber_who_can_stop_gently_does_and_who_cannot_stays_with_it() -> None:
    assert Obedience().must_stop(signal(Light.AMBER, 40.0), 14.0)
    passing = Obedience()
    assert not passing.must_stop(signal(Light.AMBER, 15.0), 14.0)
    assert not passing.must_stop(signal(Light.AMBER, 2.0), 2.0), "decided once"
    assert not passing.must_stop(signal(Light.GREEN, 80.0), 14.0)
    assert passing.must_stop(signal(Light.AMBER, 40.0), 14.0), "the next signal is another decision"
