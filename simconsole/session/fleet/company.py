"""The platforms of a session as road users of each other: boxes that each one follows, yields to and runs into."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from simconsole.session.traffic_source import ego_box
from simconsole.tick.advance import Console, ConsoleState
from simconsole.values.layout import read
from simconsole.values.state_vector import LAYOUT
from simconsole.world.roads.road_map import Array
from simconsole.world.traffic.crashes import box_moving, guessed, motion_of
from simconsole.world.traffic.impact import Moving
from simconsole.world.traffic.road_users import FIELDS, Box, RoadUser, RoadUserKind

LIGHT_KG: Final = 1.8
"""Of a platform that takes no impact, a robot or a ball: it stops no car. A TurtleBot3 Waffle's."""

_INDICATORS_AT: Final = LAYOUT.command.at("turn_indicators")


class Company:
    """Where all platforms of a session are, as a table of road users; a platform's `id` is its number."""

    def __init__(self, consoles: Sequence[Console], states: Sequence[ConsoleState]) -> None:
        """Take the platforms and their states before the first tick."""
        self._platforms = [console.platform for console in consoles]
        self._table = np.zeros((len(consoles), FIELDS))
        self._vehicles = [read(state.vector, LAYOUT.vehicle) for state in states]
        self._boxes: list[Box] = []
        self.renew(states)

    def renew(self, states: Sequence[ConsoleState]) -> None:
        """Tell from now on where the platforms are in these states."""
        self._boxes.clear()
        for number, (state, platform) in enumerate(zip(states, self._platforms, strict=True)):
            vehicle = read(state.vector, LAYOUT.vehicle)
            self._vehicles[number] = vehicle
            box = ego_box(vehicle, platform)
            self._boxes.append(box)
            self._table[number] = RoadUser(
                id=float(number),
                kind=float(RoadUserKind.CAR),
                x_m=box.x_m,
                y_m=box.y_m,
                yaw_rad=box.yaw_rad,
                speed_mps=box.speed_mps,
                length_m=box.length_m,
                width_m=box.width_m,
                height_m=platform.height_m,
                z_m=vehicle.z_m,
                turn_indicators=float(state.vector[_INDICATORS_AT]),
            )

    def around(self, number: int) -> "Beside":
        """Return the road users of the platform of this number: all others."""
        return Beside(self, [other for other in range(len(self._platforms)) if other != number])

    def boxes(self) -> list[Box]:
        """Return the footprints of all platforms, in their order."""
        return list(self._boxes)

    def has(self, number: float) -> bool:
        """Return whether a road user is a platform."""
        return number < len(self._platforms)

    def rows(self, numbers: Sequence[int]) -> Array:
        """Return where these platforms are, float64 [platforms, FIELDS], a copy."""
        return self._table[numbers]

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
        self._company, self._numbers = company, numbers

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
