"""The ball: rolls to the desired pose, is pushed by a person, stops; equal bits in both executions."""

import math
import random

import numpy as np
import pytest

from simconsole.values.host.jit import compiled, plain
from simconsole.values.platform import Ground, Pose
from tests.bits import difference
from tests.samples import Sample
from tests.vehicle.driving import IDLE, LEVEL, TICK_S, Drive, platform

LEVEL_POSE = Pose(0.0, 0.0, 0.0)


def ball(ground: Ground = LEVEL, pose: Pose = LEVEL_POSE) -> Drive:
    return Drive(platform("ball", ground, pose), plain)


@pytest.mark.parametrize("slope", [0.0, 0.1])
def test_rolls_to_the_desired_pose_with_at_most_the_desired_speed(slope: float) -> None:
    drive = ball(Ground(1.0, slope, 0.0), Pose(1.0, 1.0, 0.0))
    fastest = 0.0
    for _ in range(round(8.0 / TICK_S)):
        seen = drive.hold(TICK_S, target_speed_mps=1.5, target_x_m=4.0, target_y_m=-3.0)
        fastest = max(fastest, math.hypot(seen.vx_mps, seen.vy_mps))
        assert math.hypot(seen.ax_mps2, seen.ay_mps2) < 2.0 + 0.75
    assert (seen.x_m, seen.y_m) == pytest.approx((4.0, -3.0), abs=1e-4)
    assert fastest == pytest.approx(1.5, abs=0.01)
    assert seen.yaw_rad == pytest.approx(math.atan2(-4.0, 3.0), abs=0.05)
    assert seen.distance_m == pytest.approx(5.0, abs=0.05)


def test_does_not_overshoot_its_target() -> None:
    drive = ball()
    for _ in range(round(6.0 / TICK_S)):
        assert drive.hold(TICK_S, target_speed_mps=5.0, target_x_m=3.0).x_m < 3.0 + 1e-9


def test_without_a_target_it_coasts_to_rest() -> None:
    drive = ball()
    drive.hold(2.0, target_speed_mps=1.0, target_x_m=10.0)
    assert drive.seen.vx_mps == pytest.approx(1.0, abs=1e-6)
    assert drive.hold(1.0).vx_mps == pytest.approx(1.0 - 0.15, abs=1e-3)
    assert drive.hold(8.0).vx_mps == 0.0


def test_brake_stops_it_on_the_way_to_its_target_and_holds_on_a_slope() -> None:
    drive = ball(Ground(1.0, 0.1, 0.0))
    drive.hold(2.0, target_speed_mps=1.0, target_x_m=10.0)
    seen = drive.hold(1.0, target_speed_mps=1.0, target_x_m=10.0, brake=1.0)
    assert seen.vx_mps == pytest.approx(0.0, abs=1e-12)
    assert drive.hold(5.0, brake=1.0).x_m == seen.x_m


def test_a_person_pushes_turns_and_reverses_it() -> None:
    drive = ball()
    seen = drive.hold(2.0, throttle=0.5, road_wheel_rad=0.2)
    assert seen.vx_mps > 1.0
    assert seen.yaw_rad == pytest.approx(2.0 * 3.0 * 0.2, rel=0.01)
    assert abs(seen.vy_mps) < 0.05 * seen.vx_mps
    drive.hold(3.0, brake=1.0)
    assert drive.hold(1.0, throttle=0.5, gear=-1).vx_mps < -0.5


def test_rolling_angle_is_distance_over_radius() -> None:
    drive = ball()
    seen = drive.hold(3.0, throttle=0.3)
    assert drive.state.rolled_rad == pytest.approx(seen.x_m / 0.5, rel=1e-9)
    assert abs(seen.pitch_rad) <= math.pi
    assert seen.z_m == 0.5


def test_a_slope_moves_it_with_five_sevenths_of_gravity() -> None:
    drive = ball(Ground(1.0, -0.1, 0.0))
    seen = drive.hold(1.0)
    expected = 9.80665 * 0.1 / math.sqrt(1.01) * 5.0 / 7.0 - 0.15
    assert seen.vx_mps == pytest.approx(expected, rel=0.01)


def test_both_executions_have_equal_bits_and_stay_finite(sample: Sample) -> None:
    rng = random.Random(sample.seed)
    vehicle = platform("ball", Ground(0.9, 0.03, -0.05))
    slow, fast = Drive(vehicle, plain), Drive(vehicle, compiled)
    command = IDLE
    for tick in range(sample.of(5000, 100_000)):
        if tick % 50 == 0:
            command = IDLE._replace(
                throttle=rng.random(),
                brake=rng.choice([0.0, 0.0, rng.random(), math.nan]),
                road_wheel_rad=rng.choice([rng.uniform(-1.0, 1.0), math.nan]),
                gear=rng.choice([-1.0, 1.0]),
                target_speed_mps=rng.choice([0.0, rng.uniform(0.0, 5.0), math.inf]),
                target_x_m=rng.choice([rng.uniform(-9.0, 9.0), math.nan]),
                target_y_m=rng.uniform(-9.0, 9.0),
            )
        slow.tick(command)
        fast.tick(command)
        assert not difference(slow.row, fast.row), tick
        assert np.isfinite([*slow.seen, *slow.state]).all()
