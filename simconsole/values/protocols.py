"""What the drive loop needs of the world outside: four small protocols and their empty forms."""

from typing import Final, NamedTuple, Protocol

import numpy as np

from simconsole.values.kernels import Row
from simconsole.values.signals import NO_COMMAND, NO_EVENTS, NO_SAMPLE, DeviceSample, EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot

_NO_SAMPLE: Final = np.array(NO_SAMPLE)
_NO_COMMAND: Final = np.array(NO_COMMAND)


class DeviceSource(Protocol):
    """The cockpit: where DeviceSamples come from."""

    def poll(self, tick: int) -> DeviceSample:
        """Return the newest sample for the coming `tick`, its ages in whole ticks."""

    def close(self) -> None:
        """Release the devices."""


class DeviceIdentity(NamedTuple):
    """Which device it was that somebody drove with: a label for people, nothing that a tick depends on."""

    roles: tuple[str, ...]
    name: str
    usb_id: str  # vendor:product, hexadecimal
    port: str  # where it is plugged in; empty where the system does not tell
    serial: str


class CommandSource(Protocol):
    """The controller's side: where remote commands and events come from."""

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command, its age in whole ticks, and all edges since the last call."""


class Output(Protocol):
    """A reader of snapshots. It must not block and must not raise into the loop.

    One with an attribute `hop` (`latency.Hop`) is timed under that name in the latency statistics, every other one as
    "others".
    """

    def publish(self, snapshot: Snapshot) -> None:
        """See one tick; an output with its own rate ignores what it does not need."""


class Seat(Protocol):
    """Someone who works the devices by what they see: the simulated person."""

    def act(self, snapshot: Snapshot) -> None:
        """Look at the last tick and move wheel, pedals and lever."""


class NobodySeated:
    """A cockpit with no devices at all, for drives that only the ROS side commands."""

    def poll(self, tick: int) -> DeviceSample:
        """Return a sample in which every device is gone."""
        return NO_SAMPLE

    def foresee(self, tick: int, samples: Row) -> int:
        """Write the same into all rows, and return how many there are."""
        samples[:] = _NO_SAMPLE
        return len(samples)

    def close(self) -> None:
        """Nothing to release."""


class NobodyCommands:
    """No controller: no command ever comes."""

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the absence of a command."""
        return NO_COMMAND, NO_EVENTS

    def foresee(self, tick: int, commands: Row) -> int:
        """Write the same into all rows, and return how many there are."""
        commands[:] = _NO_COMMAND
        return len(commands)
