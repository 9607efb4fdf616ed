"""An exception in a part of a drive never ends it: the part falls silent, and the arbiter does the rest.

Devices that raise are devices that are gone, a controller whose source raises is a controller that was lost, a station
that raises sees nothing more. Each is told once, on standard error.
"""

import sys

from simconsole.drive import Cast
from simconsole.ports import CommandSource, DeviceSource, Station
from simconsole.rows import Snapshot
from simconsole.signals import NO_COMMAND, NO_SAMPLE, DeviceSample, Event, EventInput, RemoteCommand


def isolated(cast: Cast) -> Cast:
    """Return the cast of a drive with each part kept from the others."""
    return cast._replace(
        devices=IsolatedDevices(cast.devices),
        commands=IsolatedCommands(cast.commands, "ROS"),
        ecu=IsolatedCommands(cast.ecu, "CAN"),
        stations=[IsolatedStation(station) for station in cast.stations],
    )


class Told:
    """Tells of the first failure of a part."""

    def __init__(self, part: str) -> None:
        self._part = part
        self.failed = False

    def tell(self, error: Exception) -> None:
        """Say it, once."""
        if not self.failed:
            print(f"simconsole: {self._part} failed: {type(error).__name__}: {error}", file=sys.stderr)
        self.failed = True


class IsolatedDevices:
    """Devices; while they raise, they are gone."""

    def __init__(self, devices: DeviceSource) -> None:
        self._devices = devices
        self._told = Told("the cockpit")

    def poll(self, tick: int) -> DeviceSample:
        """Return the newest sample."""
        try:
            return self._devices.poll(tick)
        except Exception as error:  # noqa: BLE001  whatever it is, the car must come to rest
            self._told.tell(error)
            return NO_SAMPLE

    def close(self) -> None:
        """Release the devices."""
        self._devices.close()


class IsolatedCommands:
    """A command source; once it raised, that controller is lost."""

    def __init__(self, source: CommandSource, name: str) -> None:
        self._source = source
        self._told = Told(f"the {name} side")

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command and the edges."""
        if self._told.failed:
            return NO_COMMAND, EventInput(0.0)
        try:
            return self._source.take(tick)
        except Exception as error:  # noqa: BLE001  whatever it is, the car must come to rest
            self._told.tell(error)
            return NO_COMMAND, EventInput(float(Event.COMMANDER_LOST))


class IsolatedStation:
    """A station; once it raised, it sees nothing more."""

    def __init__(self, station: Station) -> None:
        self._station = station
        self._told = Told(type(station).__name__)
        if hasattr(station, "hop"):
            self.hop = station.hop

    def publish(self, snapshot: Snapshot) -> None:
        """Show it one tick."""
        if self._told.failed:
            return
        try:
            self._station.publish(snapshot)
        except Exception as error:  # noqa: BLE001  nobody who only looks may stop the car
            self._told.tell(error)
