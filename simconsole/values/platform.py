"""The interface behind which every vehicle stands."""

from collections.abc import Callable
from typing import Any, Final, NamedTuple

from simconsole.values.ground import MOST_PATCHES, Ground, Patch
from simconsole.values.kernels import Row
from simconsole.values.signals import VehicleState

__all__ = [
    "MOST_PATCHES",
    "NO_OBSTACLES",
    "NO_STIFFNESS",
    "Ground",
    "Obstacles",
    "Patch",
    "Platform",
    "Pose",
    "RimStiffness",
    "Solid",
    "Step",
]

Step = Callable[[Row, Row, Row, Row, int], None]
"""A platform's step: see `Platform`."""


class Pose(NamedTuple):
    """Where base_link starts, in `map`."""

    x_m: float
    y_m: float
    yaw_rad: float


class Obstacles(NamedTuple):
    """What a vehicle may run into, in m of map."""

    segments: tuple[tuple[float, float, float, float], ...] = ()  # straight ones: x, y of both ends
    circles: tuple[tuple[float, float, float], ...] = ()  # x, y, radius


NO_OBSTACLES: Final = Obstacles()


class Solid(NamedTuple):
    """What a collision works on: a body that moves in the plane."""

    mass_kg: float
    yaw_inertia_kgm2: float
    cg_ahead_m: float  # of base_link


class RimStiffness(NamedTuple):
    """What a steering is like about the middle, as far as a wheel's motor must know it.

    Torque at the rim per rad of the hand wheel before the car answers by turning, in N m per rad, by speed.
    """

    at_0mps: float
    at_12mps: float
    at_24mps: float
    at_36mps: float
    at_48mps: float
    relaxation_m: float  # length over which the front tyres answer
    pulls: float  # 1: the tyres pull the wheel to the middle; 0: they pull it nowhere


NO_STIFFNESS: Final = RimStiffness(*(0.0,) * len(RimStiffness._fields))
"""A vehicle whose steering feels nothing."""


class Platform(NamedTuple):
    """One vehicle, ready to drive.

    `step(previous, vector, parameters, ground, substeps)` is a kernel: it reads `VehicleCommand` from `vector` at
    LAYOUT.command, what collisions did at LAYOUT.impact and LAYOUT.obstacle, and its own state from `previous` at
    PLATFORM_AT. It advances `substeps` steps of 1 ms on `ground`, and writes `VehicleState` at LAYOUT.vehicle and its
    state at PLATFORM_AT of `vector` (simconsole.values.state_vector). What it knows of the vehicle is in `parameters`,
    and of the ground in `ground` (simconsole.values.ground).
    """

    name: str
    state: type[Any]  # a NamedTuple of floats: the platform's own columns
    initial_state: tuple[float, ...]
    initial_vehicle: VehicleState
    parameters: Row
    ground: Row
    step: Step
    steering_ratio: float  # hand-wheel angle per road-wheel angle
    max_road_wheel_rad: float
    wheelbase_m: float  # of a ball its diameter: the length that stands in for a wheelbase
    length_m: float
    width_m: float
    height_m: float
    rear_overhang_m: float  # from base_link to the rear end
    solid: Solid | None = None  # None: its step takes no impact; where it strikes something a drive ends
    others: int = 0  # as many other platforms it reacts to: circles at the end of `vector` (state_vector.OTHER)
    turns_in_place: bool = False  # it follows a speed and a yaw rate; a car is steered and driven by pedals
    compiled: bool = True  # False: `step` is called as it is, between compiled stages
    exact: bool = True  # False: nobody can say that equal commands give equal bits on another machine
