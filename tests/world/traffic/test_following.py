import math

import pytest

from simconsole.world.traffic.following import (
    ACCELERATION_MPS2,
    BRAKING_MPS2,
    EMERGENCY_MPS2,
    FAR_M,
    STANDING_GAP_M,
    acceleration,
    clearing_s,
)


def test_free_road_from_standstill_and_at_the_desired_speed() -> None:
    assert acceleration(0.0, 14.0, FAR_M, 0.0, 1.0) == ACCELERATION_MPS2
    assert acceleration(14.0, 14.0, FAR_M, 0.0, 1.0) == 0.0


def test_the_published_equation() -> None:
    v, v0, s, leader, t = 12.0, 15.0, 20.0, 9.0, 1.2
    wanted = STANDING_GAP_M + v * t + v * (v - leader) / (2.0 * math.sqrt(ACCELERATION_MPS2 * BRAKING_MPS2))
    expected = ACCELERATION_MPS2 * (1.0 - (v / v0) ** 4 - (wanted / s) ** 2)
    assert acceleration(v, v0, s, leader, t) == pytest.approx(expected)


def test_nobody_brakes_harder_than_in_an_emergency() -> None:
    assert acceleration(30.0, 15.0, 1.0, 0.0, 1.0) == -EMERGENCY_MPS2
    assert acceleration(30.0, 15.0, -3.0, 0.0, 1.0) == -EMERGENCY_MPS2


def test_a_follower_settles_at_its_time_gap_without_ever_touching_its_leader() -> None:
    gap, speed, leader = 60.0, 20.0, 8.0
    least = gap
    for _ in range(3000):
        a = acceleration(speed, 20.0, gap, leader, 1.0)
        speed = max(0.0, speed + 0.04 * a)
        gap += 0.04 * (leader - speed)
        least = min(least, gap)
    assert least > STANDING_GAP_M
    equilibrium = (STANDING_GAP_M + leader * 1.0) / math.sqrt(1.0 - (leader / 20.0) ** 4)
    assert (gap, speed) == pytest.approx((equilibrium, leader), rel=1e-2)


def test_clearing_a_way_takes_as_long_as_driving_it() -> None:
    seconds = clearing_s(5.0, 30.0)
    assert 5.0 * seconds + 0.5 * ACCELERATION_MPS2 * seconds**2 == pytest.approx(30.0)
