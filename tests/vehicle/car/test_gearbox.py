"""Gears and clutch, and the automatic: never stalls, shifts once per need, hands them back to the person."""

import random

import pytest

from simconsole.values.platform import Ground
from simconsole.values.signals import GearFault, Request
from simconsole.values.units import KMH_PER_MPS
from simconsole.vehicle.car.aids import ANY_NM
from simconsole.vehicle.car.gearbox import Turning, bite, gear_ratio, gearbox_step
from simconsole.vehicle.car.state import Gearbox
from tests.samples import Sample
from tests.vehicle.altered import altered, rolling_car
from tests.vehicle.driving import TICK_S, Drive, platform
from tests.vehicle.parts import CAR, STEP_S
from tests.vehicle.rolling import rolling


@pytest.mark.parametrize("throttle", [0.1, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("slope", [0.0, 0.10])
def test_drives_off_and_stops_without_stalling(throttle: float, slope: float) -> None:
    drive = Drive(platform(ground=Ground(1.0, slope, 0.0)))
    for brake in (0.2, 1.0):
        for _ in range(1500):
            assert drive.hold(TICK_S, automatic=1, gear=1, throttle=throttle).engine_running == 1.0
        while drive.seen.vx_mps > 0.01:
            assert drive.hold(TICK_S, automatic=1, gear=1, brake=brake).engine_running == 1.0
        assert drive.hold(0.5, automatic=1, gear=1, brake=brake).engine_running == 1.0


def test_random_pedals_and_directions_never_stall_it(sample: Sample) -> None:
    rng = random.Random(sample.seed)
    for friction in (1.0, 0.3):
        drive = Drive(platform(ground=Ground(friction, 0.05, 0.0)))
        for _ in range(sample.of(60, 2000)):
            command = {
                "gear": rng.choice([1.0, 1.0, 1.0, -1.0, 0.0]),
                "throttle": rng.choice([0.0, rng.random(), 1.0]),
                "brake": rng.choice([0.0, 0.0, rng.random(), 1.0]),
                "handbrake": rng.choice([0.0, 0.0, 0.0, 1.0]),
                "road_wheel_rad": rng.uniform(-0.4, 0.4),
            }
            for _ in range(round(rng.uniform(0.1, 3.0) / TICK_S)):
                drive.hold(TICK_S, automatic=1, **command)
                assert drive.seen.engine_running == 1.0, command


@pytest.mark.parametrize("throttle", [0.35, 0.6, 1.0])
def test_shifts_up_through_the_gears_without_hunting(throttle: float) -> None:
    drive = Drive(platform())
    gears = [1.0]
    for _ in range(round(40.0 / TICK_S)):
        gear = drive.hold(TICK_S, automatic=1, gear=1, throttle=throttle).gear
        if gear not in (0.0, gears[-1]):
            gears.append(gear)
    print(f"gears {gears}")
    assert gears == sorted(gears)
    assert len(gears) >= 3


def test_a_shift_opens_the_clutch_for_about_a_quarter_second() -> None:
    drive = Drive(platform())
    open_s = 0.0
    for _ in range(round(8.0 / TICK_S)):
        seen = drive.hold(TICK_S, automatic=1, gear=1, throttle=0.5)
        open_s += TICK_S if seen.clutch > 0.74 and seen.vx_mps > 3.0 else 0.0
    assert seen.gear == 2.0
    print(f"fully open for {open_s:.3f} s")
    assert 0.12 < open_s < 0.25


def test_changes_direction_only_when_nearly_standing() -> None:
    drive = Drive(platform())
    drive.until(lambda seen: seen.vx_mps > 5.0, 10.0, automatic=1, gear=1, throttle=0.6)
    assert drive.hold(0.5, automatic=1, gear=-1).gear == 0.0
    drive.until(lambda seen: seen.gear == -1.0, 10.0, automatic=1, gear=-1, brake=0.4)
    assert abs(drive.seen.vx_mps) < 1.0
    assert drive.hold(3.0, automatic=1, gear=-1, throttle=0.4).vx_mps < -1.0


def test_engine_off_is_started_by_the_automatic() -> None:
    drive = Drive(platform())
    drive.hold(0.5, clutch=1.0, gear=1)
    assert drive.hold(1.5, gear=1).engine_running == 0.0
    assert drive.hold(1.5, automatic=1, gear=1).engine_running == 1.0


def driving_by_itself() -> Drive:
    drive = Drive(platform())
    drive.until(lambda seen: seen.vx_mps * KMH_PER_MPS > 45.0, 20.0, automatic=1, gear=1, throttle=0.6)
    drive.hold(2.0, automatic=1, gear=1, throttle=0.3)
    return drive


def test_keeps_the_gear_after_handing_back_until_the_clutch_is_pressed() -> None:
    drive = driving_by_itself()
    gear = drive.seen.gear
    assert gear > 1.0
    assert drive.hold(3.0, gear=1, throttle=0.3).gear == gear, "the lever says another gear"
    assert drive.state.lever_adopted == 0.0
    assert drive.hold(1.0, gear=0, throttle=0.3).gear == gear, "the lever says neutral"
    assert drive.hold(0.1, gear=gear + 1, clutch=1.0).gear == gear + 1
    assert drive.state.lever_adopted == 1.0
    assert drive.hold(0.5, gear=0).gear == 0.0, "now the lever decides"


def test_matching_lever_takes_the_gears_back_at_once() -> None:
    drive = driving_by_itself()
    gear = drive.seen.gear
    drive.hold(0.1, gear=gear, throttle=0.3)
    assert drive.state.lever_adopted == 1.0


def test_handed_back_and_left_alone_it_comes_to_rest_without_stalling() -> None:
    drive = driving_by_itself()
    seen = drive.until(lambda seen: seen.vx_mps < 0.01, 30.0, gear=0, brake=0.3)
    assert seen.engine_running == 1.0
    assert drive.hold(1.0, gear=1, brake=0.3).engine_running == 1.0, "even if the lever matches: the clutch is open"


@pytest.mark.parametrize("brake", [0.1, 0.25, 0.4])
def test_shifting_down_under_braking_does_not_jolt(brake: float) -> None:
    """The engine is brought to the lower gear's speed first: the clutch must not spin it up out of the car's motion."""
    drive = Drive(platform())
    drive.until(lambda seen: seen.vx_mps > 20.0, 60.0, automatic=1, gear=1, throttle=0.7)
    drive.hold(1.0, automatic=1, gear=1, brake=brake)
    steady = drive.seen.ax_mps2
    least, gears = steady, {drive.seen.gear}
    while drive.seen.vx_mps > 3.0:
        least = min(least, drive.hold(TICK_S, automatic=1, gear=1, brake=brake).ax_mps2)
        gears.add(drive.seen.gear)
    print(f"steady {steady:.2f} m/s2, least {least:.2f} m/s2, gears {sorted(gears)}")
    assert len(gears) >= 2
    assert least > steady - 1.2


def test_ratios_and_bite() -> None:
    assert gear_ratio(CAR.gears, 0.0) == 0.0
    assert gear_ratio(CAR.gears, -1.0) == -3.2 * 4.05
    assert [gear_ratio(CAR.gears, float(g)) / 4.05 for g in range(1, 8)] == pytest.approx(
        [3.55, 1.95, 1.28, 0.97, 0.78, 0.65, 0.0]
    )
    assert bite(CAR.gears, 0.0) == bite(CAR.gears, 0.3) == 1.0
    assert bite(CAR.gears, 0.75) == bite(CAR.gears, 1.0) == 0.0
    assert 0.0 < bite(CAR.gears, 0.5) < 0.5


def test_lever_between_two_gears_is_neutral() -> None:
    box = Gearbox(3.0, 0.0, 1.0, 3.0, 0.0, 1.0, 0.0)
    request = Request(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    turning = Turning(engine_radps=150.0, wheel_radps=20.0, vx_mps=6.0, asked_nm=0.0, most_nm=ANY_NM, hot=0.0)
    assert gearbox_step(CAR.gears, box, request, turning, STEP_S).gear == 0.0
    assert gearbox_step(CAR.gears, box, request._replace(gear=4.0), turning, STEP_S).gear == 4.0


def test_automatic_taking_over_in_neutral_at_speed_finds_the_gear() -> None:
    box = Gearbox(0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0)
    request = Request(0.0, 0.3, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0)
    turning = Turning(engine_radps=84.0, wheel_radps=25.0 / 0.306, vx_mps=25.0, asked_nm=0.0, most_nm=ANY_NM, hot=0.0)
    shifting = gearbox_step(CAR.gears, box, request, turning, STEP_S)
    assert shifting.wanted_gear == 4.0, "3065 rpm, where fifth would have 2460 and third 4040"
    assert shifting.lever_adopted == 0.0


def test_seven_gears_each_go_in_and_pull_longer() -> None:
    profile = altered(gearbox={"forward": (3.55, 2.2, 1.55, 1.16, 0.92, 0.76, 0.63)})
    speeds = []
    for gear in range(1, 8):
        drive = rolling_car(profile, 4.0 + 3.0 * gear)
        drive.hold(0.3, clutch=1.0, gear=gear)
        seen = drive.hold(1.0, gear=gear, throttle=0.5)
        assert (seen.gear, seen.gear_fault) == (gear, 0.0)
        speeds.append(seen.vx_mps / seen.engine_radps)
    assert speeds == sorted(speeds)
    assert speeds[6] == pytest.approx(0.306 / (0.63 * 4.05), rel=0.03)


def test_the_gearbox_tells_why_a_gear_does_not_go_in() -> None:
    drive = rolling(15.0)
    assert drive.hold(0.1, gear=2).gear_fault == GearFault.GRIND, "no clutch, and the engine idles"
    assert drive.seen.gear == 0.0
    assert drive.hold(0.1, gear=2, clutch=1.0).gear_fault == 0.0
    assert drive.seen.gear == 2.0
    assert drive.hold(0.1, gear=-1, clutch=1.0).gear_fault == GearFault.MISSED
    assert drive.hold(0.1, gear=7, clutch=1.0).gear_fault == GearFault.MISSED, "six gears"
    assert drive.hold(0.1, gear=0, clutch=1.0).gear_fault == 0.0
    drive = rolling(80.0 / KMH_PER_MPS)
    assert drive.hold(0.1, gear=1, clutch=1.0).gear_fault == GearFault.MONEY_SHIFT
    assert drive.hold(0.1, gear=1).gear_fault == GearFault.MONEY_SHIFT | GearFault.GRIND
    assert drive.seen.gear == 0.0
    assert drive.hold(0.1, automatic=1, gear=1).gear_fault == 0.0
