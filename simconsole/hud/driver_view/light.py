"""Daylight and night as the few numbers that a picture is lit by."""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Triple = tuple[float, float, float]


class Light(NamedTuple):
    """Light of a scene, linear from 0 to about 1."""

    sun: Triple  # unit vector towards the sun (or moon)
    sun_light: Triple
    sky_light: Triple
    fog: Triple
    fog_per_m: float
    horizon: Triple
    zenith: Triple
    night: float  # 1: headlights and windows shine


def _towards(azimuth_deg: float, elevation_deg: float) -> Triple:
    azimuth, elevation = math.radians(azimuth_deg), math.radians(elevation_deg)
    flat = math.cos(elevation)
    return flat * math.cos(azimuth), flat * math.sin(azimuth), math.sin(elevation)


DAY: Final = Light(
    sun=_towards(-130.0, 48.0),
    sun_light=(0.98, 0.94, 0.86),
    sky_light=(0.40, 0.45, 0.54),
    fog=(0.56, 0.65, 0.76),
    fog_per_m=0.0011,
    horizon=(0.56, 0.65, 0.76),
    zenith=(0.10, 0.24, 0.56),
    night=0.0,
)
NIGHT: Final = Light(
    sun=_towards(60.0, 40.0),
    sun_light=(0.020, 0.024, 0.034),
    sky_light=(0.022, 0.026, 0.040),
    fog=(0.008, 0.010, 0.016),
    fog_per_m=0.0022,
    horizon=(0.010, 0.012, 0.020),
    zenith=(0.002, 0.003, 0.008),
    night=1.0,
)


def reach_m(light: Light) -> float:
    """Return the distance beyond which fog leaves less than a fiftieth of anything."""
    return math.log(50.0) / light.fog_per_m


def shadow_matrix(light: Light, centre: Array, half_m: float) -> Array:
    """Return the matrix [4, 4] from `map` to a shadow map that covers `half_m` around a place."""
    towards = np.array(light.sun)
    right = np.cross((0.0, 0.0, 1.0), towards)
    right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    matrix = np.eye(4)
    matrix[0, :3], matrix[1, :3], matrix[2, :3] = right / half_m, up / half_m, -towards / (4.0 * half_m)
    matrix[:3, 3] = -matrix[:3, :3] @ centre
    return matrix
