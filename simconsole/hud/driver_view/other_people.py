"""People on foot as the driver's view shows them: one figure, turned and stretched for each."""

import math
from typing import Final

import numpy as np

from simconsole.hud.driver_view.mesh import Array, Colour, Vertices, cone, joined
from simconsole.world.traffic.road_users import RoadUser

HEIGHT_M: Final = 1.75
TROUSERS: Final[Colour] = (52, 58, 76)
COAT: Final[Colour] = (196, 120, 44)
SKIN: Final[Colour] = (222, 178, 146)
_LEG_M: Final = 0.11  # from the middle, to both sides


def person() -> Vertices:
    """Return the figure that stands for all, its feet at the origin: legs, coat, head."""
    legs = [cone(0.0, side * _LEG_M, (0.0, 0.85), (0.07, 0.10), TROUSERS) for side in (-1.0, 1.0)]
    coat = cone(0.0, 0.0, (0.75, 1.45), (0.24, 0.20), COAT)
    return joined([*legs, coat, cone(0.0, 0.0, (1.45, HEIGHT_M), (0.09, 0.11), SKIN)])


def person_model(user: RoadUser) -> Array:
    """Return the matrix [4, 4] that brings the figure to where somebody is."""
    cosine, sine = math.cos(user.yaw_rad), math.sin(user.yaw_rad)
    return np.array(
        (
            (cosine, -sine, 0.0, user.x_m),
            (sine, cosine, 0.0, user.y_m),
            (0.0, 0.0, user.height_m / HEIGHT_M, 0.0),
            (0.0, 0.0, 0.0, 1.0),
        )
    )
