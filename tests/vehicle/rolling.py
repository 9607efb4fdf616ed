"""A hatchback that already rolls, with chosen driver aids."""

import msgspec

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.kernels import put
from simconsole.values.platform import Ground
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.car.state import CarState
from simconsole.vehicle.platforms import build
from tests.vehicle.driving import LEVEL, ORIGIN, Drive

RADIUS_M = 0.306


def rolling(speed_mps: float, ground: Ground = LEVEL, **aids: bool) -> Drive:
    profile = load("vehicles", "hatchback", CarProfile)
    drive = Drive(
        build(msgspec.structs.replace(profile, aids=msgspec.structs.replace(profile.aids, **aids)), ORIGIN, ground)
    )
    spin = speed_mps / RADIUS_M
    start = CarState(*drive.vehicle.initial_state)._replace(
        vx_mps=speed_mps, fl_radps=spin, fr_radps=spin, rl_radps=spin, rr_radps=spin
    )
    put(drive.row, PLATFORM_AT, start)
    put(drive.row, LAYOUT.vehicle.start, drive.vehicle.initial_vehicle._replace(vx_mps=speed_mps))
    return drive
