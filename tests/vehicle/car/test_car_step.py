"""The car in a person's hands, and the physics that can be checked by hand."""

import math
from itertools import pairwise

import pytest

from simconsole.values.platform import Ground, Pose
from simconsole.values.units import KMH_PER_MPS, STANDARD_GRAVITY_MPS2
from simconsole.vehicle.platforms import build
from tests.vehicle.altered import HATCHBACK, altered
from tests.vehicle.driving import LEVEL, ORIGIN, TICK_S, Drive, platform


def launched(throttle: float = 0.5, release_s: float = 1.5, ground: Ground = LEVEL, gear: float = 1.0) -> Drive:
    """Return a car after a person has let the clutch out."""
    drive = Drive(platform(ground=ground))
    drive.hold(0.4, clutch=1.0, gear=gear)
    drive.hold(0.4, clutch=1.0, gear=gear, throttle=throttle)
    steps = round(release_s / 0.02)
    for index in range(steps):
        drive.hold(0.02, clutch=1.0 - index / steps, gear=gear, throttle=throttle)
    drive.hold(1.0, gear=gear, throttle=throttle)
    return drive


@pytest.mark.parametrize(("throttle", "release_s"), [(0.35, 1.5), (0.5, 1.0), (0.7, 2.0)])
def test_drives_off_with_the_clutch(throttle: float, release_s: float) -> None:
    seen = launched(throttle, release_s).seen
    print(f"throttle {throttle}, release {release_s} s: {seen.vx_mps:.2f} m/s")
    assert seen.engine_running == 1.0
    assert seen.vx_mps > 1.5


def test_clutch_dumped_at_idle_stalls_and_the_pressed_clutch_restarts() -> None:
    drive = Drive(platform())
    drive.hold(0.5, clutch=1.0, gear=1)
    seen = drive.hold(1.5, gear=1)
    assert seen.engine_running == 0.0
    assert seen.x_m < 0.6
    drive.until(lambda seen: seen.engine_running == 1.0, 2.0, gear=1, clutch=1.0)
    assert drive.hold(1.0, gear=1, clutch=1.0).engine_radps == pytest.approx(800 * math.pi / 30, rel=0.02)


def test_full_throttle_without_a_gear_stays_at_the_limiter() -> None:
    drive = Drive(platform())
    drive.hold(3.0, throttle=1.0)
    speeds = [drive.hold(TICK_S, throttle=1.0).engine_radps for _ in range(100)]
    assert max(speeds) <= 6600 * math.pi / 30
    assert max(speeds) - min(speeds) < 1.0
    assert drive.seen.x_m == 0.0


def test_reverse_goes_backwards_and_yaws_the_other_way() -> None:
    drive = launched(0.5, 1.5, gear=-1)
    seen = drive.hold(2.0, gear=-1, throttle=0.3, road_wheel_rad=0.2)
    assert seen.gear == -1.0
    assert seen.vx_mps < -2.0
    assert seen.yaw_rate_radps < -0.1
    assert seen.full_throttle_accel_mps2 < seen.coast_accel_mps2 < seen.full_brake_accel_mps2
    seen = drive.hold(12.0, gear=0, brake=0.5, clutch=1.0)
    assert abs(seen.vx_mps) < 1e-6


def test_gears_need_the_clutch_or_matching_speeds() -> None:
    drive = launched(0.6, 1.0)
    drive.hold(2.0, gear=1, throttle=0.6)
    assert drive.hold(0.2, gear=2).gear == 0.0, "no clutch, engine far too fast for second"
    assert drive.hold(0.2, gear=2, clutch=1.0).gear == 2.0
    assert drive.hold(0.5, gear=7, clutch=1.0).gear == 0.0, "six gears"
    assert drive.hold(0.5, gear=-1, clutch=1.0).gear == 0.0, "reverse while rolling forwards"
    drive.hold(0.5, gear=2, clutch=1.0)
    drive.until(lambda seen: seen.vx_mps * KMH_PER_MPS > 70.0, 20.0, gear=2, throttle=1.0)
    assert drive.hold(0.5, gear=1, clutch=1.0).gear == 0.0, "first would turn the engine beyond its limit"


def test_a_gear_goes_in_without_the_clutch_when_speeds_match() -> None:
    drive = launched(0.6, 1.0)
    drive.hold(2.0, gear=1, throttle=0.6)
    drive.hold(0.1, gear=0)
    ratio = 1.95 / 3.55
    target = drive.seen.engine_radps * ratio
    drive.until(lambda seen: seen.engine_radps < target, 5.0, gear=0)
    assert drive.hold(0.02, gear=2).gear == 2.0


def test_zero_to_hundred_and_back() -> None:
    drive = Drive(platform())
    drive.until(lambda seen: seen.vx_mps * KMH_PER_MPS >= 100.0, 20.0, automatic=1, gear=1, throttle=1.0)
    started = drive.time_s
    print(f"0-100 km/h in {started:.2f} s over {drive.seen.x_m:.0f} m")
    assert 9.0 < started < 14.0
    from_m = drive.seen.x_m
    drive.until(lambda seen: seen.vx_mps <= 0.0, 10.0, automatic=1, gear=1, brake=1.0)
    print(f"100-0 km/h in {drive.time_s - started:.2f} s over {drive.seen.x_m - from_m:.1f} m")
    assert 38.0 < drive.seen.x_m - from_m < 50.0


def test_top_speed_is_where_drag_and_power_meet() -> None:
    drive = Drive(platform())
    seen = drive.hold(150.0, automatic=1, gear=1, throttle=1.0)
    print(f"top speed {seen.vx_mps * KMH_PER_MPS:.0f} km/h in gear {seen.gear:.0f}")
    assert 165.0 < seen.vx_mps * KMH_PER_MPS < 215.0
    assert abs(seen.full_throttle_accel_mps2) < 0.02


def test_coasts_down_to_rest_and_loses_energy_all_the_way() -> None:
    drive = Drive(platform())
    drive.until(lambda seen: seen.vx_mps * KMH_PER_MPS > 60.0, 30.0, automatic=1, gear=1, throttle=0.7)
    drive.hold(0.2, gear=drive.seen.gear, clutch=1.0)
    speeds = [drive.seen.vx_mps]
    forecast, measured = [], []
    while speeds[-1] > 1.0:
        seen = drive.hold(1.0)
        speeds.append(seen.vx_mps)
        forecast.append(seen.coast_accel_mps2)
        measured.append(seen.ax_mps2)
    assert all(after < before for before, after in pairwise(speeds))
    assert 60.0 < len(speeds) < 240.0
    for wanted, real in list(zip(forecast, measured, strict=True))[:-5]:
        assert wanted == pytest.approx(real, abs=0.03)
    seen = drive.hold(30.0)
    assert seen.vx_mps == pytest.approx(0.0, abs=1e-9)


def test_energy_of_rolling_down_is_no_more_than_the_height_lost() -> None:
    drive = Drive(platform(ground=Ground(1.0, -0.08, 0.0)))
    seen = drive.hold(15.0)
    assert seen.distance_m > 50.0
    assert seen.z_m == pytest.approx(-seen.distance_m * math.sin(math.atan(0.08)), rel=1e-4)
    gained = 0.5 * seen.vx_mps**2
    lost = -STANDARD_GRAVITY_MPS2 * seen.z_m
    print(f"{gained / lost:.3f} of the height's energy is motion")
    assert 0.7 * lost < gained < lost


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("turn_slip_arm_m", [0.0, HATCHBACK.steering.turn_slip_arm_m])
def test_circle_at_walking_pace_has_the_ackermann_radius(way: float, turn_slip_arm_m: float) -> None:
    """Turn slip bends the rack back a little: the circle of patches without it is the geometry's."""
    profile = altered(steering={"turn_slip_arm_m": turn_slip_arm_m})
    drive = Drive(build(profile, ORIGIN, LEVEL))
    angle = 0.3 * way
    drive.until(lambda seen: seen.vx_mps > 1.3, 10.0, automatic=1, gear=1, throttle=0.2, road_wheel_rad=angle)
    radii = []
    for _ in range(100):
        seen = drive.hold(0.02, clutch=1.0, gear=1, road_wheel_rad=angle)
        radii.append(seen.vx_mps / seen.yaw_rate_radps)
    radius = sum(radii) / len(radii)
    print(f"radius {radius:.3f} m, Ackermann {2.6 / math.tan(angle):.3f} m")
    assert radius == pytest.approx(2.6 / math.tan(angle), rel=0.01 if turn_slip_arm_m == 0.0 else 0.015)


def test_understeers_at_speed_and_self_aligns() -> None:
    drive = Drive(platform())
    drive.until(lambda seen: seen.vx_mps > 20.0, 30.0, automatic=1, gear=1, throttle=0.8)
    seen = drive.hold(2.0, automatic=1, gear=1, throttle=0.4, road_wheel_rad=0.03)
    curvature = seen.yaw_rate_radps / seen.vx_mps
    print(f"{seen.ay_mps2:.2f} m/s2, {seen.hand_wheel_torque_nm:.2f} N m, {curvature * 2.6 / 0.03:.2f} of Ackermann")
    assert 2.0 < seen.ay_mps2 < 7.0
    assert 0.4 < curvature * 2.6 / 0.03 < 0.95
    assert -8.0 < seen.hand_wheel_torque_nm < -0.5
    assert seen.roll_rad > 0.0


def test_grip_limits_what_steering_and_brakes_can_do() -> None:
    for friction in (1.0, 0.4):
        drive = Drive(platform(ground=Ground(friction, 0.0, 0.0)))
        drive.until(lambda seen: seen.vx_mps > 15.0, 60.0, automatic=1, gear=1, throttle=0.5)
        worst = 0.0
        for _ in range(400):
            seen = drive.hold(TICK_S, automatic=1, gear=1, brake=1.0, road_wheel_rad=0.3)
            worst = max(worst, math.hypot(seen.ax_mps2, seen.ay_mps2))
        print(f"friction {friction}: at most {worst:.2f} m/s2")
        assert 0.85 * friction * STANDARD_GRAVITY_MPS2 < worst < 1.03 * friction * STANDARD_GRAVITY_MPS2


def test_hand_brake_in_a_bend_brings_the_tail_round() -> None:
    yaw = []
    for handbrake in (0.0, 1.0):
        drive = Drive(platform())
        drive.until(lambda seen: seen.vx_mps > 14.0, 30.0, automatic=1, gear=1, throttle=0.7)
        seen = drive.hold(1.5, automatic=1, gear=1, road_wheel_rad=0.08, handbrake=handbrake)
        yaw.append(seen.yaw_rad)
    assert yaw[1] > yaw[0] + 0.15


def test_left_and_right_are_mirror_images_to_the_last_bit() -> None:
    left = Drive(platform(ground=Ground(0.9, 0.02, 0.03), pose=Pose(1.0, 2.0, 0.3)))
    right = Drive(platform(ground=Ground(0.9, 0.02, -0.03), pose=Pose(1.0, -2.0, -0.3)))
    for index in range(2000):
        angle = 0.25 * math.sin(0.004 * index) + 0.05
        pedals = {"throttle": 0.6, "brake": 0.0} if index % 700 < 500 else {"throttle": 0.0, "brake": 0.8}
        a = left.hold(TICK_S, automatic=1, gear=1, road_wheel_rad=angle, **pedals)
        b = right.hold(TICK_S, automatic=1, gear=1, road_wheel_rad=-angle, **pedals)
        assert (a.x_m, a.y_m, a.yaw_rad, a.vx_mps, a.vy_mps) == (b.x_m, -b.y_m, -b.yaw_rad, b.vx_mps, -b.vy_mps)
        assert (a.ay_mps2, a.roll_rad, a.hand_wheel_torque_nm) == (-b.ay_mps2, -b.roll_rad, -b.hand_wheel_torque_nm)
    assert abs(left.seen.y_m) > 1.0


def test_direction_in_the_map_does_not_matter() -> None:
    """The same drive in another heading is the same drive, up to rounding."""
    ends = []
    for yaw in (0.0, 2.0, -3.0):
        drive = Drive(platform(pose=Pose(0.0, 0.0, yaw)))
        seen = drive.hold(6.0, automatic=1, gear=1, throttle=0.5, road_wheel_rad=0.1)
        along = seen.x_m * math.cos(yaw) + seen.y_m * math.sin(yaw)
        across = seen.y_m * math.cos(yaw) - seen.x_m * math.sin(yaw)
        ends.append((along, across))
    assert ends[1] == pytest.approx(ends[0], abs=1e-9)
    assert ends[2] == pytest.approx(ends[0], abs=1e-9)


def test_forecasts_of_the_pedals_come_true() -> None:
    for brake, throttle, speed in [(0.0, 1.0, 12.0), (0.4, 0.0, 25.0), (0.0, 0.4, 8.0), (0.0, 0.0, 15.0)]:
        drive = Drive(platform())
        drive.until(lambda seen, speed=speed: seen.vx_mps > speed, 30.0, automatic=1, gear=1, throttle=0.6)  # type: ignore[misc]
        drive.hold(0.6, automatic=1, gear=1)
        drive.hold(1.0, automatic=1, gear=1, throttle=throttle, brake=brake)
        errors = []
        for _ in range(50):
            seen = drive.hold(TICK_S, automatic=1, gear=1, throttle=throttle, brake=brake)
            coast = seen.coast_accel_mps2
            wanted = coast + throttle * (seen.full_throttle_accel_mps2 - coast)
            wanted += brake * (seen.full_brake_accel_mps2 - coast)
            errors.append(seen.ax_mps2 - wanted)
        print(f"throttle {throttle}, brake {brake}: off by {sum(errors) / len(errors):.3f} m/s2")
        assert abs(sum(errors) / len(errors)) < 0.25
