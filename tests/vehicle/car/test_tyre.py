"""Tyre, shafts, engine, gearbox, steering and loads, each by itself and in plain Python."""

import math

import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.signals import Request
from simconsole.values.units import RADPS_PER_RPM
from simconsole.vehicle.car.car_platform import car_parameters
from simconsole.vehicle.car.engine import engine_drive, engine_friction, full_torque
from simconsole.vehicle.car.gearbox import bite, gear_ratio, gearbox_step
from simconsole.vehicle.car.powertrain import Capacity, Inertia, Shafts, braked, solve_shafts
from simconsole.vehicle.car.state import CAR as COLUMNS
from simconsole.vehicle.car.state import Car, CarState, Gearbox, SteeringState, Wheel
from simconsole.vehicle.car.steering import aligning_moment, hand_wheel_torque, rack_rate, wheel_directions
from simconsole.vehicle.car.suspension import wheel_load
from simconsole.vehicle.car.tyre import Tyre, tyre
from tests.vehicle.driving import LEVEL

CAR = car_parameters(load("vehicles", "hatchback", CarProfile), LEVEL)
LOAD_N = CAR.front.static_n
STEP_S = 0.001


def settled(vx: float, vy: float, omega: float, seconds: float = 1.0, load_n: float = LOAD_N) -> Tyre:
    """Return the tyre after sliding steadily; slip velocities follow from the wheel's own."""
    now = Tyre(0.0, 0.0, 0.0, 0.0, 0.0)
    for _ in range(round(seconds / STEP_S)):
        slip = vx - omega * CAR.front.radius_m
        now = tyre(CAR.front, 1.0, load_n, slip, vy, omega, now.deflection_x_m, now.deflection_y_m, 0.0, 1.0, STEP_S)
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
        assert math.hypot(sliding.force_x_n, sliding.force_y_n) == pytest.approx(0.85 * LOAD_N, rel=1e-6)
        assert sliding.force_x_n * direction * vx + sliding.force_y_n * direction * vy < -0.75 * LOAD_N * math.hypot(
            vx, vy
        )
        assert sliding.demand == CAR.front.slide_demand


def test_force_has_its_maximum_before_sliding() -> None:
    speed = 20.0
    forces = [
        abs(settled(speed, 0.0, speed * (1.0 - 0.01 * slip) / CAR.front.radius_m).force_x_n) for slip in range(30)
    ]
    best = forces.index(max(forces))
    assert forces[best] == pytest.approx(LOAD_N, rel=0.01)
    assert 9 <= best <= 13, "two over the slip stiffness of 18"
    assert forces[-1] == pytest.approx(0.85 * LOAD_N, rel=1e-6)


def test_more_load_gives_more_force_but_less_per_load() -> None:
    once, twice = (settled(20.0, 8.0, 0.0, load_n=n * LOAD_N).force_y_n for n in (1.0, 2.0))
    assert twice / once == pytest.approx(2.0 * (1.0 - 0.08), rel=1e-6)


def test_a_tyre_in_the_air_gives_no_force() -> None:
    assert settled(20.0, 3.0, 10.0, load_n=0.0)[:2] == (0.0, 0.0)


def test_camber_pulls_to_the_lean_only_when_rolling() -> None:
    """ISO 8855: a lean to the right is positive, a force to the right negative."""
    omega = 20.0 / CAR.front.radius_m
    for lean in (0.1, -0.1):
        rolling = standing = Tyre(0.0, 0.0, 0.0, 0.0, 0.0)
        for _ in range(1000):
            rolling = tyre(CAR.front, 1.0, LOAD_N, 0.0, 0.0, omega, *rolling[2:4], lean, 1.0, STEP_S)
            standing = tyre(CAR.front, 1.0, LOAD_N, 0.0, 0.0, 0.0, *standing[2:4], lean, 1.0, STEP_S)
        assert rolling.force_y_n == pytest.approx(-12.0 * LOAD_N * 0.05 * lean, rel=0.02)
        assert standing.force_y_n == 0.0


def test_rolling_backwards_is_rolling_forwards_turned_round() -> None:
    forwards = settled(5.0, 0.2, 5.0 / CAR.front.radius_m)
    backwards = settled(-5.0, 0.2, -5.0 / CAR.front.radius_m)
    assert forwards.force_y_n == backwards.force_y_n < 0.0


def test_standing_tyre_is_a_spring_that_keeps_its_force() -> None:
    pushed = tyre(CAR.front, 1.0, LOAD_N, 0.0, 0.0, 0.0, 0.001, 0.0, 0.0, 1.0, STEP_S)
    later = pushed
    for _ in range(10_000):
        later = tyre(
            CAR.front, 1.0, LOAD_N, 0.0, 0.0, 0.0, later.deflection_x_m, later.deflection_y_m, 0.0, 1.0, STEP_S
        )
    assert later.force_x_n == pushed.force_x_n > 250.0


def inertia(kgm2: float) -> Inertia:
    return Inertia(kgm2, 1.0 / kgm2)


def shafts(
    engine: float, left: float, right: float, ratio: float, capacities: tuple[float, float, float], lock: float = 0.0
) -> Shafts:
    friction, clutch, brake = capacities
    before = Shafts(engine, left, right, 0.0, 0.0, 0.0, 0.0, 0.0)
    return solve_shafts(before, ratio, inertia(0.2), inertia(1.0), Capacity(friction, clutch, brake, brake, lock, 0.0))


def test_slipping_clutch_conserves_momentum_and_serves_both_wheels() -> None:
    after = shafts(200.0, 0.0, 3.0, 10.0, (0.0, 0.3, 0.0))
    assert after.clutch_impulse_nms == 0.3
    assert 0.2 * (200.0 - after.engine_radps) == pytest.approx(0.3)
    assert after.left_radps == pytest.approx(5.0 * 0.3)
    assert after.right_radps - 3.0 == pytest.approx(5.0 * 0.3), "the open differential halves the torque"


def test_closed_clutch_brings_engine_and_mean_wheel_to_one_speed() -> None:
    after = shafts(200.0, 8.0, 12.0, 10.0, (0.0, 1e6, 0.0))
    assert after.engine_radps == pytest.approx(5.0 * (after.left_radps + after.right_radps), rel=1e-12)
    assert after.right_radps - after.left_radps == pytest.approx(4.0)
    momentum = 0.2 * after.engine_radps * 10.0 + after.left_radps + after.right_radps
    assert momentum == pytest.approx(0.2 * 200.0 * 10.0 + 20.0)


def test_lock_brings_both_wheels_together_as_far_as_it_can() -> None:
    slipping = shafts(0.0, 2.0, 6.0, 0.0, (0.0, 0.0, 0.0), lock=0.5)
    assert (slipping.left_radps, slipping.right_radps) == pytest.approx((2.5, 5.5))
    locked = shafts(0.0, 2.0, 6.0, 0.0, (0.0, 0.0, 0.0), lock=50.0)
    assert (locked.left_radps, locked.right_radps) == pytest.approx((4.0, 4.0))


def test_brake_stops_at_exactly_zero_and_never_turns_a_wheel_back() -> None:
    assert shafts(0.0, 0.5, -0.7, 0.0, (0.0, 0.0, 100.0))[1:3] == (0.0, 0.0)
    assert shafts(0.0, 0.5, 0.1, 0.0, (0.0, 0.0, 0.2)).left_radps == pytest.approx(0.3)
    assert braked(0.3, 0.5, 1.0) == 0.0
    assert braked(-5.0, 0.5, 1.0) == -4.5


def test_parked_in_gear_the_shafts_converge_to_rest_under_load() -> None:
    state = Shafts(*(0.0,) * 8)
    most = Capacity(0.05, 0.28, 0.0, 0.0, 0.0, 0.0)
    for _ in range(300):
        pushed = state._replace(left_radps=state.left_radps - 0.125, right_radps=state.right_radps - 0.125)
        state = solve_shafts(pushed, 14.0, inertia(0.16), inertia(1.1), most)
    assert abs(state.left_radps) < 1e-12
    assert state.clutch_impulse_nms == pytest.approx(0.25 * 1.1 / 14.0)


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
    box = Gearbox(3.0, 0.0, 1.0, 3.0, 0.0, 1.0, 0.0)
    request = Request(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert gearbox_step(CAR.gears, box, request, 150.0, 20.0, 6.0, STEP_S).gear == 0.0
    assert gearbox_step(CAR.gears, box, request._replace(gear=4.0), 150.0, 20.0, 6.0, STEP_S).gear == 4.0


def test_automatic_taking_over_in_neutral_at_speed_finds_the_gear() -> None:
    box = Gearbox(0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0)
    request = Request(0.0, 0.3, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0)
    shifting = gearbox_step(CAR.gears, box, request, 84.0, 25.0 / 0.306, 25.0, STEP_S)
    assert shifting.wanted_gear == 4.0, "3065 rpm, where fifth would have 2460 and third 4040"
    assert shifting.lever_adopted == 0.0


def turned(command: float, ticks: int, start: float = 0.0, moment: float = 0.0, friction: float = 0.0) -> float:
    """Return the rack's angle after `ticks` of 1 ms."""
    rack = SteeringState(start, 0.0, 0.0)
    settings = CAR.steering._replace(friction_rad=friction)
    for _ in range(ticks):
        angle = rack.road_wheel_rad + STEP_S * rack.road_wheel_radps
        rack = SteeringState(angle, rack_rate(settings, rack._replace(road_wheel_rad=angle), command, moment), 0.0)
    return rack.road_wheel_rad


def test_steering_has_lag_rate_and_stop() -> None:
    assert turned(0.01, 41) == pytest.approx(0.01 * (1.0 - 3.0 * math.exp(-2.0)), rel=0.06)
    assert turned(0.01, 400) == pytest.approx(0.01, rel=1e-6)
    assert turned(0.6, 300) - turned(0.6, 200) == pytest.approx(0.1 * math.radians(70.0))
    assert turned(5.0, 3000) == pytest.approx(math.radians(36.0))


def test_friction_holds_the_rack_and_tyres_bend_it() -> None:
    assert turned(0.0009, 5000, friction=0.001) == 0.0
    assert turned(0.0011, 5000, friction=0.001) > 0.0
    assert turned(0.1, 1000, moment=-100.0) == pytest.approx(0.1 - math.radians(0.25), rel=1e-3)


def test_inner_wheel_turns_further() -> None:
    points = wheel_directions(CAR.steering._replace(ackermann=0.5 * 1.53 / 2.6), 0.4)
    inner, outer = (math.atan2(points.left_sin, points.left_cos), math.atan2(points.right_sin, points.right_cos))
    assert inner > 0.4 > outer
    assert 1.0 / math.tan(outer) - 1.0 / math.tan(inner) == pytest.approx(1.53 / 2.6)


def test_moment_of_the_tyres_centres_and_fades_before_the_force_does() -> None:
    moments = []
    for slip in range(0, 40):
        t = settled(20.0, 20.0 * 0.005 * slip, 20.0 / CAR.front.radius_m, 0.3)
        moments.append(aligning_moment(CAR.steering, t.force_y_n, t.demand, 20.0))
    assert moments[0] == 0.0
    assert max(moments) > 0.0
    assert moments.index(max(moments)) * 0.005 < 0.7 * 2.0 / 12.0, "the force has its maximum at 2 / 12"
    assert moments[-1] < 0.8 * max(moments)
    assert aligning_moment(CAR.steering, 3000.0, 0.2, -20.0) > aligning_moment(CAR.steering, 3000.0, 0.2, 20.0)


def test_torque_at_the_rim_is_odd_and_bends_towards_its_most() -> None:
    for moment in (10.0, 100.0, 1000.0):
        torque = hand_wheel_torque(CAR.steering, moment, 0.0, 20.0)
        assert 0.0 < torque < 1.0 / CAR.steering.per_hand_torque_most_nm
        assert torque == -hand_wheel_torque(CAR.steering, -moment, 0.0, 20.0)
        assert torque > hand_wheel_torque(CAR.steering, moment, 0.0, 0.0)
        assert torque > hand_wheel_torque(CAR.steering, moment, 0.1, 20.0), "friction and damping oppose the turning"


def test_wheel_loads_at_rest_carry_the_car_and_no_tyre_pulls() -> None:
    rest = Wheel(*(0.0,) * 6)
    loads = 2.0 * (wheel_load(CAR.front, rest) + wheel_load(CAR.rear, rest))
    assert loads == pytest.approx(CAR.body.mass_kg * 9.80665)
    assert wheel_load(CAR.front, rest) == pytest.approx(0.3 * CAR.body.mass_kg * 9.80665)
    assert wheel_load(CAR.front, rest._replace(lift_m=0.1)) == 0.0


def test_columns_are_the_groups_one_after_the_other() -> None:
    names: list[str] = []
    for name, group in Car.__annotations__.items():
        prefix = f"{name}_" if group is Wheel else ""
        names += [prefix + field for field in group._fields]
    assert tuple(names) == CarState._fields
    assert len(names) == COLUMNS.width
