"""The shipped cars, with chosen driver aids, on any ground, at rest or already rolling."""

import msgspec

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.kernels import put
from simconsole.values.platform import Ground
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.car.state import CarState
from simconsole.vehicle.platforms import build
from tests.vehicle.driving import LEVEL, ORIGIN, Drive

SHIPPED = ("hatchback", "light_van", "commonroad_bmw320i")


def shipped(name: str, ground: Ground = LEVEL, speed_mps: float = 0.0, **aids: bool) -> Drive:
    profile = load("vehicles", name, CarProfile)
    profile = msgspec.structs.replace(profile, aids=msgspec.structs.replace(profile.aids, **aids))
    drive = Drive(build(profile, ORIGIN, ground))
    front = speed_mps / profile.front.wheel_radius_m
    rear = speed_mps / profile.rear.wheel_radius_m
    start = CarState(*drive.vehicle.initial_state)._replace(
        vx_mps=speed_mps, fl_radps=front, fr_radps=front, rl_radps=rear, rr_radps=rear
    )
    put(drive.row, PLATFORM_AT, start)
    put(drive.row, LAYOUT.vehicle.start, drive.vehicle.initial_vehicle._replace(vx_mps=speed_mps))
    return drive
