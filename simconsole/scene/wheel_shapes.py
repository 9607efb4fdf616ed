"""A car's four wheels, and the forces of their tyres, in the frame of base_link. Pure arrays, no rerun."""

from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np

from simconsole.scene.entities import Array, Colour

CORNERS: Final = ("fl", "fr", "rl", "rr")
STEERED: Final = 2  # of the corners, the first two
_OF_CORNER: Final = ("deflection_x_m", "deflection_y_m", "lift_m")
WHEEL_COLUMNS: Final = (
    "vehicle.road_wheel_rad",
    *(f"platform.{corner}_{name}" for corner in CORNERS for name in _OF_CORNER),
)
"""The columns of a car's state vector that its wheels are made of."""
TYRE: Final[Colour] = (16, 17, 20)
FORCE: Final[Colour] = (255, 92, 160)
M_PER_N: Final = 1.0 / 2500.0
"""Length of a force's arrow."""
WIDTH_M: Final = 0.32
"""Wide enough to be seen beside the body."""
ARROW_Z_M: Final = 0.03


class ShownWheel(NamedTuple):
    """One wheel of a car, and what its tyre's force follows from. Stiffness is per newton of load."""

    x_m: float  # of base_link
    y_m: float
    radius_m: float
    static_n: float
    carcass_npm: float
    stiffness_x_per_m: float
    stiffness_y_per_m: float
    friction: float  # on dry ground


ShownWheels = tuple[ShownWheel, ShownWheel, ShownWheel, ShownWheel]


class WheelShapes(NamedTuple):
    """The wheels of several ticks."""

    centres: Array  # [N, 4, 3] m
    quaternions: Array  # [N, 4, 4], w last: the axis of a cylinder, z, lies along the axle
    patches: Array  # [N, 4, 3] m, where the forces act
    forces_n: Array  # [N, 4, 3], on the car


def wheel_shapes(table: Mapping[str, Array], wheels: ShownWheels) -> WheelShapes:
    """Return wheels and tyre forces.

    The force follows from the deflection of the contact patch and the load as in vehicle/car/tyre.py, on dry ground
    and without the damping of the carcass, which acts only while the deflection changes.

    Args:
        table: WHEEL_COLUMNS of state vectors in their order.
        wheels: of the car, in the order of CORNERS.
    """
    count = len(table["vehicle.road_wheel_rad"])
    steered = np.zeros((count, len(wheels)))
    steered[:, :STEERED] = table["vehicle.road_wheel_rad"][:, None]
    lift, along, aside = (
        np.column_stack([table[f"platform.{corner}_{name}"] for corner in CORNERS])
        for name in ("lift_m", "deflection_x_m", "deflection_y_m")
    )
    x, y, radius, static, carcass, stiffness_x, stiffness_y, friction = np.array(wheels).T
    load = np.maximum(0.0, static - carcass * lift)
    bent_x, bent_y = stiffness_x * along, stiffness_y * aside
    demand = np.hypot(bent_x, bent_y) / friction
    elastic = load / (1.0 + 0.25 * demand * demand)
    c, s = np.cos(steered), np.sin(steered)
    force_x, force_y = bent_x * elastic, bent_y * elastic
    forces = np.stack((force_x * c - force_y * s, force_x * s + force_y * c, np.zeros_like(c)), axis=-1)
    ones = np.ones_like(c)
    # Turned about x by a quarter, so that the cylinder's axis is the axle, then steered about z.
    half, quarter = 0.5 * steered, np.sqrt(0.5)
    turns = quarter * np.stack((np.cos(half), np.sin(half), np.sin(half), np.cos(half)), axis=-1)
    return WheelShapes(
        centres=np.stack((x * ones, y * ones, radius + lift), axis=-1),
        quaternions=turns,
        patches=np.stack((x * ones, y * ones, ARROW_Z_M * ones), axis=-1),
        forces_n=forces,
    )
