"""What the pedals of the shipped cars do on hills, on ice and in a shift: figures that a driver would notice."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from simconsole.values.platform import Ground
from simconsole.values.signals import GearFault
from simconsole.values.units import KMH_PER_MPS
from tests.vehicle.driving import TICK_S, Drive
from tests.vehicle.shipped import SHIPPED, shipped

AVERAGE_S = 0.05
"""Over which accelerations are averaged before their change counts as a jerk: 20 Hz, more than a body feels."""
SLOWER_KMH = 0.5
"""By which a car with traction control may be slower after 8 s than one whose wheels spin."""


def uphill(drive: Drive, seconds: float, throttle: float) -> tuple[float, float]:
    """Drive off from the brake under the automatic; return the speed at the end and the lowest, in km/h."""
    drive.hold(1.0, automatic=1, gear=1, brake=0.6)
    lowest = 0.0
    for _ in range(round(seconds / TICK_S)):
        seen = drive.hold(TICK_S, automatic=1, gear=1, throttle=throttle)
        lowest = min(lowest, seen.vx_mps)
        assert seen.gear != 0.0 or drive.state.shift_left_s > 0.0, "neutral against the driver's wish"
    return seen.vx_mps * KMH_PER_MPS, lowest * KMH_PER_MPS


@pytest.mark.parametrize("car", SHIPPED)
@pytest.mark.parametrize(("friction", "slope"), [(1.0, 0.15), (1.0, 0.20), (1.0, 0.25), (0.5, 0.15), (0.3, 0.05)])
def test_full_throttle_goes_up_a_hill_and_with_traction_control_no_slower(
    car: str, friction: float, slope: float
) -> None:
    ground = Ground(friction, slope, 0.0)
    regulated, lowest = uphill(shipped(car, ground, traction_control=True), 8.0, 1.0)
    spinning, _ = uphill(shipped(car, ground, traction_control=False), 8.0, 1.0)
    print(f"{regulated:.1f} km/h after 8 s, lowest {lowest:.2f}; without traction control {spinning:.1f}")
    assert regulated > 10.0
    assert regulated >= spinning
    assert lowest > -1.0


@pytest.mark.parametrize("car", SHIPPED)
@pytest.mark.parametrize("friction", [0.3, 0.5, 1.0])
def test_on_the_flat_traction_control_is_at_least_as_fast_as_none(car: str, friction: float) -> None:
    speeds = []
    for on in (True, False):
        drive = shipped(car, Ground(friction, 0.0, 0.0), traction_control=on)
        speeds.append(drive.hold(8.0, automatic=1, gear=1, throttle=1.0).vx_mps * KMH_PER_MPS)
    print(f"{speeds[0]:.1f} km/h after 8 s, {speeds[1]:.1f} without")
    assert speeds[0] >= speeds[1]
    if friction < 0.4:
        assert speeds[0] > 1.03 * speeds[1], "the peak of the force is worth more than sliding"


def dumped(drive: Drive, seconds: float) -> tuple[float, float]:
    """Let the clutch go at once at full throttle in first gear, by hand; return speed in km/h and whether it runs."""
    drive.hold(1.0, brake=0.8, clutch=1.0, gear=1)
    drive.hold(0.4, brake=0.8, clutch=1.0, gear=1, throttle=1.0)
    seen = drive.hold(seconds, gear=1, throttle=1.0)
    return seen.vx_mps * KMH_PER_MPS, seen.engine_running


@pytest.mark.parametrize("car", ["hatchback", "light_van"])
@pytest.mark.parametrize("friction", [0.3, 0.5, 1.0])
@pytest.mark.parametrize("slope", [0.0, 0.15, 0.20, 0.25])
def test_long_wheelspin_leaves_traction_control_no_slower_than_none(car: str, friction: float, slope: float) -> None:
    """The clutch is dumped, so that the wheels spin at once: what is taken back must come back."""
    ground = Ground(friction, slope, 0.0)
    regulated, runs = dumped(shipped(car, ground, traction_control=True), 8.0)
    spinning, _ = dumped(shipped(car, ground, traction_control=False), 8.0)
    print(f"{regulated:.1f} km/h after 8 s; without traction control {spinning:.1f}")
    assert regulated >= spinning - SLOWER_KMH
    assert runs == 1.0


def test_a_car_that_rolls_back_is_driven_up_again() -> None:
    """Its gear stays in: traction control counts the slip against the way that the car is to go."""
    drive = shipped("light_van", Ground(1.0, 0.20, 0.0), hill_hold=False)
    drive.hold(0.5, automatic=1, gear=1, brake=0.6)
    assert drive.hold(2.0, automatic=1, gear=1).vx_mps < -1.5
    assert drive.hold(6.0, automatic=1, gear=1, throttle=1.0).vx_mps > 3.0


@pytest.mark.parametrize("car", SHIPPED)
def test_a_person_starts_by_hand_on_a_hill_of_25_percent(car: str) -> None:
    """Hand brake, clutch to where it bites, then both let go: no car rolls back, none stalls, then or later."""
    drive = shipped(car, Ground(1.0, 0.25, 0.0))
    drive.hold(1.0, brake=0.8, handbrake=1.0, clutch=1.0, gear=1)
    start = drive.hold(0.5, handbrake=1.0, clutch=1.0, gear=1, throttle=0.6).x_m
    lowest, speeds = start, []
    for tick in range(2000):
        clutch = max(0.50, 0.75 - 0.001 * tick) if tick < 1200 else max(0.0, 0.50 - 0.005 * (tick - 1200))
        hand = max(0.0, 1.0 - max(0.0, 0.01 * (tick - 200)))
        seen = drive.hold(TICK_S, clutch=clutch, throttle=0.9, gear=1, handbrake=hand)
        lowest = min(lowest, seen.x_m)
        speeds.append(seen.vx_mps)
    print(f"rolled back {100.0 * (start - lowest):.1f} cm, then {seen.vx_mps * KMH_PER_MPS:.1f} km/h")
    assert lowest > start - 0.05
    assert seen.engine_running == 1.0
    assert seen.x_m > start + 3.0
    assert seen.vx_mps > 2.0
    assert speeds[-1] > speeds[-250], "it drives on after the clutch has closed"


def shift(drive: Drive, throttle: float) -> NDArray[np.float64]:
    """Return time from the first upshift in s, and acceleration in m/s2, from 1 s before it to 2 s after."""
    rows: list[tuple[float, float]] = []
    begun = None
    while begun is None or len(rows) < begun + round(2.0 / TICK_S):
        seen = drive.hold(TICK_S, automatic=1, gear=1, throttle=throttle)
        rows.append((drive.time_s, seen.ax_mps2))
        if begun is None and seen.vx_mps > 2.0 and drive.state.shift_left_s > 0.0:
            begun = len(rows)
        assert drive.time_s < 60.0
    part = np.array(rows[begun - round(1.0 / TICK_S) :])
    part[:, 0] -= rows[begun - 1][0]
    return part


def averaged(values: NDArray[Any]) -> NDArray[np.float64]:
    """Return moving averages over AVERAGE_S."""
    count = round(AVERAGE_S / TICK_S)
    return np.convolve(values, np.full(count, 1.0 / count), "valid")


@pytest.mark.parametrize("car", SHIPPED)
def test_a_shift_up_is_felt_as_a_pause_and_not_as_a_jolt(car: str) -> None:
    """The trend is the straight line from the acceleration before the shift to the one 1.5 s after it."""
    part = shift(shipped(car), 0.3)
    time, accel = part[:, 0], part[:, 1]
    before, after = accel[time < 0.0].mean(), accel[time > 1.5].mean()
    trend = before + (after - before) * np.clip(time / 1.5, 0.0, 1.0)
    over = float((accel - trend).max())
    jerk = float(np.abs(np.diff(averaged(accel)) / TICK_S).max())
    print(f"{before:.2f} to {after:.2f} m/s2, at most {over:.2f} over the trend, jerk {jerk:.1f} m/s3")
    assert over <= 2.0
    assert jerk <= 20.0


@pytest.mark.parametrize("car", SHIPPED)
def test_creeps_at_6_to_8_kmh_and_stops_for_the_brake(car: str) -> None:
    drive = shipped(car)
    drive.hold(1.0, automatic=1, gear=1, brake=0.3)
    assert drive.seen.vx_mps < 0.001
    assert drive.state.clutch >= 0.75 - 1e-9, "no heat while somebody brakes"
    speed = drive.hold(12.0, automatic=1, gear=1).vx_mps * KMH_PER_MPS
    print(f"{speed:.2f} km/h")
    assert 6.0 <= speed <= 8.0
    assert drive.hold(2.0, automatic=1, gear=1, brake=0.2).vx_mps < 0.01
    assert drive.seen.engine_running == 1.0
    assert drive.hold(12.0, automatic=1, gear=-1).vx_mps * KMH_PER_MPS < -5.0


@pytest.mark.parametrize("car", SHIPPED)
def test_no_throttle_is_dead_and_more_of_it_is_never_less(car: str) -> None:
    speeds = []
    for throttle in (0.0, 0.05, 0.12, 0.2, 0.3, 0.5, 0.8, 1.0):
        drive = shipped(car)
        speeds.append(drive.hold(8.0, automatic=1, gear=1, throttle=throttle).vx_mps)
    print("m/s after 8 s: " + ", ".join(f"{speed:.2f}" for speed in speeds))
    assert speeds[2] > 1.5
    assert speeds == sorted(speeds)


@pytest.mark.parametrize("car", ["hatchback", "light_van"])
def test_a_clutch_that_slips_on_a_hill_saves_itself_and_the_hill_hold_takes_over(car: str) -> None:
    """15 % at a throttle that does not carry the car: open after a minute, held by the brakes, cooled, ready again."""
    drive = shipped(car, Ground(1.0, 0.15, 0.0))
    drive.hold(1.0, automatic=1, gear=1, brake=0.3)
    start = drive.seen.x_m
    seen = drive.until(lambda seen: seen.gear_fault == GearFault.CLUTCH_HOT, 75.0, automatic=1, gear=1, throttle=0.4)
    opened_s = drive.time_s
    drive.hold(1.0, automatic=1, gear=1, throttle=0.4)
    assert drive.state.clutch >= 0.75 - 1e-9
    hottest = drive.state.clutch_heat
    seen = drive.until(lambda seen: seen.gear_fault == 0.0, 60.0, automatic=1, gear=1, throttle=0.4)
    print(f"open after {opened_s:.0f} s, again closing after {drive.time_s:.0f} s, {100 * (seen.x_m - start):.1f} cm")
    assert hottest < 1.02
    assert abs(seen.x_m - start) < 0.05
    assert seen.gear == 1.0
    assert drive.hold(4.0, automatic=1, gear=1, throttle=1.0).vx_mps > 2.0


def test_the_driveline_takes_its_share_of_the_top_speed() -> None:
    """84 kW and a drag area of 0.68 m2: cars of this class reach 185 to 196 km/h."""
    drive = shipped("hatchback", speed_mps=45.0)
    speed = drive.hold(150.0, automatic=1, gear=1, throttle=1.0).vx_mps * KMH_PER_MPS
    print(f"{speed:.1f} km/h")
    assert 185.0 < speed < 196.0
