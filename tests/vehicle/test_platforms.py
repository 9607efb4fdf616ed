"""Profiles to platforms: the shipped ones, and what contradictions are refused with."""

import subprocess
import sys

import pytest

from simconsole.profiles.files.loader import load, names, parse, profiles_folder
from simconsole.profiles.vehicle import BallProfile, CarProfile, VehicleProfile
from simconsole.values.errors import ProfileError
from simconsole.values.layout import Part
from simconsole.values.platform import Pose
from simconsole.vehicle.platforms import build
from tests.vehicle.driving import LEVEL, Drive, platform


def hatchback() -> CarProfile:
    return load("vehicles", "hatchback", CarProfile)


def test_every_shipped_vehicle_builds_and_stands() -> None:
    assert {"hatchback", "ball", "turtlebot3_burger", "turtlebot3_waffle"} <= set(names("vehicles"))
    for name in names("vehicles"):
        vehicle = platform(name, pose=Pose(3.0, -2.0, 7.0))
        assert len(vehicle.initial_state) == Part(vehicle.state).width
        assert vehicle.initial_vehicle.x_m == 3.0
        assert abs(vehicle.initial_vehicle.yaw_rad) < 3.2
        seen = Drive(vehicle).hold(1.0)
        assert (seen.x_m, seen.y_m) == (3.0, -2.0)


def test_profile_says_which_platform_it_is() -> None:
    assert isinstance(load("vehicles", "ball", VehicleProfile), BallProfile)  # type: ignore[arg-type]  # a union
    assert build(hatchback(), Pose(0.0, 0.0, 0.0), LEVEL).name == "car"


@pytest.mark.parametrize(
    ("written", "instead", "named"),
    [
        ("stall_rpm: 300", "stall_rpm: 500", "engine.*stall_rpm 500"),
        ("fire_rpm: 350", "fire_rpm: 900", "engine.*fire_rpm 900"),
        ("idle_rpm: 800", "idle_rpm: 3000", r"engine.*idle_rpm 3000\.0 must be below half of limit_rpm 5000"),
        ("at_rpm: 4000", "at_rpm: 2000", "engine.*curve"),
        ("[3.55, 1.95", "[1.55, 1.95", "gearbox.*forward"),
        ("bite_open: 0.75", "bite_open: 0.32", "gearbox.*bite_open 0.32"),
        ("up_rpm: 2100", "up_rpm: 1000", "automatic.*up_rpm 1000"),
        ("up_full_rpm: 5900", "up_full_rpm: 6900", "automatic.up_full_rpm 6900.* 6600"),
        ("launch_from_rpm: 860", "launch_from_rpm: 700", "automatic.launch_from_rpm 700.*idle_rpm 800"),
        ("lock_to_rpm: 1150", "lock_to_rpm: 850", "automatic.*lock_to_rpm 850"),
        ("wheel_inertia_kgm2: 2.2", "wheel_inertia_kgm2: 0.2 ", "front.wheel_inertia_kgm2 0.2 must be 0.225 or more"),
        ("mass_kg: 1300", "mass_kg: 13", "body.mass_kg: value 13: .*300"),
        ("mass_kg: 1300", "mass: 1300", "body.mass: .*did you mean mass_kg"),
    ],
)
def test_contradictions_are_refused_by_file_and_key(written: str, instead: str, named: str) -> None:
    text = (profiles_folder() / "vehicles" / "hatchback.yaml").read_text(encoding="utf-8").replace(written, instead)
    if "3000" in instead:
        text = text.replace("limit_rpm: 6600", "limit_rpm: 5000")
    with pytest.raises(ProfileError, match=f"^mine.yaml: .*{named}") as refused:
        parse(text, VehicleProfile, "mine.yaml")  # type: ignore[arg-type]  # a union
    assert "\n" not in str(refused.value)


def test_building_loads_no_numba() -> None:
    code = (
        "import sys; from simconsole.profiles.files.loader import load; "
        "from simconsole.profiles.vehicle import CarProfile; "
        "from simconsole.vehicle.platforms import build; from simconsole.values.platform import Ground, Pose; "
        "build(load('vehicles', 'hatchback', CarProfile), Pose(0.0, 0.0, 0.0), Ground(1.0, 0.0, 0.0)); "
        "sys.exit('numba' in sys.modules or 'simconsole.vehicle.ball.ball_step' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
