"""Bars, stops, tyres, differential, brakes and air do to the whole car what each is there for."""

import math
from typing import Any

import msgspec
import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.kernels import put
from simconsole.values.platform import Ground, Patch
from simconsole.values.state_vector import PLATFORM_AT
from simconsole.values.units import KMH_PER_MPS, STANDARD_GRAVITY_MPS2
from simconsole.vehicle.car.car_platform import car_parameters
from simconsole.vehicle.car.state import CarState, Wheel
from simconsole.vehicle.car.steering import hand_wheel_torque
from simconsole.vehicle.car.suspension import wheel_load
from simconsole.vehicle.car.tyre import Tyre, tyre
from simconsole.vehicle.platforms import build
from tests.vehicle.driving import LEVEL, ORIGIN, TICK_S, Drive

HATCHBACK = load("vehicles", "hatchback", CarProfile)
WHEELS = ("fl", "fr", "rl", "rr")
NO_AIDS = {"anti_lock": False, "traction_control": False, "stability_control": False, "hill_hold": False}


def altered(**sections: dict[str, Any]) -> CarProfile:
    """Return the hatchback with some values of some sections replaced."""
    parts = {name: msgspec.structs.replace(getattr(HATCHBACK, name), **values) for name, values in sections.items()}
    return msgspec.structs.replace(HATCHBACK, **parts)


def rolling(profile: CarProfile, speed_mps: float, ground: Ground = LEVEL) -> Drive:
    drive = Drive(build(profile, ORIGIN, ground))
    spins = dict.fromkeys([f"{wheel}_radps" for wheel in WHEELS], speed_mps / profile.front.wheel_radius_m)
    put(drive.row, PLATFORM_AT, CarState(*drive.vehicle.initial_state)._replace(vx_mps=speed_mps, **spins))
    return drive


def loads(drive: Drive, profile: CarProfile, ground: Ground = LEVEL) -> dict[str, float]:
    """Return the wheels' loads in N."""
    p = car_parameters(profile, ground)
    state = drive.state
    found = {}
    for wheel in WHEELS:
        axle = p.front if wheel[0] == "f" else p.rear
        values = [getattr(state, f"{wheel}_{name}") for name in Wheel._fields]
        found[wheel] = wheel_load(axle, Wheel(*values))
    return found


def test_anti_roll_bars_take_roll_and_carry_load_to_their_axle() -> None:
    shares, rolls = [], []
    for front_nmprad in (0.0, 60000.0):
        profile = altered(front={"roll_bar_nmprad": front_nmprad})
        drive = rolling(profile, 20.0)
        seen = drive.hold(2.0, clutch=1.0, road_wheel_rad=0.03)
        on = loads(drive, profile)
        shares.append((on["fr"] - on["fl"]) / (on["fr"] - on["fl"] + on["rr"] - on["rl"]))
        rolls.append(seen.roll_rad / seen.ay_mps2)
    print(f"roll {[f'{math.degrees(r * 9.81):.2f}' for r in rolls]} deg/g, front's share of the transfer {shares}")
    assert rolls[1] < 0.7 * rolls[0]
    assert shares[1] > shares[0] + 0.15


def test_bump_stops_end_the_travel() -> None:
    heaves = []
    for stop_npm in (0.0, 90000.0):
        drive = rolling(altered(front={"stop_npm": stop_npm}, rear={"stop_npm": stop_npm}), 0.0)
        put(drive.row, PLATFORM_AT, drive.state._replace(heave_mps=-2.5))
        least = 0.0
        for _ in range(100):
            drive.hold(TICK_S)
            least = min(least, drive.state.heave_m)
        heaves.append(least)
    print(f"thrown down: {heaves[0]:.3f} m without, {heaves[1]:.3f} m with stops")
    assert heaves[0] < heaves[1] - 0.01
    assert heaves[1] < -HATCHBACK.front.travel_m


def test_braking_dives_and_driving_squats() -> None:
    """ISO 8855: pitch is positive nose down."""
    assert rolling(HATCHBACK, 25.0).hold(0.6, brake=0.5, clutch=1.0).pitch_rad > 0.01
    assert rolling(HATCHBACK, 5.0).hold(1.0, automatic=1, gear=1, throttle=1.0).pitch_rad < -0.003


def test_air_lifts_each_axle_by_its_area() -> None:
    speed = 50.0
    found = []
    for front_m2, rear_m2 in ((0.0, 0.0), (0.3, -0.2)):
        body = {"front_lift_area_m2": front_m2, "rear_lift_area_m2": rear_m2, "drag_area_m2": 0.0}
        profile = altered(body=body)
        drive = rolling(profile, speed)
        drive.hold(2.0, clutch=1.0)
        found.append((loads(drive, profile), drive.state.vx_mps))
    pressure = 0.5 * 1.225 * found[1][1] ** 2
    front, rear = (
        sum(found[1][0][w] - found[0][0][w] for w in WHEELS if w[0] == axle) / pressure for axle in ("f", "r")
    )
    print(f"front {front:.3f} m2, rear {rear:.3f} m2")
    assert front == pytest.approx(-0.3, abs=0.01)
    assert rear == pytest.approx(0.2, abs=0.01)


def test_rolling_resistance_is_a_share_of_the_weight() -> None:
    slowed = []
    for share in (0.0, 0.02):
        axle = {"rolling_resistance": share}
        drive = rolling(altered(body={"drag_area_m2": 0.0}, front=axle, rear=axle), 10.0)
        before = drive.hold(0.5, clutch=1.0).vx_mps
        slowed.append(before - drive.hold(2.0, clutch=1.0).vx_mps)
    turning = 2.0 * (2.2 + 2.0) / 2.0 / 0.306**2  # the wheels' inertia at the rim
    expected = 2.0 * 0.02 * STANDARD_GRAVITY_MPS2 * 1300.0 / (1300.0 + turning)
    assert slowed[0] == pytest.approx(0.0, abs=1e-4)
    assert slowed[1] == pytest.approx(expected, rel=0.02)


def test_a_banked_road_loads_the_lower_wheels_and_pulls_the_car_down() -> None:
    ground = Ground(1.0, 0.0, 0.15)  # rises to the left
    drive = rolling(HATCHBACK, 0.0, ground)
    drive.hold(10.0, brake=1.0)
    on = loads(drive, HATCHBACK, ground)
    moment = 1300.0 * STANDARD_GRAVITY_MPS2 * 0.15 / math.hypot(1.0, 0.15) * 0.55
    carried = 0.5 * (1.53 * (on["fr"] - on["fl"]) + 1.51 * (on["rr"] - on["rl"]))
    print(f"{carried:.0f} N m of {moment:.0f} N m, the sway of the body aside")
    assert carried == pytest.approx(moment, rel=0.1)
    assert rolling(HATCHBACK, 20.0, ground).hold(2.0, clutch=1.0).y_m < -0.3


def test_a_limited_slip_differential_drives_off_where_an_open_one_spins() -> None:
    """Ice under the left wheels: an open differential gives the right one no more than the ice gives the left."""
    ice = Patch(-1e3, 1e3, 0.1, 10.0, 0.1)
    speeds = []
    for box in ({"lock_nm": 0.0, "lock_share": 0.0}, {"lock_nm": 100.0, "lock_share": 0.0}, {"lock_share": 0.5}):
        profile = altered(gearbox=box, aids=NO_AIDS)
        drive = Drive(build(profile, ORIGIN, Ground(1.0, 0.0, 0.0, patches=(ice,))))
        speeds.append(drive.hold(4.0, automatic=1, gear=1, throttle=0.4).vx_mps)
    print(f"open {speeds[0]:.2f}, preloaded {speeds[1]:.2f}, by torque {speeds[2]:.2f} m/s")
    assert speeds[1] > 1.1 * speeds[0]
    assert speeds[2] > 1.1 * speeds[0]


@pytest.mark.parametrize(("front_nm", "rear_nm", "locks_first"), [(4800.0, 700.0, "fl"), (1600.0, 2520.0, "rl")])
def test_the_brakes_bias_decides_which_axle_locks_first(front_nm: float, rear_nm: float, locks_first: str) -> None:
    drive = rolling(altered(front={"brake_nm": front_nm}, rear={"brake_nm": rear_nm}, aids=NO_AIDS), 25.0)
    for tick in range(400):
        drive.hold(TICK_S, brake=0.0025 * tick, clutch=1.0)
        held = [wheel for wheel in ("fl", "rl") if getattr(drive.state, f"{wheel}_radps") == 0.0]
        if held:
            break
    assert held == [locks_first]


def test_seven_gears_each_go_in_and_pull_longer() -> None:
    profile = altered(gearbox={"forward": (3.55, 2.2, 1.55, 1.16, 0.92, 0.76, 0.63)})
    speeds = []
    for gear in range(1, 8):
        drive = rolling(profile, 4.0 + 3.0 * gear)
        drive.hold(0.3, clutch=1.0, gear=gear)
        seen = drive.hold(1.0, gear=gear, throttle=0.5)
        assert (seen.gear, seen.gear_fault) == (gear, 0.0)
        speeds.append(seen.vx_mps / seen.engine_radps)
    assert speeds == sorted(speeds)
    assert speeds[6] == pytest.approx(0.306 / (0.63 * 4.05), rel=0.03)


def test_the_engine_brakes_in_gear_and_more_in_a_lower_one() -> None:
    slowed = []
    for gear in (0, 4, 2):
        drive = rolling(HATCHBACK, 15.0)
        drive.hold(0.3, clutch=1.0, gear=gear)
        drive.hold(0.7, gear=gear)
        slowed.append(drive.hold(0.5, gear=gear).ax_mps2)
    print(f"neutral, fourth, second: {slowed} m/s2")
    assert slowed[2] < slowed[1] - 0.1 < slowed[0] - 0.2


def test_assistance_leaves_more_to_the_hands_at_speed() -> None:
    p = car_parameters(HATCHBACK, LEVEL).steering
    torques = [abs(hand_wheel_torque(p, -60.0, 0.0, speed / KMH_PER_MPS)) for speed in (0.0, 50.0, 100.0)]
    assert torques[0] < torques[1] < torques[2] < HATCHBACK.steering.most_nm
    share = HATCHBACK.steering.unassisted_share / HATCHBACK.steering.ratio
    assert torques[0] == pytest.approx(share * 60.0 / (1.0 + share * 60.0 / HATCHBACK.steering.most_nm))


def test_side_force_builds_up_over_the_relaxation_length_and_falls_under_braking() -> None:
    axle = car_parameters(HATCHBACK, LEVEL).front
    speed, slip_angle = 10.0, 0.01

    def force(metres: float, kappa: float) -> Tyre:
        now = Tyre(0.0, 0.0, 0.0, 0.0, 0.0)
        spin = speed * (1.0 + kappa) / axle.radius_m
        for _ in range(round(metres / speed / 1e-3)):
            slip = speed - spin * axle.radius_m
            now = tyre(axle, 1.0, axle.static_n, slip, speed * slip_angle, spin, *now[2:4], 0.0, 1.0, 1e-3)
        return now

    whole = force(5.0, 0.0)
    part = force(HATCHBACK.front.relaxation_y_m, 0.0)
    assert part.deflection_y_m == pytest.approx(whole.deflection_y_m * (1.0 - math.exp(-1.0)), rel=0.015)
    assert part.force_y_n == pytest.approx(whole.force_y_n * (1.0 - math.exp(-1.0)), rel=0.1)  # and a little damping
    braked = force(5.0, -0.12)
    assert braked.force_x_n < -0.8 * axle.static_n
    assert abs(braked.force_y_n) < 0.6 * abs(whole.force_y_n)
