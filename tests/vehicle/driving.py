"""A short way to drive a vehicle in tests: a person or an automatic at the command, no pipeline around it."""

from collections.abc import Callable
from typing import Any

import numpy as np

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import Row, put
from simconsole.values.layout import Part, read
from simconsole.values.platform import NO_OBSTACLES, Ground, Obstacles, Platform, Pose
from simconsole.values.signals import VehicleCommand, VehicleState
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.platforms import build

IDLE = VehicleCommand(*(0.0,) * len(VehicleCommand._fields))
LEVEL = Ground(friction=1.0, slope_x=0.0, slope_y=0.0)
ORIGIN = Pose(0.0, 0.0, 0.0)
TICK_S = 0.004
SUBSTEPS = 4


def platform(
    name: str = "hatchback", ground: Ground = LEVEL, pose: Pose = ORIGIN, obstacles: Obstacles = NO_OBSTACLES
) -> Platform:
    profile: Any = load("vehicles", name, VehicleProfile)  # type: ignore[arg-type]  # a union
    return build(profile, pose, ground, obstacles)


class Drive:
    """One vehicle under command, 250 ticks a second."""

    def __init__(self, vehicle: Platform, execution: Callable[..., Any] = compiled) -> None:
        self.vehicle = vehicle
        self.step = execution(vehicle.step)
        self.row: Row = np.zeros(PLATFORM_AT + len(vehicle.initial_state))
        put(self.row, LAYOUT.vehicle.start, vehicle.initial_vehicle)
        put(self.row, PLATFORM_AT, vehicle.initial_state)
        self.time_s = 0.0

    @property
    def seen(self) -> VehicleState:
        return VehicleState(*self.row[LAYOUT.vehicle.slice].tolist())

    @property
    def state(self) -> Any:
        return read(self.row, Part(self.vehicle.state, PLATFORM_AT))

    def tick(self, command: VehicleCommand) -> None:
        row = self.row.copy()
        put(row, LAYOUT.command.start, command)
        self.step(self.row, row, self.vehicle.parameters, self.vehicle.ground, SUBSTEPS)
        self.row = row
        self.time_s += TICK_S

    def hold(self, seconds: float, **command: float) -> VehicleState:
        """Hold one command."""
        wanted = IDLE._replace(**command)
        for _ in range(round(seconds / TICK_S)):
            self.tick(wanted)
        return self.seen

    def until(self, done: Callable[[VehicleState], bool], limit_s: float, **command: float) -> VehicleState:
        """Hold one command until `done`; fail after `limit_s`."""
        wanted = IDLE._replace(**command)
        for _ in range(round(limit_s / TICK_S)):
            self.tick(wanted)
            if done(self.seen):
                return self.seen
        raise AssertionError(f"not reached in {limit_s} s: {self.seen}")
