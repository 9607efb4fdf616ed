import math

import pytest

from simconsole.profiles.traffic import Act, Actor, Vertex
from simconsole.session.scripted.actor_motion import BRAKED_MPS2, MovingActor, straight
from simconsole.values.platform import Pose

PERIOD_S = 0.04


def actor(**keys: object) -> MovingActor:
    profile = Actor(**{"name": "a", "x_m": 10.0, "y_m": 2.0, **keys})  # type: ignore[arg-type]  # values of any kind
    return MovingActor(1, profile, straight(Pose(10.0, 2.0, 0.0)), 0.0)


def step(moving: MovingActor, seconds: float) -> None:
    for _ in range(round(seconds / PERIOD_S)):
        moving.step(PERIOD_S)


def test_it_goes_on_as_it_began() -> None:
    moving = actor(speed_kmh=36)
    step(moving, 2.0)
    assert moving.pose == pytest.approx((30.0, 2.0, 0.0))
    assert moving.distance_m == pytest.approx(20.0)


def test_it_brakes_by_acceleration_or_by_time() -> None:
    moving = actor(speed_kmh=36)
    moving.begin(Act(at_s=0.0, speed_kmh=0.0, accel_mps2=5.0))
    step(moving, 1.0)
    assert moving.speed_mps == pytest.approx(5.0)
    step(moving, 3.0)
    assert moving.pose.x_m == pytest.approx(10.0 + 10.0, abs=1e-9)  # v^2 / 2a
    moving.begin(Act(at_s=0.0, speed_kmh=36.0, over_s=2.0))
    step(moving, 1.0)
    assert moving.speed_mps == pytest.approx(5.0)


def test_it_changes_lanes_smoothly_and_turns_into_its_way() -> None:
    moving = actor(speed_kmh=36)
    moving.begin(Act(at_s=0.0, lateral_m=3.5, over_s=4.0))
    step(moving, 2.0)
    assert moving.pose.y_m == pytest.approx(2.0 + 1.75)
    assert moving.pose.yaw_rad == pytest.approx(math.atan2(1.5 * 3.5 / 4.0, 10.0))
    step(moving, 2.0)
    assert moving.pose == pytest.approx((50.0, 5.5, 0.0))
    moving.begin(Act(at_s=0.0, lateral_m=-1.0, relative=True, over_s=1.0))
    step(moving, 1.0)
    assert moving.pose.y_m == pytest.approx(4.5)


def test_a_trajectory_is_kept_to_the_time_and_left_straight_on() -> None:
    way = (
        Vertex(time_s=0.0, x_m=10.0, y_m=2.0),
        Vertex(time_s=1.0, x_m=20.0, y_m=2.0),
        Vertex(time_s=2.0, x_m=20.0, y_m=7.0),
    )
    moving = actor()
    moving.begin(Act(at_s=0.0, trajectory=way))
    step(moving, 0.6)
    assert moving.pose == pytest.approx((16.0, 2.0, 0.0))
    assert moving.speed_mps == pytest.approx(10.0)
    step(moving, 1.0)
    assert moving.pose == pytest.approx((20.0, 5.0, math.pi / 2))
    step(moving, 2.4)
    assert moving.pose.x_m == pytest.approx(20.0)
    assert moving.pose.y_m == pytest.approx(17.0)
    assert moving.speed_mps == pytest.approx(5.0)


def test_a_jump_to_a_trajectory_is_no_speed() -> None:
    moving = actor(speed_kmh=36)
    way = (Vertex(time_s=0.0, x_m=500.0, y_m=2.0), Vertex(time_s=1.0, x_m=503.0, y_m=6.0))
    moving.begin(Act(at_s=0.0, trajectory=way))
    moving.step(PERIOD_S)
    assert moving.pose.x_m == pytest.approx(500.12)
    assert moving.speed_mps == moving.box().speed_mps == pytest.approx(5.0)
    assert moving.distance_m == pytest.approx(0.2)


def test_who_has_collided_only_comes_to_rest() -> None:
    moving = actor(speed_kmh=36)
    moving.crash(-2.0)
    assert moving.speed_mps == pytest.approx(8.0)
    moving.begin(Act(at_s=0.0, speed_kmh=100.0))
    step(moving, 1.0)
    assert moving.speed_mps == pytest.approx(8.0 - BRAKED_MPS2)
    person = actor(kind="pedestrian", speed_kmh=5)
    person.crash(9.0)
    step(person, 1.0)
    assert person.pose.x_m == 10.0


def test_everybody_sees_its_size_and_kind() -> None:
    user = actor(kind="van", length_m=6.0).road_user()
    assert (user.kind, user.length_m, user.width_m, user.height_m) == (2.0, 6.0, 2.0, 2.2)
