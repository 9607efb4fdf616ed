"""The car at rest: the tyre law must hold it with no clamp of speed and no switch to kinematics."""

import math

import pytest

from simconsole.values.kernels import put
from simconsole.values.platform import Ground, Pose
from simconsole.values.state_vector import PLATFORM_AT
from tests.samples import Sample
from tests.vehicle.altered import HATCHBACK, altered, rolling_car
from tests.vehicle.driving import Drive, platform
from tests.vehicle.random_states import random_cars, settle, speeds_mps
from tests.vehicle.rolling import rolling

CREEP_M = 1e-4  # 0.1 mm
SETTLING_S = 10.0
WATCHED_S = 60.0


def creep(drive: Drive, **command: float) -> float:
    """Return how far the car moves in a minute, after the sway of stopping is over."""
    before = drive.hold(SETTLING_S, **command)
    after = drive.hold(WATCHED_S, **command)
    print(f"creep {after.x_m - before.x_m:.3g} m along x, {after.y_m - before.y_m:.3g} m along y")
    assert abs(after.vx_mps) < 1e-9
    return max(abs(after.x_m - before.x_m), abs(after.y_m - before.y_m))


@pytest.mark.parametrize("slope", [-0.15, 0.0, 0.15])
@pytest.mark.parametrize("yaw_rad", [0.0, 0.8])
def test_foot_brake_holds_without_creep(slope: float, yaw_rad: float) -> None:
    drive = Drive(platform(ground=Ground(1.0, slope, 0.0), pose=Pose(5.0, -3.0, yaw_rad)))
    assert creep(drive, brake=0.5) < CREEP_M


def test_hand_brake_holds_twenty_percent() -> None:
    assert creep(Drive(platform(ground=Ground(1.0, 0.2, 0.0))), handbrake=1.0) < CREEP_M


def test_brake_holds_across_the_slope_with_turned_wheels() -> None:
    assert creep(Drive(platform(ground=Ground(1.0, 0.0, 0.15))), brake=0.5, road_wheel_rad=0.5) < CREEP_M


def test_rolls_back_then_brakes_and_holds() -> None:
    drive = Drive(platform(ground=Ground(1.0, 0.10, 0.0)))
    assert drive.hold(1.0).vx_mps == pytest.approx(-0.84, abs=0.05)
    assert creep(drive, brake=0.6) < CREEP_M


def test_stops_uphill_and_holds_in_gear_with_the_engine_off() -> None:
    drive = Drive(platform(ground=Ground(1.0, 0.10, 0.0)))
    drive.until(lambda seen: seen.vx_mps > 8.0, 20.0, automatic=1, gear=1, throttle=1.0)
    drive.until(lambda seen: seen.vx_mps < 0.01, 10.0, gear=drive.seen.gear, clutch=1.0, brake=0.6)
    drive.hold(1.0, gear=0, clutch=1.0, brake=1.0)
    drive.hold(1.0, gear=1, clutch=1.0, brake=1.0)
    assert drive.hold(2.0, gear=1, brake=1.0).engine_running == 0.0
    assert drive.seen.gear == 1.0
    assert creep(drive, gear=1) < CREEP_M


def test_level_ground_needs_no_brake() -> None:
    drive = Drive(platform())
    assert creep(drive) == 0.0


def stop(drive: Drive) -> None:
    """Brake until no wheel turns and the tyres have sprung back."""
    wheels = [f"{wheel}_radps" for wheel in ("fl", "fr", "rl", "rr")]
    drive.until(lambda _: not any(getattr(drive.state, name) for name in wheels), 5.0, brake=0.6, clutch=1.0)
    drive.hold(0.3, brake=0.6, clutch=1.0)


def test_a_body_that_still_rocks_over_standing_wheels_has_no_speed_of_its_own() -> None:
    drive = rolling_car(altered(front={"support_deg": 0.0}, rear={"support_deg": 0.0}), 14.0)
    rocking = told = 0.0
    stop(drive)
    for _ in range(250):
        seen = drive.hold(0.004, brake=0.6, clutch=1.0)
        rocking, told = max(rocking, abs(drive.state.vx_mps)), max(told, abs(seen.vx_mps))
    print(f"centre of gravity {rocking:.3f} m/s, base_link {told:.3f} m/s: the tyres give a little")
    assert rocking > 0.05, "nothing rocked: nothing shown"
    assert told < 0.5 * rocking


def test_links_that_hold_the_dive_leave_base_link_as_quiet_and_rock_the_body_less() -> None:
    told = []
    for deg in (0.0, HATCHBACK.rear.support_deg):
        drive = rolling_car(altered(front={"support_deg": 0.2 * deg}, rear={"support_deg": deg}), 14.0)
        stop(drive)
        told.append(max(abs(drive.hold(0.004, brake=0.6, clutch=1.0).vx_mps) for _ in range(250)))
    assert told[1] < 1.5 * told[0] < 0.06


def test_the_pose_moves_with_the_speed_that_is_told() -> None:
    drive = rolling(15.0)
    before = drive.seen
    x, y = before.x_m, before.y_m
    for tick in range(750):
        seen = drive.hold(0.004, road_wheel_rad=0.05 if tick < 250 else -0.05, brake=0.2 if tick > 500 else 0.0)
        c, s = math.cos(seen.yaw_rad), math.sin(seen.yaw_rad)
        x += 0.004 * (seen.vx_mps * c - seen.vy_mps * s)
        y += 0.004 * (seen.vx_mps * s + seen.vy_mps * c)
    assert math.hypot(seen.x_m - x, seen.y_m - y) < 0.02


def test_ice_does_not_hold_what_asphalt_holds() -> None:
    drive = Drive(platform(ground=Ground(0.1, 0.15, 0.0)))
    assert drive.hold(5.0, brake=1.0).vx_mps < -1.0


def test_ground_without_any_friction_is_survived() -> None:
    drive = Drive(platform(ground=Ground(0.0, -0.05, 0.0)))
    seen = drive.hold(5.0, brake=1.0, road_wheel_rad=0.3)
    assert seen.vx_mps == pytest.approx(5.0 * 9.80665 * 0.05, rel=0.3)


def test_steering_to_and_fro_on_a_slope_leaves_the_car_in_place() -> None:
    drive = Drive(platform(ground=Ground(1.0, 0.15, 0.0)))
    before = drive.hold(SETTLING_S, brake=0.5)
    for _ in range(15):
        drive.hold(1.0, brake=0.5, road_wheel_rad=0.4)
        drive.hold(1.0, brake=0.5, road_wheel_rad=-0.4)
    after = drive.hold(SETTLING_S, brake=0.5)
    print(f"walked {after.x_m - before.x_m:.3g} m")
    assert abs(after.x_m - before.x_m) < CREEP_M


def test_same_law_forwards_and_backwards() -> None:
    """A car that rolls down backwards must brake like one that rolls down forwards, apart from its weight balance."""
    results = []
    for slope in (0.1, -0.1):
        drive = Drive(platform(ground=Ground(1.0, slope, 0.0)))
        drive.hold(4.0)
        speed = drive.seen.vx_mps
        drive.hold(10.0, brake=0.3)
        results.append((speed, drive.seen.x_m, drive.seen.vx_mps))
    assert results[0][0] == pytest.approx(-results[1][0], rel=1e-3)
    assert results[0][1] == pytest.approx(-results[1][1], rel=1e-2)
    assert abs(results[0][2]) < 1e-6


@pytest.mark.parametrize("speed_mps", [6.0, -4.0])
@pytest.mark.parametrize("slope", [0.15, -0.15])
def test_holds_after_braking_from_forwards_and_from_reverse(speed_mps: float, slope: float) -> None:
    drive = rolling(speed_mps, Ground(1.0, slope, 0.0))
    drive.hold(4.0, brake=0.6, clutch=1.0)
    assert creep(drive, brake=0.6, clutch=1.0) < CREEP_M


@pytest.mark.parametrize("slope", [0.20, -0.20])
@pytest.mark.parametrize("speed_mps", [6.0, -4.0])
def test_hand_brake_holds_twenty_percent_after_moving(speed_mps: float, slope: float) -> None:
    drive = rolling(speed_mps, Ground(1.0, slope, 0.0))
    drive.hold(6.0, handbrake=1.0, clutch=1.0)
    assert creep(drive, handbrake=1.0, clutch=1.0) < CREEP_M


@pytest.mark.parametrize(
    ("slope", "brakes"), [(0.15, {"brake": 0.5}), (-0.15, {"brake": 0.5}), (0.20, {"handbrake": 1.0})]
)
def test_holds_after_steering_on_the_spot(slope: float, brakes: dict[str, float]) -> None:
    """At equal steer angle: steering itself moves the car a little on its tyres, and back again."""
    drive = Drive(platform(ground=Ground(1.0, slope, 0.0)))
    before = drive.hold(SETTLING_S, **brakes)
    drive.hold(1.0, road_wheel_rad=0.5, **brakes)
    drive.hold(1.0, road_wheel_rad=-0.5, **brakes)
    assert creep(drive, **brakes) < CREEP_M
    assert abs(drive.seen.x_m - before.x_m) < CREEP_M


def test_from_any_state_full_brake_brings_rest(sample: Sample) -> None:
    cars = random_cars(sample.of(100, 5000), sample.seed, 0.5, brake=1.0, clutch=1.0)
    settle(cars, 20.0)
    print(f"at most {speeds_mps(cars).max():.2g} m/s after 20 s")
    assert speeds_mps(cars).max() < 1e-6


def test_two_tyres_that_hold_against_each_other_calm_down() -> None:
    """Their stored forces must not follow the load: that would feed the roll which changes the load."""
    drive = Drive(platform(ground=Ground(0.8, 0.08, 0.064)))
    strained = {"fl_deflection_y_m": -0.032, "fr_deflection_y_m": 0.025, "fl_deflection_x_m": 0.009}
    strained |= {"rl_deflection_y_m": -0.011, "rr_deflection_y_m": 0.012, "fr_deflection_x_m": 0.0045, "yaw_rad": 0.23}
    put(drive.row, PLATFORM_AT, drive.state._replace(**strained))
    drive.hold(20.0, brake=1.0, clutch=1.0)
    assert abs(drive.state.vy_mps) < 1e-6
