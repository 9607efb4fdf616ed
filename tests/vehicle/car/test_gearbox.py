"""The automatic: never stalls, shifts once per need, hands clutch and gears back to the person."""

import random

import pytest

from simconsole.values.platform import Ground
from simconsole.values.units import KMH_PER_MPS
from tests.samples import Sample
from tests.vehicle.driving import TICK_S, Drive, platform


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
