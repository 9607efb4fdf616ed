"""The platforms of a session as road users of each other: boxes that each one follows, yields to and runs into."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from simconsole.session.traffic_source import ego_box
from simconsole.tick.advance import Console, ConsoleState
from simconsole.values.layout import read
from simconsole.values.platform import Platform
from simconsole.values.signals import VehicleState
from simconsole.values.state_vector import LAYOUT
from simconsole.world.roads.road_map import Array
from simconsole.world.traffic.crashes import box_moving, guessed, motion_of
from simconsole.world.traffic.impact import Moving
from simconsole.world.traffic.road_users import Box, RoadUser, RoadUserKind

LIGHT_KG: Final = 1.8
"""Of a platform that takes no impact, a robot or a ball: it stops no car. A TurtleBot3 Waffle's."""

_INDICATORS_AT: Final = LAYOUT.command.at("turn_indicators")
_MOVING: Final = ("x_m", "y_m", "yaw_rad", "speed_mps", "z_m", "turn_indicators")
_MOVING_AT: Final = [RoadUser._fields.index(name) for name in _MOVING]
"""What changes of a road user that is a platform."""


class Company:
    """Where all platforms of a session are, as a table of road users; a platform's `id` is its number."""

    def __init__(self, consoles: Sequence[Console], states: Sequence[ConsoleState]) -> None:
        """Take the platforms and their states before the first tick."""
        self._platforms = [console.platform for console in consoles]
        self._table = np.array([_standing(number, platform) for number, platform in enumerate(self._platforms)])
        self._vehicles: list[VehicleState] = []
        self._boxes: list[Box] = []
        self.renew(states)

    def renew(self, states: Sequence[ConsoleState]) -> None:
        """Tell from now on where the platforms are in these states."""
        self._vehicles = [read(state.vector, LAYOUT.vehicle) for state in states]
        self._boxes = [ego_box(*both) for both in zip(self._vehicles, self._platforms, strict=True)]
        self._table[:, _MOVING_AT] = [
            (box.x_m, box.y_m, box.yaw_rad, box.speed_mps, vehicle.z_m, state.vector[_INDICATORS_AT])
            for state, vehicle, box in zip(states, self._vehicles, self._boxes, strict=True)
        ]

    def around(self, number: int) -> "Beside":
        """Return the road users of the platform of this number: all others."""
        return Beside(self, [other for other in range(len(self._platforms)) if other != number])

    def vehicle(self, number: int) -> VehicleState:
        """Return the state of the platform of this number."""
        return self._vehicles[number]

    def box(self, number: int) -> Box:
        """Return the footprint of the platform of this number."""
        return self._boxes[number]

    def boxes(self) -> list[Box]:
        """Return the footprints of all platforms, in their order."""
        return list(self._boxes)

    def has(self, number: float) -> bool:
        """Return whether a road user is a platform."""
        return number < len(self._platforms)

    def rows(self, numbers: NDArray[np.intp]) -> Array:
        """Return where these platforms are, float64 [platforms, FIELDS], a copy."""
        return self._table.take(numbers, axis=0)

    def moving(self, user: RoadUser) -> Moving:
        """Return how a road user of a platform's moves as a body."""
        if not self.has(user.id):
            return guessed(user)
        solid, vehicle = self._platforms[int(user.id)].solid, self._vehicles[int(user.id)]
        return box_moving(user, LIGHT_KG) if solid is None else motion_of(vehicle, solid)


class Beside:
    """The other platforms, stepped by drives of their own: what the traffic of one platform is made of."""

    def __init__(self, company: Company, numbers: Sequence[int]) -> None:
        """Take the platforms of these numbers."""
        self._company, self._numbers = company, np.array(numbers, np.intp)

    def road_users(self) -> Array:
        """Return where they are, float64 [users, FIELDS] as `RoadUser`."""
        return self._company.rows(self._numbers)

    def step(self, ego: Box | None) -> Array:
        """Return where they are now."""
        return self.road_users()

    def is_platform(self, number: float) -> bool:
        """Return whether a road user is one of ours."""
        return self._company.has(number)

    def push(self, number: float, change_mps: float) -> None:
        """Do nothing: who is pushed finds the same touch among its own road users."""


def _standing(number: int, platform: Platform) -> RoadUser:
    """Return a platform as a road user, but for where it is and how it moves."""
    return RoadUser(
        id=float(number),
        kind=float(RoadUserKind.CAR),
        x_m=0.0,
        y_m=0.0,
        yaw_rad=0.0,
        speed_mps=0.0,
        length_m=platform.length_m,
        width_m=platform.width_m,
        height_m=platform.height_m,
    )
