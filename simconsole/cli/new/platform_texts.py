"""The template of a vehicle of one's own, as a package that registers it. `$name` is what the user called it."""

from typing import Final

ENTRY: Final = ("simconsole.vehicles", "VEHICLE")
"""The group of its entry point, and what that names in its module."""

PLATFORM: Final = '''\
"""$name: a vehicle of one's own. `pip install -e .` registers it; a session names `$name.yaml` beside it.

A car whose wheels roll without slip. With `compiled=True` and the decorator `stage` of simconsole.values.kernels its
step is compiled with the rest of the tick: it may use numbers, tuples and the functions of simconsole.values then.
"""

from typing import NamedTuple

import numpy as np

from simconsole.profiles.vehicle import OwnProfile
from simconsole.values.ground import ground_row
from simconsole.values.layout import Part, read, write
from simconsole.values.platform import Platform
from simconsole.values.signals import VehicleState
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.values.trigonometry import direction, wrap_angle
from simconsole.vehicle.registered import Bounded, OwnSettings, OwnVehicle

PARAMETERS = {
    "throttle_mps2": Bounded(3.0, 0.5, 10.0),
    "brake_mps2": Bounded(8.0, 1.0, 12.0),
    "drag_1ps": Bounded(0.05, 0.0, 1.0),
}
"""Each with what it is, and between which values a profile may put it."""


class State(NamedTuple):
    """Its own columns, beside those that every vehicle has; units at the end of their names."""

    speed_mps: float
    distance_m: float


STATE = Part(State, PLATFORM_AT)


def step(previous, vector, parameters, ground, substeps):
    """Make `substeps` steps of 1 ms. What it needs later must be in the state: a tick may be made again."""
    command, vehicle, state = read(vector, LAYOUT.command), read(previous, LAYOUT.vehicle), read(previous, STATE)
    throttle_mps2, brake_mps2, drag_1ps, wheelbase_m = parameters[0], parameters[1], parameters[2], parameters[3]
    x_m, y_m, yaw_rad = vehicle.x_m, vehicle.y_m, vehicle.yaw_rad
    speed_mps, distance_m, accel_mps2, rate = state.speed_mps, state.distance_m, 0.0, 0.0
    wheel = direction(command.road_wheel_rad)
    for _ in range(substeps):
        accel_mps2 = throttle_mps2 * command.throttle - brake_mps2 * command.brake - drag_1ps * speed_mps
        speed_mps = max(0.0, speed_mps + 0.001 * accel_mps2)
        rate = speed_mps / wheelbase_m * wheel.sin / wheel.cos
        way = direction(yaw_rad)
        x_m, y_m = x_m + 0.001 * speed_mps * way.cos, y_m + 0.001 * speed_mps * way.sin
        yaw_rad = wrap_angle(yaw_rad + 0.001 * rate)
        distance_m += 0.001 * speed_mps
    if speed_mps == 0.0:
        accel_mps2 = 0.0
    after = VehicleState(
        x_m=x_m,
        y_m=y_m,
        z_m=0.0,
        yaw_rad=yaw_rad,
        pitch_rad=0.0,
        roll_rad=0.0,
        vx_mps=speed_mps,
        vy_mps=0.0,
        yaw_rate_radps=rate,
        ax_mps2=accel_mps2,
        ay_mps2=speed_mps * rate,
        road_wheel_rad=command.road_wheel_rad,
        hand_wheel_torque_nm=0.0,
        engine_radps=0.0,
        engine_running=1.0,
        gear=1.0,
        clutch=0.0,
        distance_m=distance_m,
        coast_accel_mps2=-drag_1ps * speed_mps,
        full_throttle_accel_mps2=throttle_mps2 - drag_1ps * speed_mps,
        full_brake_accel_mps2=-brake_mps2 - drag_1ps * speed_mps,
        gear_fault=0.0,
    )
    write(vector, LAYOUT.vehicle, after)
    write(vector, STATE, State(speed_mps=speed_mps, distance_m=distance_m))


def build(settings: OwnSettings) -> Platform:
    """Return the vehicle at rest where it starts."""
    profile: OwnProfile = settings.profile
    own = [settings.parameters[name] for name in PARAMETERS]
    at_rest = VehicleState(*(0.0,) * len(VehicleState._fields))._replace(
        x_m=settings.pose.x_m, y_m=settings.pose.y_m, yaw_rad=settings.pose.yaw_rad, engine_running=1.0, gear=1.0,
        full_throttle_accel_mps2=own[0], full_brake_accel_mps2=-own[1],
    )  # fmt: skip
    return Platform(
        name="$name",
        state=State,
        initial_state=(0.0, 0.0),
        initial_vehicle=at_rest,
        parameters=np.array([*own, profile.wheelbase_m]),
        ground=ground_row(settings.ground),
        step=step,
        steering_ratio=profile.steering_ratio,
        max_road_wheel_rad=np.deg2rad(profile.max_road_wheel_deg).item(),
        wheelbase_m=profile.wheelbase_m,
        length_m=profile.length_m,
        width_m=profile.width_m,
        height_m=profile.height_m,
        rear_overhang_m=profile.rear_overhang_m,
        compiled=False,
    )


VEHICLE = OwnVehicle(PARAMETERS, build)
'''

PROFILE: Final = """\
# $name: a session or scenario beside it names it `$name.yaml`.
platform: own
kind: $name
parameters: {throttle_mps2: 3.5}
length_m: 4.2
width_m: 1.8
height_m: 1.5
wheelbase_m: 2.6
rear_overhang_m: 0.8
steering_ratio: 15
max_road_wheel_deg: 35
"""

TEST: Final = '''\
"""$name keeps the contract of vehicles, and moves as its formulas say. No installation is needed for this."""

from pathlib import Path
from runpy import run_path

import pytest

from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.vehicle import OwnProfile
from simconsole.values.errors import ProfileError
from simconsole.values.platform import Ground, Pose
from simconsole.vehicle.contract import problems
from simconsole.vehicle.registered import build_own

HERE = Path(__file__).parent
VEHICLE = run_path(str(HERE / "$name.py"))["VEHICLE"]


def built(**parameters):
    profile = load_vehicle(str(HERE / "$name.yaml"))
    profile = OwnProfile(kind="$name", parameters={**profile.parameters, **parameters})
    return build_own(profile, Pose(0.0, 0.0, 0.0), Ground(friction=1.0, slope_x=0.0, slope_y=0.0), VEHICLE)


def test_it_keeps_the_contract():
    assert problems(built()) == []


def test_its_parameters_have_bounds():
    assert built(throttle_mps2=5.0).parameters[0] == 5.0
    with pytest.raises(ProfileError, match="parameters: throttle_mps2: value 99: 0.5 to 10"):
        built(throttle_mps2=99.0)
    with pytest.raises(ProfileError, match="parameters: wings: one of"):
        built(wings=1.0)
'''
