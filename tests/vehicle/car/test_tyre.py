"""The tyre by itself and in plain Python."""

import math

import pytest

from simconsole.vehicle.car.car_platform import car_parameters
from simconsole.vehicle.car.tyre import Tyre, tyre
from tests.vehicle.altered import HATCHBACK
from tests.vehicle.parts import CAR, LOAD_N, STEP_S, settled


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


def test_side_force_builds_up_over_the_relaxation_length_and_falls_under_braking() -> None:
    axle = car_parameters(HATCHBACK).front
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
