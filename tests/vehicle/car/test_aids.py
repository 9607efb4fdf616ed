"""Traction control and hill hold do what they are for, the aids can be switched off; the rim is quiet and light.

ABS and ESC are judged by the manoeuvres of tests/scenarios/test_handling.py.
"""

import math

import pytest

from simconsole.values.platform import Ground
from tests.vehicle.altered import NO_AIDS, altered, rolling_car
from tests.vehicle.driving import TICK_S, Drive, platform
from tests.vehicle.rolling import RADIUS_M, rolling


def test_traction_control_keeps_the_driven_wheels_near_the_road() -> None:
    spins = []
    for on in (True, False):
        drive = rolling(3.0, Ground(0.3, 0.0, 0.0), traction_control=on)
        most = 0.0
        for _ in range(500):
            drive.hold(TICK_S, automatic=1, gear=1, throttle=1.0)
            most = max(most, drive.state.fl_radps * RADIUS_M - drive.state.vx_mps)
        spins.append((most, drive.seen.vx_mps))
    print(f"spin, speed with and without: {spins}")
    assert spins[0][0] < 0.6 * spins[1][0]
    assert spins[0][1] > 0.95 * spins[1][1]


@pytest.mark.parametrize("hill_hold", [True, False])
def test_hill_hold_gives_two_seconds(hill_hold: bool) -> None:
    drive = rolling(0.0, Ground(1.0, 0.15, 0.0), hill_hold=hill_hold)
    drive.hold(1.0, brake=0.5)
    rolled = -drive.hold(1.8).x_m
    assert (rolled < 0.01) == hill_hold
    assert drive.hold(2.0).vx_mps < -1.0


def test_hill_hold_keeps_the_pressure_of_a_foot_that_leaves_slowly() -> None:
    drive = rolling(0.0, Ground(1.0, 0.2, 0.0))
    start = drive.hold(2.0, brake=0.6).x_m
    for tick in range(100):
        drive.hold(TICK_S, brake=0.6 * (1.0 - 0.01 * tick))
    assert abs(drive.hold(1.5).x_m - start) < 0.001
    assert drive.hold(2.0).vx_mps < -1.0


@pytest.mark.parametrize(("slope", "gear"), [(0.15, 1), (0.20, 1), (-0.20, -1)])
def test_hill_hold_waits_for_the_drive_however_long_the_foot_hesitates(slope: float, gear: int) -> None:
    """Throttle alone carries nothing: the hold bears the car until the clutch does, and lets it go uphill at once."""
    drive = rolling(0.0, Ground(1.0, slope, 0.0))
    drive.hold(1.0, brake=0.5, clutch=1.0, gear=gear)
    start = drive.hold(0.5, clutch=1.0, throttle=0.3, gear=gear).x_m
    uphill = math.copysign(1.0, slope)
    least = 0.0
    for clutch in (1.0, 1.0, 1.0, *(0.75 - 0.025 * n for n in range(12))):
        for _ in range(250):
            moved = drive.hold(TICK_S, clutch=clutch, throttle=0.6, gear=gear).x_m - start
            least = min(least, uphill * moved)
    print(f"rolled back {1000.0 * -least:.2f} mm, then drove {uphill * moved:.1f} m")
    assert least > -0.002
    assert uphill * moved > 1.0
    assert drive.seen.engine_running == 1.0


def test_hill_hold_lets_a_car_drive_downhill() -> None:
    drive = rolling(0.0, Ground(1.0, -0.15, 0.0))
    start = drive.hold(1.0, brake=0.5).x_m
    assert drive.hold(1.5, automatic=1, gear=1, throttle=0.2).x_m - start > 0.5


def test_hands_off_at_standstill_the_rim_is_quiet_and_in_bends_it_is_light() -> None:
    drive = Drive(platform())
    torques = [drive.hold(TICK_S, brake=0.3).hand_wheel_torque_nm for _ in range(1000)]
    assert max(torques) - min(torques) < 0.2
    drive = rolling(20.0)
    most = 0.0
    for tick in range(1000):
        seen = drive.hold(TICK_S, automatic=1, gear=1, throttle=0.3, road_wheel_rad=0.04 * math.sin(0.01 * tick))
        most = max(most, abs(seen.hand_wheel_torque_nm))
    print(f"at most {most:.1f} N m")
    assert 1.0 < most < 12.0


@pytest.mark.parametrize(("front_nm", "rear_nm", "locks_first"), [(4800.0, 700.0, "fl"), (1600.0, 2520.0, "rl")])
def test_the_brakes_bias_decides_which_axle_locks_first(front_nm: float, rear_nm: float, locks_first: str) -> None:
    drive = rolling_car(altered(front={"brake_nm": front_nm}, rear={"brake_nm": rear_nm}, aids=NO_AIDS), 25.0)
    for tick in range(400):
        drive.hold(TICK_S, brake=0.0025 * tick, clutch=1.0)
        held = [wheel for wheel in ("fl", "rl") if getattr(drive.state, f"{wheel}_radps") == 0.0]
        if held:
            break
    assert held == [locks_first]


def test_switched_off_anti_lock_locks_the_wheels() -> None:
    for off, locked in ((0.0, False), (1.0, True)):
        drive = rolling(25.0)
        drive.hold(1.0, brake=1.0, clutch=1.0, anti_lock_off=off)
        assert (drive.state.fl_radps == 0.0) == locked


def test_switched_off_traction_control_spins_and_stability_control_stays_away() -> None:
    spins = []
    for off in (0.0, 1.0):
        drive = rolling(3.0, Ground(0.3, 0.0, 0.0))
        drive.hold(1.5, automatic=1, gear=1, throttle=1.0, traction_off=off)
        spins.append(drive.state.fl_radps)
    assert spins[1] > 1.5 * spins[0]
    drive = rolling(25.0, Ground(0.4, 0.0, 0.0))
    drive.hold(1.0, road_wheel_rad=0.3, stability_off=1.0)
    assert drive.state.stability_nm == 0.0
    assert drive.hold(0.2, road_wheel_rad=-0.3).gear == 0.0
    assert drive.state.stability_nm != 0.0, "on again"
