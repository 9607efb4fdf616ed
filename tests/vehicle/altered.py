"""A hatchback with other values than its profile's, already rolling."""

from typing import Any

import msgspec

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.kernels import put
from simconsole.values.platform import Ground
from simconsole.values.state_vector import PLATFORM_AT
from simconsole.vehicle.car.car_platform import car_parameters
from simconsole.vehicle.car.state import CarState, Wheel
from simconsole.vehicle.car.suspension import wheel_load
from simconsole.vehicle.platforms import build
from tests.vehicle.driving import LEVEL, ORIGIN, Drive

HATCHBACK = load("vehicles", "hatchback", CarProfile)
WHEELS = ("fl", "fr", "rl", "rr")
NO_AIDS = {"anti_lock": False, "traction_control": False, "stability_control": False, "hill_hold": False}


def altered(**sections: dict[str, Any]) -> CarProfile:
    """Return the hatchback with some values of some sections replaced."""
    parts = {name: msgspec.structs.replace(getattr(HATCHBACK, name), **values) for name, values in sections.items()}
    return msgspec.structs.replace(HATCHBACK, **parts)


def rolling_car(profile: CarProfile, speed_mps: float, ground: Ground = LEVEL) -> Drive:
    drive = Drive(build(profile, ORIGIN, ground))
    spins = dict.fromkeys([f"{wheel}_radps" for wheel in WHEELS], speed_mps / profile.front.wheel_radius_m)
    put(drive.row, PLATFORM_AT, CarState(*drive.vehicle.initial_state)._replace(vx_mps=speed_mps, **spins))
    return drive


def loads(drive: Drive, profile: CarProfile, ground: Ground = LEVEL) -> dict[str, float]:
    """Return the wheels' loads in N."""
    p = car_parameters(profile)
    state = drive.state
    found = {}
    for wheel in WHEELS:
        axle = p.front if wheel[0] == "f" else p.rear
        values = [getattr(state, f"{wheel}_{name}") for name in Wheel._fields]
        found[wheel] = wheel_load(axle, Wheel(*values))
    return found
