"""Others are heard from where they are."""

import math

import numpy as np
import pytest

from simconsole.hud.sound.directions import BACK_LEFT, FRONT_LEFT, FRONT_RIGHT, Samples
from simconsole.hud.sound.heard import OtherHeard
from simconsole.hud.sound.passing import FARTHEST_M, NEAREST, Passing, audible
from simconsole.world.traffic.road_users import RoadUser, RoadUserKind
from tests.hud.test_view import snapshot

BLOCK = 1024


def other(id_: float, x_m: float, y_m: float, kind: RoadUserKind = RoadUserKind.CAR, **more: float) -> RoadUser:
    user = RoadUser(
        id=id_, kind=kind, x_m=x_m, y_m=y_m, yaw_rad=0.0, speed_mps=10.0, length_m=4.4, width_m=1.8, height_m=1.5
    )
    return user._replace(**more)


def levels(others: tuple[OtherHeard, ...]) -> Samples:
    passing = Passing()
    found = []
    for _ in range(60):
        block = np.zeros((BLOCK, 6), np.float32)
        passing.add(block, others)
        found.append(block)
    return np.asarray(np.sqrt(np.square(np.concatenate(found[1:])).mean(axis=0)), np.float32)


def test_bearing_distance_and_closing_speed_are_the_listeners() -> None:
    here = snapshot(vehicle__x_m=100.0, vehicle__y_m=50.0, vehicle__yaw_rad=math.pi / 2.0, vehicle__vx_mps=5.0)
    (ahead,) = audible(here, [other(1.0, 100.0, 71.0, yaw_rad=-math.pi / 2.0)], 1.0)
    assert ahead.bearing_rad == pytest.approx(0.0, abs=1e-9)
    assert ahead.distance_m == pytest.approx(20.0)
    assert ahead.closing_mps == pytest.approx(15.0)
    (left,) = audible(here, [other(1.0, 90.0, 51.0)], 1.0)
    assert left.bearing_rad == pytest.approx(math.pi / 2.0)


def test_only_the_nearest_vehicles_are_heard_and_nobody_on_foot() -> None:
    crowd = [other(number, 10.0 + number, 0.0) for number in range(20)]
    crowd += [other(50.0, 1.0, 0.0, RoadUserKind.PEDESTRIAN), other(51.0, FARTHEST_M + 1.0, 0.0)]
    assert [heard.id for heard in audible(snapshot(), crowd[::-1], 0.0)] == list(range(NEAREST))
    assert audible(snapshot(), crowd[-1:], 0.0) == ()


def test_loudness_follows_direction_and_distance() -> None:
    left = OtherHeard(id=1.0, bearing_rad=math.radians(60.0), distance_m=10.0, speed_mps=14.0, closing_mps=0.0)
    found = levels((left,))
    assert found[FRONT_LEFT] > 0.0 < found[BACK_LEFT]
    assert found[FRONT_RIGHT] == 0.0
    assert levels((left._replace(bearing_rad=-left.bearing_rad),))[FRONT_RIGHT] == pytest.approx(found[FRONT_LEFT])
    assert levels((left._replace(distance_m=20.0),)) == pytest.approx(0.5 * found, rel=1e-3)
    assert not levels((left._replace(speed_mps=0.0),)).any()


def test_who_is_gone_fades_and_leaves_nothing() -> None:
    passing = Passing()
    near = OtherHeard(id=1.0, bearing_rad=0.0, distance_m=5.0, speed_mps=14.0, closing_mps=0.0)
    blocks = [np.zeros((BLOCK, 6), np.float32) for _ in range(4)]
    for block, others in zip(blocks, ((near,), (near,), (), ()), strict=True):
        passing.add(block, others)
    assert blocks[2].any()
    assert np.abs(blocks[2][-1]).max() < 1e-3
    assert not blocks[3].any()


def test_who_comes_nearer_sounds_higher() -> None:
    def brightness(closing_mps: float) -> float:
        passing = Passing()
        near = OtherHeard(id=1.0, bearing_rad=0.0, distance_m=5.0, speed_mps=14.0, closing_mps=closing_mps)
        block = np.zeros((96_000, 6), np.float32)
        passing.add(block, (near,))
        power = np.square(np.abs(np.fft.rfft(block[:, 2])))
        return float((power * np.arange(len(power))).sum() / power.sum())

    assert brightness(30.0) / brightness(-30.0) == pytest.approx((343.0 + 30.0) / (343.0 - 30.0), rel=0.05)
