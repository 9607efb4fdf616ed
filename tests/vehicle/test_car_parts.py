"""Tyre, shafts, engine, gearbox, steering and loads, each by itself and in plain Python."""

import math

import pytest

from simconsole.profile_files import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.signals import Request
from simconsole.units import RADPS_PER_RPM
from simconsole.vehicle.car.assembly import car_parameters
from simconsole.vehicle.car.body import front_load
from simconsole.vehicle.car.engine import engine_drive, engine_friction, full_torque
from simconsole.vehicle.car.gearbox import Gearbox, bite, gear_ratio, work_gearbox
from simconsole.vehicle.car.powertrain import Shafts, braked, solve_shafts
from simconsole.vehicle.car.steering import hand_wheel_torque, steer
from simconsole.vehicle.car.tyre import Tyre, tyre

from .driving import LEVEL

CAR = car_parameters(load("vehicles", "hatchback", CarProfile), LEVEL)
LOAD_N = 7000.0
STEP_S = 0.001


def settled(vx: float, vy: float, omega: float, seconds: float = 1.0) -> Tyre:
    """Return the tyre after sliding steadily; slip velocities follow from the wheel's own."""
    now = Tyre(0.0, 0.0, 0.0, 0.0, 1.0)
    for _ in range(round(seconds / STEP_S)):
        slip = vx - omega * CAR.front.radius_m
        now = tyre(CAR.front, LOAD_N, slip, vy, omega, now.deflection_x_m, now.deflection_y_m, STEP_S)
    return now


def test_small_slip_gives_the_stated_stiffness() -> None:
    speed = 20.0
    omega = speed / CAR.front.radius_m
    slip_angle = 0.002
    side = settled(speed, speed * slip_angle, omega)
    assert side.force_y_n == pytest.approx(-12.0 * LOAD_N * slip_angle, rel=0.03)
    drive = settled(speed, 0.0, omega * 1.002)
    assert drive.force_x_n == pytest.approx(18.0 * LOAD_N * 0.002, rel=0.03)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_force_is_limited_and_opposes_sliding_in_both_directions(direction: float) -> None:
    for vx, vy in [(10.0, 0.0), (0.0, 5.0), (7.0, 7.0)]:
        sliding = settled(direction * vx, direction * vy, 0.0)
        assert math.hypot(sliding.force_x_n, sliding.force_y_n) == pytest.approx(LOAD_N, rel=1e-6)
        assert sliding.force_x_n * direction * vx + sliding.force_y_n * direction * vy < -0.9 * LOAD_N * math.hypot(
            vx, vy
        )
        assert sliding.grip == pytest.approx(0.0, abs=1e-9)


def test_rolling_backwards_is_rolling_forwards_turned_round() -> None:
    forwards = settled(5.0, 0.2, 5.0 / CAR.front.radius_m)
    backwards = settled(-5.0, 0.2, -5.0 / CAR.front.radius_m)
    assert forwards.force_y_n == backwards.force_y_n < 0.0


def test_standing_tyre_is_a_spring_that_keeps_its_force() -> None:
    pushed = tyre(CAR.front, LOAD_N, 0.0, 0.0, 0.0, 0.001, 0.0, STEP_S)
    later = pushed
    for _ in range(10_000):
        later = tyre(CAR.front, LOAD_N, 0.0, 0.0, 0.0, later.deflection_x_m, later.deflection_y_m, STEP_S)
    assert later.force_x_n == pushed.force_x_n > 400.0


def shafts(engine: float, wheel: float, ratio: float, capacities: tuple[float, float, float]) -> Shafts:
    return solve_shafts(engine, wheel, ratio, 0.2, 2.0, *capacities, 0.0, 0.0, 0.0)


def test_slipping_clutch_conserves_momentum() -> None:
    after = shafts(200.0, 0.0, 10.0, (0.0, 0.3, 0.0))
    assert after.clutch_impulse_nms == 0.3
    assert 0.2 * (200.0 - after.engine_radps) == pytest.approx(0.3)
    assert 2.0 * after.wheel_radps == pytest.approx(10.0 * 0.3)


def test_closed_clutch_brings_both_to_one_speed() -> None:
    after = shafts(200.0, 10.0, 10.0, (0.0, 1e6, 0.0))
    assert after.engine_radps == pytest.approx(10.0 * after.wheel_radps, rel=1e-12)
    momentum = 0.2 * after.engine_radps * 10.0 + 2.0 * after.wheel_radps
    assert momentum == pytest.approx(0.2 * 200.0 * 10.0 + 2.0 * 10.0)


def test_brake_stops_at_exactly_zero_and_never_turns_a_wheel_back() -> None:
    assert shafts(0.0, 0.5, 0.0, (0.0, 0.0, 100.0)).wheel_radps == 0.0
    assert shafts(0.0, 0.5, 0.0, (0.0, 0.0, 0.4)).wheel_radps == pytest.approx(0.3)
    assert braked(0.3, 2.0, 1.0) == 0.0
    assert braked(-5.0, 2.0, 1.0) == -4.5


def test_parked_in_gear_the_shafts_converge_to_rest_under_load() -> None:
    state = Shafts(0.0, 0.0, 0.0, 0.0, 0.0)
    for _ in range(300):
        state = solve_shafts(
            state.engine_radps, state.wheel_radps - 0.25, 14.0, 0.16, 2.2, 0.05, 0.28, 0.0, *tuple(state)[2:]
        )
    assert abs(state.wheel_radps) < 1e-12
    assert state.clutch_impulse_nms == pytest.approx(0.25 * 2.2 / 14.0)


def test_full_throttle_torque_goes_through_the_points_of_the_profile() -> None:
    for rpm, torque in [(1000, 95), (2000, 130), (4000, 152), (6000, 133)]:
        assert full_torque(CAR.engine, rpm * RADPS_PER_RPM) == pytest.approx(torque)
    beyond = 6700 * RADPS_PER_RPM
    assert full_torque(CAR.engine, beyond) == -engine_friction(CAR.engine, beyond)


def test_idle_is_an_equilibrium_and_the_dead_engine_needs_an_open_driveline() -> None:
    idle = CAR.engine.idle_radps
    drive = engine_drive(CAR.engine, idle, 1.0, 0.0, False)
    assert drive.torque_nm == drive.friction_nm
    assert engine_drive(CAR.engine, 0.9 * idle, 1.0, 0.0, False).torque_nm > drive.torque_nm
    assert engine_drive(CAR.engine, 1.1 * idle, 1.0, 0.0, False).torque_nm < drive.friction_nm
    assert engine_drive(CAR.engine, 10.0, 1.0, 1.0, False).running == 0.0
    assert engine_drive(CAR.engine, 10.0, 0.0, 1.0, False).torque_nm == 0.0
    cranked = engine_drive(CAR.engine, 10.0, 0.0, 0.0, True)
    assert cranked.torque_nm > cranked.friction_nm
    assert cranked.running == 0.0
    assert engine_drive(CAR.engine, CAR.engine.fire_radps, 0.0, 0.0, True).running == 1.0


def test_full_throttle_and_none_are_linear_in_between() -> None:
    for rpm in (900.0, 2500.0, 5000.0):
        speed = rpm * RADPS_PER_RPM
        none, half, full = (engine_drive(CAR.engine, speed, 1.0, t, False).torque_nm for t in (0.0, 0.5, 1.0))
        assert half == pytest.approx(0.5 * (none + full))
        assert full - engine_friction(CAR.engine, speed) == pytest.approx(full_torque(CAR.engine, speed))


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
    box = Gearbox(3.0, 0.0, 1.0, 3.0, 0.0, 1.0)
    request = Request(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
    assert work_gearbox(CAR.gears, box, request, 150.0, 20.0, 6.0, STEP_S).gear == 0.0
    assert work_gearbox(CAR.gears, box, request._replace(gear=4.0), 150.0, 20.0, 6.0, STEP_S).gear == 4.0


def test_automatic_taking_over_in_neutral_at_speed_finds_the_gear() -> None:
    box = Gearbox(0.0, 1.0, 1.0, 0.0, 0.0, 1.0)
    request = Request(0.0, 0.3, 0.0, 0.0, 0.0, 1.0, 1.0)
    shifting = work_gearbox(CAR.gears, box, request, 84.0, 25.0 / 0.306, 25.0, STEP_S)
    assert shifting.wanted_gear == 4.0, "3065 rpm, where fifth would have 2460 and third 4040"
    assert shifting.lever_adopted == 0.0


def test_steering_has_lag_rate_and_stop() -> None:
    angle = 0.0
    for _ in range(40):
        angle = steer(CAR.body, angle, 0.01, STEP_S)
    assert angle == pytest.approx(0.01 * (1 - math.exp(-1.0)), rel=0.03)
    assert steer(CAR.body, 0.0, 0.6, STEP_S) == pytest.approx(math.radians(70.0) * STEP_S)
    for _ in range(3000):
        angle = steer(CAR.body, angle, 5.0, STEP_S)
    assert angle == pytest.approx(math.radians(36.0))


def test_torque_at_the_rim_centres_and_fades_with_grip() -> None:
    rolling = hand_wheel_torque(CAR.body, 3000.0, 0.9, 20.0, 0.0)
    assert rolling < 0.0
    assert rolling == -hand_wheel_torque(CAR.body, -3000.0, 0.9, 20.0, 0.0)
    assert rolling < hand_wheel_torque(CAR.body, 3000.0, 0.1, 20.0, 0.0) < 0.0
    assert hand_wheel_torque(CAR.body, 3000.0, 0.9, -20.0, 0.0) > rolling


def test_axle_loads_balance_and_never_vanish() -> None:
    total = CAR.body.mass_kg * 9.80665
    assert front_load(CAR.body, 0.0) == pytest.approx(0.6 * total)
    assert front_load(CAR.body, -9.0) == pytest.approx((0.6 + 9.0 / 9.80665 * 0.55 / 2.6) * total)
    assert front_load(CAR.body, 1000.0) == pytest.approx(0.05 * total)
