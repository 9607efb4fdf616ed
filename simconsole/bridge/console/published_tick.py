"""One finished tick as its messages share it: stamp, headers, attitude; and what a row of the output table is."""

import math
from collections.abc import Callable
from typing import Any, Final, NamedTuple

from simconsole.bridge.link.localisation import Localisation
from simconsole.bridge.messages import Registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.signals import VehicleState
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import NS_PER_S

ONCE: Final = -1.0
MAP_FRAME: Final = "map"
FOOTPRINT_FRAME: Final = "base_footprint"
ROBOT_FRAMES: Final = (FOOTPRINT_FRAME, "base_link")
"""The frames in which a robot takes velocities."""


class OutputTopic(NamedTuple):
    """One row of the table of output topics; a rate of 0 is never, ONCE is a latched message at the start."""

    name: str
    type: str
    rate_hz: float
    build: Callable[["PublishedTick"], Any]
    """Returns the message; None: nothing is to be told now."""
    watched: int | None = None
    """A column of the state vector: the topic is latched, and due with each change of it, too."""
    measured: bool = False
    """It tells what is measured of vehicle or road users: it goes over the session's link."""
    shared: bool = False
    """Clients publish on it, too."""


RobotTable = Callable[[Registry, BridgeProfile], tuple[OutputTopic, ...]]
"""Makes the table of a robot's topics, in place of the car's, under their standard names."""


class PublishedTick:
    """A tick as published: its snapshot, and the stamp, headers and orientation that its messages share."""

    def __init__(self, snapshot: Snapshot, localisation: Localisation, time: Any, header: Any, quaternion: Any) -> None:
        """Take the generated classes Time, Header and Quaternion."""
        self.snapshot = snapshot
        self.vehicle = snapshot.vehicle
        self._localisation = localisation
        self._measured: VehicleState | None = None
        self.stamp = time(*divmod(snapshot.t_ns, NS_PER_S))
        self._header = header
        self._quaternion = quaternion
        self._orientation: Any = None

    def header(self, frame: str) -> Any:
        """Return a header in `frame`."""
        return self._header(self.stamp, frame)

    @property
    def measured(self) -> VehicleState:
        """The vehicle as its localisation measures it: what a controller is told."""
        if self._measured is None:
            snapshot = self.snapshot
            self._measured = self._localisation.measure(self.vehicle, snapshot.tick, snapshot.tick_hz)
        return self._measured

    def orientation(self, vehicle: VehicleState) -> Any:
        """Return the attitude (z-y-x angles yaw, pitch, roll) of one of the two vehicles as a quaternion."""
        if vehicle is not self.measured:
            return self._quaternion(*quaternion(vehicle.roll_rad, vehicle.pitch_rad, vehicle.yaw_rad))
        if self._orientation is None:
            self._orientation = self._quaternion(*quaternion(vehicle.roll_rad, vehicle.pitch_rad, vehicle.yaw_rad))
        return self._orientation


def prefixed(namespace: str, frame: str) -> str:
    """Return the name of a robot's frame under a namespace."""
    return f"{namespace.removeprefix('/')}/{frame}" if namespace else frame


def quaternion(roll_rad: float, pitch_rad: float, yaw_rad: float) -> tuple[float, float, float, float]:
    """Return x, y, z, w of the rotation by yaw about z, then pitch about the new y, then roll about the new x."""
    cr, sr = math.cos(0.5 * roll_rad), math.sin(0.5 * roll_rad)
    cp, sp = math.cos(0.5 * pitch_rad), math.sin(0.5 * pitch_rad)
    cy, sy = math.cos(0.5 * yaw_rad), math.sin(0.5 * yaw_rad)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
