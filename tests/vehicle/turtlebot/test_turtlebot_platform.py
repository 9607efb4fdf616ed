"""From a robot's profile to a platform."""

import math

import numpy as np
import pytest

from simconsole.profiles.files.loader import load, parse, profiles_folder
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.values.errors import ProfileError
from simconsole.values.platform import NO_OBSTACLES, Ground, Obstacles, Pose
from simconsole.vehicle.turtlebot.robot_state import OBSTACLES_AT, PARAMETERS, RobotParameters
from simconsole.vehicle.turtlebot.turtlebot_platform import build_turtlebot

PROFILE = load("vehicles", "turtlebot3_waffle", TurtlebotProfile)
LEVEL = Ground(1.0, 0.0, 0.0)


def test_it_stands_where_it_is_put_and_its_odometry_begins_at_0() -> None:
    robot = build_turtlebot(PROFILE, Pose(3.0, -2.0, 7.0), LEVEL, NO_OBSTACLES)
    seen = robot.initial_vehicle
    assert (seen.x_m, seen.y_m, seen.yaw_rad) == (3.0, -2.0, pytest.approx(7.0 - math.tau))
    state = dict(zip(PARAMETERS.names, robot.parameters, strict=True))
    assert state["separation_m"] == 0.287
    assert robot.turns_in_place
    assert robot.rear_overhang_m == pytest.approx(0.064 + 0.1405), "its body lies behind its wheels"


def test_obstacles_lie_behind_the_parameters() -> None:
    obstacles = Obstacles(segments=((0.0, 1.0, 2.0, 3.0),), circles=((4.0, 5.0, 6.0), (7.0, 8.0, 9.0)))
    row = build_turtlebot(PROFILE, Pose(0.0, 0.0, 0.0), LEVEL, obstacles).parameters
    assert row[OBSTACLES_AT:].tolist() == list(map(float, range(10)))
    assert RobotParameters(*row[:OBSTACLES_AT].tolist())[-2:] == (1.0, 2.0)


def test_it_accelerates_no_harder_than_the_floor_grips() -> None:
    ice = build_turtlebot(PROFILE, Pose(0.0, 0.0, 0.0), Ground(0.01, 0.0, 0.0), NO_OBSTACLES)
    found = RobotParameters(*ice.parameters.tolist())
    assert found.accel_mps2 == found.brake_mps2 == pytest.approx(0.0980665)


def test_slip_is_drawn_from_the_profiles_seed() -> None:
    text = (profiles_folder() / "vehicles" / "turtlebot3_waffle.yaml").read_text()
    made = [
        build_turtlebot(
            parse(f"{text}odometry: {{seed: {seed}}}\n", VehicleProfile, "f.yaml"),  # type: ignore[arg-type]  # a union
            Pose(0.0, 0.0, 0.0), LEVEL, NO_OBSTACLES,
        ).initial_state
        for seed in (1, 2, 1)
    ]  # fmt: skip
    assert made[0] == made[2] != made[1]
    assert np.isfinite(made).all()


@pytest.mark.parametrize(
    ("written", "instead", "told"),
    [
        ("wheel_radius_m: 0.033", "wheel_radius_m: 0", "wheel_radius_m: value 0"),
        ("min_m: 0.12 ", "min_m: 4.0 ", "lidar.*min_m 4.0 must be below max_m 3.5"),
        ("empty_v: 9.6", "empty_v: 13", "battery.*empty_v 13.0 must be below full_v 12.6"),
        ("max_speed_mps: 0.26", "top_speed_mps: 0.26", "top_speed_mps"),
        ("samples: 360", "samples: 3", "lidar.samples: value 3"),
    ],
)
def test_contradictions_are_refused_by_file_and_key(written: str, instead: str, told: str) -> None:
    text = (profiles_folder() / "vehicles" / "turtlebot3_waffle.yaml").read_text()
    assert written in text
    with pytest.raises(ProfileError, match=f"^mine.yaml: .*{told}"):
        parse(text.replace(written, instead), VehicleProfile, "mine.yaml")  # type: ignore[arg-type]  # a union
