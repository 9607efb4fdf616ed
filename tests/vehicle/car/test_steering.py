"""The rack by itself, and the torque at the rim: what the hands are told of the tyres, on the whole car."""

import math
from itertools import pairwise

import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.platform import Ground
from simconsole.values.units import KMH_PER_MPS
from simconsole.vehicle.car.car_platform import car_parameters
from simconsole.vehicle.car.state import SteeringState
from simconsole.vehicle.car.steering import (
    aligning_moment,
    hand_wheel_torque,
    patch_twist,
    rack_rate,
    rim_friction,
    turn_slip_moment,
    wheel_directions,
)
from tests.vehicle.altered import HATCHBACK
from tests.vehicle.driving import TICK_S, Drive, platform
from tests.vehicle.parts import CAR, LOAD_N, STEP_S, settled
from tests.vehicle.rolling import rolling


@pytest.mark.parametrize("speed_mps", [3.0, 15.0, 30.0])
def test_it_turns_the_wheel_back_to_the_middle_and_is_mirrored(speed_mps: float) -> None:
    angle = min(0.2, 3.0 * 2.6 / speed_mps**2)  # 3 m/s2
    left, right = (rolling(speed_mps).hold(1.5, clutch=1.0, road_wheel_rad=sign * angle) for sign in (1.0, -1.0))
    print(f"{speed_mps:.0f} m/s: {left.hand_wheel_torque_nm:.2f} N m at {left.ay_mps2:.1f} m/s2")
    assert left.ay_mps2 > 0.0
    assert left.hand_wheel_torque_nm < -0.3
    assert right.hand_wheel_torque_nm == -left.hand_wheel_torque_nm


def test_it_falls_before_the_front_tyres_have_given_all_they_have() -> None:
    drive = rolling(20.0, stability_control=False)
    torques, forces = [], []
    for tick in range(round(10.0 / TICK_S)):  # all is given after 9.5 s
        drive.hold(TICK_S, automatic=1, gear=1, throttle=0.35, road_wheel_rad=0.02 * tick * TICK_S)
        torques.append(abs(drive.seen.hand_wheel_torque_nm))
        forces.append(abs(drive.seen.ay_mps2))
    felt, full = torques.index(max(torques)), forces.index(max(forces))
    at_full = torques[full]
    print(
        f"most {max(torques):.1f} N m at {forces[felt]:.1f} m/s2, {at_full:.1f} N m at the most, {max(forces):.1f} m/s2"
    )
    assert felt * TICK_S < full * TICK_S - 0.3
    assert forces[felt] < 0.97 * max(forces)
    # Friction at the rim is in both, and assistance flattens what the rack feels: the fall itself must be felt. Hands
    # tell a tenth of the torque they hold, at most 0.3 N m here.
    assert max(torques) - at_full > 0.3


@pytest.mark.parametrize("brake", [0.0, 0.5])
@pytest.mark.parametrize("slope", [0.0, 0.1])
def test_hands_off_it_does_not_chatter_at_standstill(brake: float, slope: float) -> None:
    """On a level road with no brake, on a slope held by brake or hand brake, engine running, after a stop."""
    drive = rolling(5.0, Ground(1.0, slope, 0.05 * slope))
    held = {"brake": brake} if brake else {"handbrake": 1.0 if slope else 0.0}
    drive.hold(3.0, brake=0.5, clutch=1.0, road_wheel_rad=0.1)
    drive.hold(3.0, road_wheel_rad=0.1, **held)
    torques = [drive.hold(TICK_S, road_wheel_rad=0.1, **held).hand_wheel_torque_nm for _ in range(1000)]
    print(f"peak to peak {max(torques) - min(torques):.2g} N m")
    assert max(torques) - min(torques) < 0.2


def test_it_stays_light_when_parking_and_in_town() -> None:
    drive = Drive(platform())
    most = 0.0
    for tick in range(round(6.0 / TICK_S)):  # lock to lock on the spot
        drive.hold(TICK_S, brake=0.4, road_wheel_rad=0.6 * math.sin(0.5 * math.pi * tick * TICK_S))
        most = max(most, abs(drive.seen.hand_wheel_torque_nm))
    print(f"on the spot at most {most:.1f} N m")
    town = rolling(12.0)
    for tick in range(round(8.0 / TICK_S)):  # 5 m/s2 to both sides
        town.hold(TICK_S, automatic=1, gear=1, throttle=0.2, road_wheel_rad=0.09 * math.sin(tick * TICK_S))
        most = max(most, abs(town.seen.hand_wheel_torque_nm))
    print(f"in town too at most {most:.1f} N m")
    assert most < 12.0


def turned(command: float, ticks: int, start: float = 0.0, moment: float = 0.0, friction: float = 0.0) -> float:
    """Return the rack's angle after `ticks` of 1 ms."""
    rack = SteeringState(start, 0.0, 0.0, 0.0, 0.0)
    settings = CAR.steering._replace(friction_rad=friction)
    for _ in range(ticks):
        angle = rack.road_wheel_rad + STEP_S * rack.road_wheel_radps
        moved = rack._replace(road_wheel_rad=angle)
        rack = moved._replace(road_wheel_radps=rack_rate(settings, moved, command, moment))
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
        torque = hand_wheel_torque(CAR.steering, moment, 0.0, 20.0, 0.0)
        assert 0.0 < torque < 1.0 / CAR.steering.per_hand_torque_most_nm
        assert torque == -hand_wheel_torque(CAR.steering, -moment, 0.0, 20.0, 0.0)
        assert torque > hand_wheel_torque(CAR.steering, moment, 0.0, 0.0, 0.0)
        assert torque > hand_wheel_torque(CAR.steering, moment, 0.1, 20.0, 0.0), "damping opposes the turning"
        assert torque - hand_wheel_torque(CAR.steering, moment, 0.0, 20.0, -1.0) == pytest.approx(0.5), "friction too"


def test_assistance_leaves_more_to_the_hands_at_speed() -> None:
    p = car_parameters(HATCHBACK).steering
    torques = [abs(hand_wheel_torque(p, -60.0, 0.0, speed / KMH_PER_MPS, 0.0)) for speed in (0.0, 50.0, 100.0)]
    assert torques[0] < torques[1] < torques[2] < HATCHBACK.steering.most_nm


@pytest.mark.parametrize("speed_mps", [0.0, 28.0])
def test_about_the_centre_the_assistance_leaves_all_and_of_much_its_share(speed_mps: float) -> None:
    s = HATCHBACK.steering
    p = car_parameters(HATCHBACK).steering._replace(per_hand_torque_most_nm=0.0)
    slopes = [
        (hand_wheel_torque(p, moment + 1.0, 0.0, speed_mps, 0.0) - hand_wheel_torque(p, moment, 0.0, speed_mps, 0.0))
        * s.ratio
        for moment in (0.0, 1e5)
    ]
    left = s.unassisted_share + (s.unassisted_share_at_100kmh - s.unassisted_share) * speed_mps * KMH_PER_MPS / 100.0
    assert slopes[0] == pytest.approx(1.0, rel=0.02)
    assert slopes[1] == pytest.approx(left, rel=0.02)


def turned_on_the_spot(angles_rad: list[float], name: str = "hatchback", friction: float = 1.0) -> list[float]:
    """Return the moment of both front tyres about their kingpins at each angle, wheels held by the brake."""
    p = car_parameters(load("vehicles", name, CarProfile))
    moments, twist, before = [], 0.0, 0.0
    for angle in angles_rad:
        twist, before = patch_twist(twist, angle - before, 0.0), angle
        moments.append(2.0 * turn_slip_moment(p.steering, twist, friction * p.front.friction * p.front.static_n, 0.0))
    return moments


def test_on_the_spot_the_moment_grows_to_that_of_gough_and_keeps_its_side_until_turned_back() -> None:
    there = [0.01 * n for n in range(40)]
    moments = turned_on_the_spot(there + there[::-1])
    load, inflation = 0.5 * 0.6 * 1300.0 * 9.80665, 220e3
    gough = 2.0 * HATCHBACK.front.friction * load**1.5 / (3.0 * math.sqrt(inflation))
    assert moments[39] == pytest.approx(-gough, rel=0.02)
    assert moments[-1] == pytest.approx(gough, rel=0.02), "back at the centre it pushes the other way: hysteresis"
    assert all(after <= before for before, after in pairwise(moments[:40]))
    assert min(turned_on_the_spot(there, friction=0.5)) == pytest.approx(0.5 * min(moments))
    assert turned_on_the_spot([-angle for angle in there]) == [-moment for moment in moments[:40]]


def test_rolling_and_sliding_patches_have_little_to_twist_against() -> None:
    p = CAR.steering
    twist = 0.0
    for _ in range(1000):  # a circle of 8 m
        twist = patch_twist(twist, 0.001 / 8.0, 0.001)
    assert twist == pytest.approx(0.06 / 8.0, rel=0.02)
    assert turn_slip_moment(p, 0.2, LOAD_N, 2.0) == 0.0
    assert abs(turn_slip_moment(p, twist, LOAD_N, 0.3)) < 0.15 * abs(turn_slip_moment(p, 0.2, LOAD_N, 0.0))


def test_friction_at_the_rim_is_hysteresis_at_any_rate_and_stays_at_rest() -> None:
    p = CAR.steering
    for step_rad in (1e-6, 1e-4):
        share = 0.0
        for _ in range(round(0.03 / step_rad)):
            share = rim_friction(p, share, step_rad)
        assert share == pytest.approx(-1.0, abs=0.01)
        assert rim_friction(p, share, 0.0) == share
        for _ in range(round(0.03 / step_rad)):
            share = rim_friction(p, share, -step_rad)
        assert share == pytest.approx(1.0, abs=0.01)


def test_parked_the_rim_is_as_heavy_as_with_assistance_and_light_without_friction() -> None:
    torques = {}
    for friction in (1.0, 0.1):
        drive = Drive(platform(ground=Ground(friction, 0.0, 0.0)))
        drive.hold(3.0, brake=0.4, road_wheel_rad=0.3)
        torques[friction] = -drive.seen.hand_wheel_torque_nm
    assert 2.0 < torques[1.0] < 5.0
    assert torques[0.1] < 0.6 * torques[1.0]
