"""Vehicles of SUMO's that leap to the side are told on their way there; others as SUMO has them."""

import math
from itertools import pairwise

import numpy as np
import pytest

from simconsole.profiles.traffic import SumoProfile, TrafficProfile
from simconsole.world.roads.road_map import Array
from simconsole.world.sumo_traffic import smooth
from simconsole.world.sumo_traffic.smooth import ASIDE_MPS, LEAP_M, LOST_M, TURN_DEGPS, followed
from simconsole.world.sumo_traffic.sumo_traffic import SumoTraffic, Surroundings
from simconsole.world.traffic.road_users import users
from tests.samples import Sample
from tests.world.nets import generated, generated_map
from tests.world.sumo_traffic.on_sumo import box

STEP_S = 0.04
LONG_M = 4.6
TWO_LANES = (
    "--grid", "--grid.number", "4", "--grid.length", "120", "--default.lanenumber", "2",
    "--default-junction-type", "traffic_light",
)  # fmt: skip


def told_of(rows: Array, length_m: float = LONG_M) -> Array:
    """What is told of one vehicle that SUMO has at these places (x, y, angle, speed), float64 [steps, 3]."""
    told = [rows[0, :3]]
    for was, now in pairwise(rows):
        told.append(followed(was[None], told[-1][None], now[None], np.array((length_m,)), STEP_S)[0])
    return np.array(told)


def east(speed_mps: float, steps: int) -> Array:
    """A vehicle that drives east (90 degrees) at a speed."""
    rows = np.zeros((steps, 4))
    rows[:, 0], rows[:, 2], rows[:, 3] = speed_mps * STEP_S * np.arange(steps), 90.0, speed_mps
    return rows


def test_a_change_of_lanes_takes_two_seconds_and_ends_where_sumo_has_it() -> None:
    rows = east(14.0, 120)
    rows[10:, 1] = 3.2
    told = told_of(rows)
    assert np.array_equal(told[:, 0], rows[:, 0])
    assert np.abs(np.diff(told[:, 1])).max() <= ASIDE_MPS * STEP_S + 1e-9
    there = int(np.flatnonzero(told[:, 1] == 3.2)[0])
    assert (there - 10) * STEP_S == pytest.approx(3.2 / ASIDE_MPS, abs=0.1)
    assert np.array_equal(told[there:], rows[there:, :3])


def test_who_stands_does_not_slide_and_who_creeps_does_so_slowly() -> None:
    rows = east(1.0, 100)
    rows[10:, 1] = 3.2
    rows[50:, 0], rows[50:, 3] = rows[50, 0], 0.0
    told = told_of(rows)
    assert (np.hypot(*np.diff(told[:, :2], axis=0).T) <= 1.3 * STEP_S).all()
    assert np.array_equal(told[51], told[-1])
    assert 0.1 < told[-1, 1] < 0.5, "it stands across both lanes"


def test_a_corner_is_turned_and_a_vehicle_that_is_put_elsewhere_is_there() -> None:
    rows = east(7.0, 60)
    rows[20:, 2] = 130.0  # through north-west, as SUMO says it
    rows[20:, 0] = rows[19, 0] + 7.0 * STEP_S * math.cos(math.radians(40.0)) * np.arange(1, 41)
    rows[20:, 1] = -7.0 * STEP_S * math.sin(math.radians(40.0)) * np.arange(1, 41)
    rows[40:, 1] += 2.0 * LOST_M
    told = told_of(rows)
    assert np.abs(np.diff(told[:40, 2])).max() <= TURN_DEGPS * STEP_S + 1e-9
    assert np.array_equal(told[40:], rows[40:, :3])


@pytest.mark.parametrize("length_m", [LONG_M, 5.4, 12.0])
@pytest.mark.parametrize("radius_m", [12.0, -12.0])
def test_who_drives_fast_round_a_bend_is_told_exactly(length_m: float, radius_m: float) -> None:
    """Both ends are on the lane, as SUMO has them: the front moves aside from where the vehicle looks."""
    at_rad = 14.0 * STEP_S / radius_m * np.arange(60)
    looks_rad = at_rad - math.asin(0.5 * length_m / radius_m)
    x, y = radius_m * np.sin(at_rad), radius_m * (1.0 - np.cos(at_rad))
    rows = np.column_stack((x, y, (90.0 - np.degrees(looks_rad)) % 360.0, np.full(60, 14.0)))
    assert np.array_equal(told_of(rows, length_m), rows[:, :3])


def test_who_does_not_leap_is_told_exactly(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    for _ in range(sample.of(20, 300)):
        steps = 100
        speeds = np.clip(8.0 + np.cumsum(rng.uniform(-0.1, 0.1, steps)), 0.0, 20.0)
        turns = np.clip(np.cumsum(rng.uniform(-0.01, 0.01, steps)), -0.3, 0.3)
        yaws = rng.uniform(-3.0, 3.0) + np.cumsum(turns * STEP_S)
        rows = np.column_stack((np.zeros(steps), np.zeros(steps), np.degrees(0.5 * math.pi - yaws) % 360.0, speeds))
        rows[:, 0], rows[:, 1] = np.cumsum(speeds * STEP_S * np.cos(yaws)), np.cumsum(speeds * STEP_S * np.sin(yaws))
        assert np.array_equal(told_of(rows), rows[:, :3])


def test_no_vehicle_of_a_city_with_two_lanes_leaps_though_sumos_do(monkeypatch: pytest.MonkeyPatch) -> None:
    beside = list[float]()

    def watched(was: Array, told: Array, now: Array, lengths_m: Array, period_s: float) -> Array:
        found = followed(was, told, now, lengths_m, period_s)
        beside.extend(np.hypot(*(found[:, :2] - now[:, :2]).T).tolist())
        return found

    monkeypatch.setattr(smooth, "followed", watched)
    profile = TrafficProfile(seed=1, sumo=SumoProfile(vehicles=100, radius_m=2000.0, warm_up_s=20.0))
    net, road_map, ego = generated(*TWO_LANES), generated_map(*TWO_LANES), box(180.0, -100.0)
    traffic = SumoTraffic(profile, Surroundings(road_map, net, (), 100, (ego,), 60.0))
    try:
        tables = [{user.id: user for user in users(traffic.step(ego))} for _ in range(500)]
    finally:
        traffic.close()
    assert sum(away_m > 2.0 for away_m in beside) > 20, "they do change lanes, at once"
    pairs = [(was[name], now[name]) for was, now in pairwise(tables) for name in was.keys() & now.keys()]
    assert len(pairs) > 30_000
    most_rad = math.radians(TURN_DEGPS) * STEP_S + 1e-9
    for was, now in pairs:
        turned = abs(math.remainder(now.yaw_rad - was.yaw_rad, math.tau))
        assert turned <= most_rad
        fastest_mps = max(was.speed_mps, now.speed_mps) + ASIDE_MPS
        swing_m = 0.5 * now.length_m * turned
        assert math.hypot(now.x_m - was.x_m, now.y_m - was.y_m) <= fastest_mps * STEP_S + LEAP_M + swing_m
        yaw, (x_m, y_m) = was.yaw_rad, (now.x_m - was.x_m, now.y_m - was.y_m)
        aside_m = abs(y_m * math.cos(yaw) - x_m * math.sin(yaw))
        assert aside_m <= ASIDE_MPS * STEP_S + LEAP_M + swing_m + turned * now.speed_mps * STEP_S
