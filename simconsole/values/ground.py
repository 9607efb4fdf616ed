"""The ground as the array that a platform's step reads: plane, patches and grid first, then the field's nodes."""

import math
from typing import Final, NamedTuple

import numpy as np

from simconsole.values.height_field import NO_GRID, Grid, HeightField
from simconsole.values.kernels import Row
from simconsole.values.layout import Part, lay_out, write
from simconsole.values.units import STANDARD_GRAVITY_MPS2

LEAST_FRICTION: Final = 0.01
"""Least friction, below that of wet ice: without any a tyre would have a force limit of 0 to divide by."""


class Patch(NamedTuple):
    """A rectangle of `map` with a friction of its own: a share of the ground's. Where two overlap, the later counts."""

    from_x_m: float
    to_x_m: float
    from_y_m: float
    to_y_m: float
    share: float


MOST_PATCHES: Final = 4
NO_PATCH: Final = Patch(1.0, -1.0, 1.0, -1.0, 1.0)
"""A rectangle without any place."""


class Ground(NamedTuple):
    """The ground under the vehicle: friction coefficient and the slope of its plane along x and y of `map`.

    `right_share` is the share of the friction under the vehicle's right wheels: below 1 on split friction. `patches`,
    at most MOST_PATCHES, hold for each wheel that stands on them. The wind is where the air moves to, in `map`. A
    `field` lies on the plane: its heights are added.
    """

    friction: float
    slope_x: float
    slope_y: float
    right_share: float = 1.0
    wind_x_mps: float = 0.0
    wind_y_mps: float = 0.0
    patches: tuple[Patch, ...] = ()
    field: HeightField | None = None


class Plane(NamedTuple):
    """What holds everywhere: friction, the slope of the plane, and the wind over it."""

    friction: float
    right_share: float
    slope_x: float
    slope_y: float
    rise_x: float  # of the plane, per metre along it: x and y lie in it
    rise_y: float
    gravity_mps2: float  # gravity / sqrt(1 + slope^2): times slope along, times 1 normal to the plane
    wind_x_mps: float  # where the air moves to, in map
    wind_y_mps: float


class GroundLayout(NamedTuple):
    """The parts of the array, in their order; the nodes of the field follow."""

    plane: Part[Plane]
    patch_1: Part[Patch]
    patch_2: Part[Patch]
    patch_3: Part[Patch]
    patch_4: Part[Patch]
    grid: Part[Grid]


GROUND: Final = lay_out(GroundLayout)
NODES_AT: Final = GROUND.grid.stop


def ground_row(ground: Ground) -> Row:
    """Return the array of a ground.

    Raises:
        ValueError: more than MOST_PATCHES patches.
    """
    if len(ground.patches) > MOST_PATCHES:
        raise ValueError(f"{len(ground.patches)} patches of friction, at most {MOST_PATCHES} are possible")
    gravity = STANDARD_GRAVITY_MPS2 / math.sqrt(1.0 + ground.slope_x**2 + ground.slope_y**2)
    nodes = np.zeros(0) if ground.field is None else ground.field.nodes.ravel()
    row = np.empty(NODES_AT + len(nodes))
    plane = Plane(
        friction=max(ground.friction, LEAST_FRICTION),
        right_share=max(ground.right_share, LEAST_FRICTION),
        slope_x=ground.slope_x,
        slope_y=ground.slope_y,
        rise_x=ground.slope_x * gravity / STANDARD_GRAVITY_MPS2,
        rise_y=ground.slope_y * gravity / STANDARD_GRAVITY_MPS2,
        gravity_mps2=gravity,
        wind_x_mps=ground.wind_x_mps,
        wind_y_mps=ground.wind_y_mps,
    )
    write(row, GROUND.plane, plane)
    patches = (*ground.patches, *(NO_PATCH,) * MOST_PATCHES)
    for part, patch in zip((GROUND.patch_1, GROUND.patch_2, GROUND.patch_3, GROUND.patch_4), patches, strict=False):
        write(row, part, patch)
    write(row, GROUND.grid, NO_GRID if ground.field is None else ground.field.grid)
    row[NODES_AT:] = nodes
    return row
