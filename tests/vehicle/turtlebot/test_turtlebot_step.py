"""A robot's motion under commands, its odometry, and equal bits in both executions."""

import math
import random

import msgspec
import numpy as np
import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.parts.turtlebot import OdometryErrors, TurtlebotProfile
from simconsole.values.host.jit import compiled, plain
from simconsole.values.platform import NO_OBSTACLES, Obstacles, Pose
from simconsole.values.state_vector import PLATFORM_AT
from simconsole.vehicle.turtlebot.turtlebot_platform import build_turtlebot
from simconsole.vehicle.turtlebot.turtlebot_step import normal
from tests.bits import difference
from tests.samples import Sample
from tests.vehicle.driving import IDLE, LEVEL, ORIGIN, TICK_S, Drive, platform

BURGER = load("vehicles", "turtlebot3_burger", TurtlebotProfile)
ROOM = Obstacles(
    segments=((-1.0, -1.0, 1.0, -1.0), (1.0, -1.0, 1.0, 1.0), (1.0, 1.0, -1.0, 1.0), (-1.0, 1.0, -1.0, -1.0)),
    circles=((0.5, 0.5, 0.1),),
)


def burger(errors: OdometryErrors | None = None, pose: Pose = ORIGIN, obstacles: Obstacles = NO_OBSTACLES) -> Drive:
    profile = BURGER if errors is None else msgspec.structs.replace(BURGER, odometry=errors)
    return Drive(build_turtlebot(profile, pose, LEVEL, obstacles), compiled)


def test_it_follows_speed_and_yaw_rate_on_a_circle() -> None:
    drive = burger()
    seen = drive.hold(1.0, target_speed_mps=0.1, target_yaw_rate_radps=0.5)
    assert (seen.vx_mps, seen.yaw_rate_radps) == pytest.approx((0.1, 0.5), abs=1e-3)
    seen = drive.hold(4.0 * math.pi, target_speed_mps=0.1, target_yaw_rate_radps=0.5)
    again = drive.hold(4.0 * math.pi, target_speed_mps=0.1, target_yaw_rate_radps=0.5)
    assert (again.x_m, again.y_m) == pytest.approx((seen.x_m, seen.y_m), abs=2e-3), "once round in 4 pi seconds"
    assert again.ay_mps2 == pytest.approx(0.05, abs=2e-3)


def test_it_turns_in_place() -> None:
    drive = burger(pose=Pose(1.0, 2.0, 0.0))
    seen = drive.hold(2.0, target_yaw_rate_radps=1.0)
    assert (seen.x_m, seen.y_m) == pytest.approx((1.0, 2.0), abs=1e-9)
    assert seen.yaw_rad == pytest.approx(2.0, abs=0.1)
    assert drive.hold(1.0).yaw_rate_radps == 0.0


@pytest.mark.parametrize("name", ["turtlebot3_burger", "turtlebot3_waffle"])
def test_limits_are_those_of_the_real_one(name: str) -> None:
    profile = load("vehicles", name, TurtlebotProfile)
    drive = Drive(platform(name))
    fastest = min(profile.max_speed_mps, profile.max_wheel_radps * profile.wheel_radius_m)
    seen = drive.hold(0.1, target_speed_mps=5.0)
    assert seen.vx_mps == pytest.approx(0.1 * profile.max_accel_mps2)
    assert drive.hold(1.0, target_speed_mps=5.0).vx_mps == pytest.approx(fastest)
    assert drive.hold(2.0, target_speed_mps=-5.0).vx_mps == pytest.approx(-fastest)
    turning = drive.hold(3.0, target_yaw_rate_radps=9.0).yaw_rate_radps
    wheels = 2.0 * profile.max_wheel_radps * profile.wheel_radius_m / profile.wheel_separation_m
    assert turning == pytest.approx(min(profile.max_yaw_rate_radps, wheels))


def test_the_brake_stops_it_whatever_is_commanded_and_a_person_drives_it_by_pedal_and_wheel() -> None:
    drive = burger()
    drive.hold(1.0, target_speed_mps=0.2)
    seen = drive.hold(0.5, target_speed_mps=0.2, target_yaw_rate_radps=1.0, brake=1.0)
    assert (seen.vx_mps, seen.yaw_rate_radps) == (0.0, 0.0)
    seen = drive.hold(1.0, throttle=0.5, road_wheel_rad=math.radians(10.0))
    assert seen.vx_mps == pytest.approx(0.11)
    assert seen.yaw_rate_radps == pytest.approx(0.71)
    assert drive.hold(1.0, throttle=0.5, gear=-1.0).vx_mps == pytest.approx(-0.11)


def test_a_wall_stops_it_or_lets_it_slide_and_its_wheels_go_on() -> None:
    drive = burger(pose=Pose(0.0, 0.0, 0.0), obstacles=ROOM)
    seen = drive.hold(8.0, target_speed_mps=0.2)
    assert seen.x_m == pytest.approx(1.0 - BURGER.body_radius_m - BURGER.body_x_m, abs=1e-6)
    assert abs(seen.vx_mps) < 1e-9
    assert (drive.state.motion.bumper, drive.state.motion.collisions) == (1.0, 1.0)
    assert drive.state.odometry.x_m > seen.x_m + 0.3
    slant = burger(pose=Pose(-0.5, -0.5, math.radians(-30.0)), obstacles=ROOM)
    seen = slant.hold(6.0, target_speed_mps=0.2)
    assert seen.y_m > -1.0
    assert slant.state.motion.vx_map_mps == pytest.approx(0.2 * math.cos(math.radians(30.0)), abs=1e-3), "it slides"
    back = slant.hold(0.3, target_speed_mps=-0.2)
    assert back.y_m > seen.y_m
    assert slant.state.motion.bumper == 0.0
    rear = burger(obstacles=ROOM)
    rear.hold(8.0, target_speed_mps=-0.2)
    assert rear.state.motion.bumper == 2.0


def test_a_body_is_never_inside_of_anything(sample: Sample) -> None:
    rng, drive = random.Random(sample.seed), burger(obstacles=ROOM)
    for _ in range(sample.of(40, 2000)):
        drive.hold(0.5, target_speed_mps=rng.uniform(-0.3, 0.3), target_yaw_rate_radps=rng.uniform(-3.0, 3.0))
        motion = drive.state.motion
        x = motion.x_m + BURGER.body_x_m * math.cos(motion.yaw_rad)
        y = motion.y_m + BURGER.body_x_m * math.sin(motion.yaw_rad)
        free = min(1.0 - abs(x), 1.0 - abs(y), math.hypot(x - 0.5, y - 0.5) - 0.1)
        assert free > BURGER.body_radius_m - 1e-4, (x, y)


def test_exact_odometry_is_the_truth_and_encoders_count_the_way() -> None:
    drive = burger(pose=Pose(3.0, -1.0, 0.7))
    for turn in (0.5, -0.8, 0.0):
        seen = drive.hold(3.0, target_speed_mps=0.15, target_yaw_rate_radps=turn)
    told = drive.state.odometry
    c, d = math.cos(0.7), math.sin(0.7)
    in_map = (3.0 + c * told.x_m - d * told.y_m, -1.0 + d * told.x_m + c * told.y_m)
    assert in_map == pytest.approx((seen.x_m, seen.y_m), abs=1e-4)
    assert math.remainder(told.yaw_rad + 0.7 - seen.yaw_rad, math.tau) == pytest.approx(0.0, abs=1e-9)
    turned = 0.5 * (drive.state.gauges.left_rad + drive.state.gauges.right_rad) * BURGER.wheel_radius_m
    assert turned == pytest.approx(seen.distance_m, rel=1e-6)


def test_odometry_errs_as_it_is_told_to() -> None:
    drive = burger(OdometryErrors(distance_scale=1.02, turn_scale=1.03))
    seen = drive.hold(5.0, target_speed_mps=0.2)
    assert drive.state.odometry.x_m == pytest.approx(1.02 * seen.x_m)
    before = drive.state.odometry.yaw_rad
    seen = drive.hold(2.0, target_yaw_rate_radps=1.0)
    assert drive.state.odometry.yaw_rad - before == pytest.approx(1.03 * seen.yaw_rad)


def test_slip_grows_with_the_root_of_the_way_and_hangs_on_its_seed() -> None:
    def ends(seconds: float, seed: int) -> float:
        drive = burger(OdometryErrors(slip_m_per_root_m=0.01, seed=seed))
        seen = drive.hold(seconds, target_speed_mps=0.2)
        return float(drive.state.gauges.left_rad * BURGER.wheel_radius_m - seen.x_m)

    assert ends(2.0, 5) == ends(2.0, 5)
    near, far = (np.array([ends(seconds, seed) for seed in range(30)]) for seconds in (1.1, 4.1))
    assert near.std() == pytest.approx(0.01 * math.sqrt(0.2), rel=0.4)
    assert far.std() == pytest.approx(0.01 * math.sqrt(0.8), rel=0.4)
    assert abs(far.mean()) < 0.005


def test_drawn_numbers_are_of_mean_0_and_deviation_1() -> None:
    seed, values = 1.0, []
    for _ in range(20_000):
        drawn = normal(seed)
        seed = drawn.seed
        assert 1.0 <= seed < 2147483647.0
        assert seed == int(seed)
        values.append(drawn.value)
    assert (np.mean(values), np.std(values)) == pytest.approx((0.0, 1.0), abs=0.03)
    exact, seed = 1, 1.0
    for _ in range(50):
        seed = normal(seed).seed
        for _ in range(4):
            exact = exact * 16807 % 2147483647
        assert seed == exact


def test_a_turn_of_the_lidar_is_kept_with_both_its_ends() -> None:
    drive = burger()
    drive.hold(0.2)
    assert drive.state.gauges.scans == 1.0
    drive.hold(0.2, target_speed_mps=0.2)
    state = drive.state
    assert (state.gauges.scans, state.gauges.scan_ms) == (2.0, 0.0)
    assert state.scan_from.x_m == 0.0
    assert state.scan_to.x_m == drive.seen.x_m
    assert state.scan_to.vx_map_mps == pytest.approx(drive.seen.vx_mps)
    drive.hold(TICK_S)
    assert drive.state.scan_to == state.scan_to


def test_the_battery_empties_faster_when_it_drives() -> None:
    still, driving = burger(), burger()
    still.hold(2.0)
    driving.hold(2.0, target_speed_mps=0.2)
    assert still.state.gauges.used_j == pytest.approx(2.0 * BURGER.battery.idle_w)
    assert driving.state.gauges.used_j > still.state.gauges.used_j + 2.0


def test_both_executions_have_equal_bits_and_stay_finite(sample: Sample) -> None:
    rng = random.Random(sample.seed)
    errors = OdometryErrors(distance_scale=1.02, turn_scale=0.97, slip_m_per_root_m=0.02)
    vehicle = build_turtlebot(msgspec.structs.replace(BURGER, odometry=errors), ORIGIN, LEVEL, ROOM)
    slow, fast = Drive(vehicle, plain), Drive(vehicle, compiled)
    command = IDLE
    for tick in range(sample.of(500, 50_000)):
        if tick % 50 == 0:
            command = IDLE._replace(
                throttle=rng.choice([0.0, rng.random(), math.nan]),
                brake=rng.choice([0.0, 0.0, rng.random(), math.nan]),
                road_wheel_rad=rng.choice([rng.uniform(-1.0, 1.0), math.nan]),
                gear=rng.choice([-1.0, 1.0]),
                target_speed_mps=rng.choice([rng.uniform(-1.0, 1.0), math.inf]),
                target_yaw_rate_radps=rng.choice([rng.uniform(-9.0, 9.0), math.nan]),
            )
        slow.tick(command)
        fast.tick(command)
        assert not difference(slow.row, fast.row), tick
        assert np.isfinite([*slow.seen, *slow.row[PLATFORM_AT:]]).all()
