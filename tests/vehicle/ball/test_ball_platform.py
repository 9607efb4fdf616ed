"""From a ball's profile to a platform: the slope and the grip that its ground gives it."""

import math

import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import BallProfile
from simconsole.values.platform import Ground, Platform, Pose
from simconsole.values.units import STANDARD_GRAVITY_MPS2
from simconsole.vehicle.ball.ball_platform import build_ball
from simconsole.vehicle.ball.ball_step import BallGround, BallParameters, on_plane

PROFILE = load("vehicles", "ball", BallProfile)


def built(ground: Ground, pose: Pose = Pose(0.0, 0.0, 0.0)) -> Platform:  # noqa: B008  # immutable
    return build_ball(PROFILE, pose, ground)


def under(ground: Ground) -> BallGround:
    ball = built(ground)
    return on_plane(0.0, 0.0, BallParameters(*ball.parameters.tolist()), ball.ground)


def test_a_slope_pulls_a_sphere_with_five_sevenths_of_its_weight_along_the_plane() -> None:
    found = under(Ground(1.0, 0.3, -0.4))
    pull = math.hypot(found.gravity_x_mps2, found.gravity_y_mps2)
    assert pull == pytest.approx(5.0 / 7.0 * STANDARD_GRAVITY_MPS2 * math.sin(math.atan(0.5)))
    assert found.gravity_x_mps2 < 0.0 < found.gravity_y_mps2, "down the plane, which rises to x and falls to y"


def test_it_accelerates_and_brakes_no_harder_than_the_ground_grips() -> None:
    dry, ice = under(Ground(1.0, 0.0, 0.0)), under(Ground(0.01, 0.0, 0.0))
    assert (dry.max_accel_mps2, dry.brake_mps2) == (PROFILE.max_accel_mps2, PROFILE.brake_mps2)
    assert ice.max_accel_mps2 == ice.brake_mps2 == pytest.approx(0.01 * STANDARD_GRAVITY_MPS2)


def test_it_stands_where_it_is_put_with_its_heading_within_a_turn() -> None:
    ball = built(Ground(1.0, 0.0, 0.0), Pose(3.0, -2.0, 7.0))
    seen = ball.initial_vehicle
    assert (seen.x_m, seen.y_m, seen.yaw_rad) == (3.0, -2.0, pytest.approx(7.0 - math.tau))
    assert (seen.vx_mps, seen.vy_mps) == (0.0, 0.0)
    assert ball.rear_overhang_m == 0.5 * ball.length_m == PROFILE.radius_m, "base_link is its middle"
