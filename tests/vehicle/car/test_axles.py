"""Contact patches: where they move, and what the tyres' forces add up to."""

import math

import pytest

from simconsole.values.ground import ground_row
from simconsole.vehicle.car.axles import (
    LIGHT_SHARE,
    Axles,
    along_speed,
    inclination,
    kept_share,
    kingpin_moment,
    side_speed,
    tyre_forces,
)
from simconsole.vehicle.car.ground import Grips, on_plane
from simconsole.vehicle.car.state import AidState, BodyState, Car, Gearbox, ShaftState, SteeringState, Wheel
from simconsole.vehicle.car.steering import wheel_directions
from simconsole.vehicle.car.suspension import support, wheel_load
from simconsole.vehicle.car.tyre import tyre
from tests.vehicle.driving import LEVEL
from tests.vehicle.parts import CAR, STEP_S

BODY = BodyState(*(0.0,) * 15)
WHEEL = Wheel(*(0.0,) * 6)
GROUND = ground_row(LEVEL)
FULL = Grips(CAR.front.friction, CAR.front.friction, CAR.rear.friction, CAR.rear.friction)


def forces(body: BodyState, wheel: Wheel, turned_rad: float = 0.0) -> Axles:
    rest = Car(
        body=body,
        steering=SteeringState(turned_rad, 0.0, 0.0, 0.0, 0.0),
        **dict.fromkeys(("fl", "fr", "rl", "rr"), wheel),
        shafts=ShaftState(*(0.0,) * 9),
        box=Gearbox(*(0.0,) * 7),
        aids=AidState(*(0.0,) * 4),
    )
    points = wheel_directions(CAR.steering, turned_rad)
    return tyre_forces(rest, CAR, FULL, on_plane(rest, CAR, GROUND), points, 0.0, STEP_S, tyre, kingpin_moment)


def test_a_car_at_rest_is_pushed_nowhere() -> None:
    still = forces(BODY, WHEEL)
    assert (still.force_x_n, still.front_y_n, still.rear_y_n, still.moment_nm, still.aligning_nm) == (0.0,) * 5


def test_locked_wheels_push_against_the_motion_and_turn_nothing() -> None:
    slid = WHEEL._replace(deflection_x_m=0.1)
    sliding = forces(BODY._replace(vx_mps=10.0), slid)
    most = 2.0 * (CAR.front.friction * CAR.front.static_n + CAR.rear.friction * CAR.rear.static_n)
    assert -most * (1.0 + 1e-12) <= sliding.force_x_n < -0.5 * most
    assert sliding.moment_nm == 0.0


def test_the_mirrored_slide_gives_the_mirrored_forces() -> None:
    spin = WHEEL._replace(radps=10.0 / CAR.front.radius_m)
    left, right = (
        forces(
            BODY._replace(vx_mps=10.0, vy_mps=sign * 0.5, yaw_rate_radps=sign * 0.3),
            spin._replace(deflection_y_m=-sign * 0.01),
            sign * 0.1,
        )
        for sign in (1.0, -1.0)
    )
    assert left.force_x_n == right.force_x_n
    assert left.rear_y_n == -right.rear_y_n < 0.0
    assert left.moment_nm == -right.moment_nm
    assert left.fl.force_y_n == -right.fr.force_y_n


def test_a_turning_body_moves_its_axles_sideways_by_their_distance_apart() -> None:
    turning = BODY._replace(vy_mps=0.7, yaw_rate_radps=0.5)
    front, rear = (side_speed(axle, turning, WHEEL, WHEEL) for axle in (CAR.front, CAR.rear))
    assert front - rear == pytest.approx(0.5 * (CAR.front.ahead_m - CAR.rear.ahead_m))
    assert rear < 0.7 < front
    nodding = BODY._replace(vx_mps=3.0, pitch_radps=0.2)
    straight = CAR.front._replace(support_slope=0.0)
    assert along_speed(straight, nodding, WHEEL, WHEEL, 0.55) == pytest.approx(3.0 - 0.11)


def test_compressed_struts_move_the_patches_along_the_slope_of_their_links() -> None:
    """Forwards in front, backwards at the rear: with the arm with which braking pushes body and wheels apart."""
    sinking = BODY._replace(vx_mps=3.0, heave_mps=-0.1)
    held = WHEEL._replace(radps=0.0)
    lifted = held._replace(lift_mps=0.3)
    for axle, sign in ((CAR.front, 1.0), (CAR.rear, -1.0)):
        assert sign * axle.support_slope > 0.0
        assert along_speed(axle, sinking, held, lifted, 0.55) == pytest.approx(3.0 + axle.support_slope * 0.25)
        assert along_speed(axle, sinking, held, lifted._replace(radps=9.0), 0.55) == 3.0, "it rolls"
        gained = -1000.0 * (along_speed(axle, sinking, held, lifted, 0.55) - 3.0)
        # Apart: against the compression, at both wheels. What the struts get is what the ground gave.
        assert -2.0 * support(axle, -1000.0) * 0.25 == pytest.approx(gained)


def test_rolling_moves_the_patches_with_the_arms_that_the_forces_have() -> None:
    """Power of the side force at the ground is the power that rolls body and axle: no energy out of nothing."""
    axle = CAR.front
    rolling, up, down = BODY._replace(roll_radps=0.4), WHEEL._replace(lift_mps=0.1), WHEEL._replace(lift_mps=-0.1)
    body_only = side_speed(axle, rolling, WHEEL, WHEEL)
    assert body_only == pytest.approx(0.4 * axle.roll_arm_m)
    both = side_speed(axle, rolling, up, down)
    assert both - body_only == pytest.approx(axle.link_arm_m * 0.2 * axle.roll_rad_per_m)


def test_a_wheel_leans_with_body_and_axle_and_not_by_lifting_alike() -> None:
    leaning = BODY._replace(roll_rad=0.05)
    assert inclination(CAR.front, leaning, WHEEL, WHEEL) == pytest.approx(0.05 * (1.0 + CAR.front.camber_gain))
    up = WHEEL._replace(lift_m=0.03)
    assert inclination(CAR.front, leaning, up, up) == inclination(CAR.front, leaning, WHEEL, WHEEL)


def test_the_force_that_a_held_wheel_keeps_does_not_follow_its_load() -> None:
    """The deflection shrinks as the load grows, so that load times deflection stays."""
    axle = CAR.front
    coming = WHEEL._replace(lift_m=-0.002, lift_mps=-0.5)
    share = kept_share(axle, coming, STEP_S)
    now = axle.static_n - axle.carcass_npm * coming.lift_m
    before = axle.static_n - axle.carcass_npm * (coming.lift_m - coming.lift_mps * STEP_S)
    assert share * now == pytest.approx(before)
    assert share < 1.0
    nearly_off = WHEEL._replace(lift_m=(1.0 - 0.5 * LIGHT_SHARE) * axle.static_n / axle.carcass_npm, lift_mps=0.5)
    assert wheel_load(axle, nearly_off._replace(lift_mps=0.0)) > 0.0
    assert kept_share(axle, nearly_off, STEP_S) == 1.0
    assert math.isfinite(kept_share(axle, WHEEL._replace(lift_m=axle.static_n / axle.carcass_npm), STEP_S))
