"""An exception in a part of a drive never ends it: the part falls silent, and the arbiter does the rest.

Devices that raise are devices that are gone, and so they are where the person in the seat does; a controller whose
source raises is a controller that was lost; an output or a recorder that raises sees nothing more; a pace that raises
is a loop that stood still, and another one takes its place. Each is told once, on standard error.
"""

import contextlib
import sys
from collections.abc import Callable

from simconsole.tick.loop import Components, Pace, Recorder, Standby
from simconsole.values.protocols import CommandSource, DeviceSource, Output, Seat
from simconsole.values.signals import NO_COMMAND, NO_SAMPLE, DeviceSample, Event, EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot


def isolated(components: Components, spare: Callable[[], Pace]) -> Components:
    """Return the components of a drive with each kept from the others; `spare` makes a pace for one that has failed."""
    seat = None if components.seat is None else IsolatedSeat(components.seat)
    return components._replace(
        devices=IsolatedDevices(components.devices, seat),
        commands=IsolatedCommands(components.commands, "ROS"),
        recorder=IsolatedRecorder(components.recorder),
        outputs=[IsolatedOutput(output) for output in components.outputs],
        pace=IsolatedPace(components.pace, spare),
        seat=seat,
        ecu=IsolatedCommands(components.ecu, "CAN"),
        standby=[IsolatedStandby(standby) for standby in components.standby],
    )


class Told:
    """Tells of the first failure of a part."""

    def __init__(self, part: str) -> None:
        self._part = part
        self.failed = False

    def tell(self, error: Exception) -> None:
        """Say it, once."""
        if not self.failed:
            with contextlib.suppress(OSError):  # nobody reads it: a closed terminal, a pipe without a reader
                print(f"simconsole: {self._part} failed: {type(error).__name__}: {error}", file=sys.stderr, flush=True)
        self.failed = True


class IsolatedDevices:
    """Devices; while they raise, they are gone."""

    def __init__(self, devices: DeviceSource, seat: "IsolatedSeat | None" = None) -> None:
        self._devices = devices
        self._seat = seat
        self._told = Told("the cockpit")

    def poll(self, tick: int) -> DeviceSample:
        """Return the newest sample."""
        if self._seat is not None and self._seat.failed:
            return NO_SAMPLE  # the devices stay as they were left, the accelerator perhaps pressed
        try:
            return self._devices.poll(tick)
        except Exception as error:  # noqa: BLE001  whatever it is, the car must come to rest
            self._told.tell(error)
            return NO_SAMPLE

    def close(self) -> None:
        """Release the devices."""
        self._devices.close()


class IsolatedSeat:
    """A person; once it raised, nobody is there."""

    def __init__(self, seat: Seat) -> None:
        self._seat = seat
        self._told = Told("the person in the seat")

    @property
    def failed(self) -> bool:
        """Whether it has raised."""
        return self._told.failed

    def act(self, snapshot: Snapshot) -> None:
        """Act on the devices, for the coming tick."""
        if self._told.failed:
            return
        try:
            self._seat.act(snapshot)
        except Exception as error:  # noqa: BLE001  whatever it is, the car must come to rest
            self._told.tell(error)


class IsolatedPace:
    """A pace; where it raises, the loop has stood still for who knows how long, and another pace goes on."""

    def __init__(self, pace: Pace, spare: Callable[[], Pace]) -> None:
        self._pace = pace
        self._spare = spare
        self._told = Told("the pace")

    def wait(self) -> int:
        """Sleep until the next tick and return the events that pacing itself raised."""
        try:
            return self._pace.wait()
        except Exception as error:  # noqa: BLE001  whatever it is, the car must come to rest
            self._told.tell(error)
            self._pace = self._spare()
            return int(Event.LOOP_STALL)


class IsolatedRecorder:
    """A recorder; once it raised, it is given nothing more: a log with a hole would be worse than a short one."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self._told = Told("the recorder")

    def write(self, snapshot: Snapshot) -> int:
        """Keep one tick and return the events of the next one."""
        if not self._told.failed:
            try:
                return self._recorder.write(snapshot)
            except Exception as error:  # noqa: BLE001  recording may end, driving must not
                self._told.tell(error)
        return int(Event.RECORDING_FAILED)


class IsolatedStandby:
    """Somebody to call while simulated time stands; once it raised, it is called no more."""

    def __init__(self, standby: Standby) -> None:
        self._standby = standby
        self._told = Told(getattr(standby, "__qualname__", type(standby).__name__))

    def __call__(self, snapshot: Snapshot) -> None:
        """Serve, listen or rest for a moment."""
        if self._told.failed:
            return
        try:
            self._standby(snapshot)
        except Exception as error:  # noqa: BLE001  the others must be served, and the drive goes on
            self._told.tell(error)


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


class IsolatedOutput:
    """An output; once it raised, it sees nothing more."""

    def __init__(self, output: Output) -> None:
        self._output = output
        self._told = Told(type(output).__name__)
        if hasattr(output, "hop"):
            self.hop = output.hop

    def publish(self, snapshot: Snapshot) -> None:
        """Show it one tick."""
        if self._told.failed:
            return
        try:
            self._output.publish(snapshot)
        except Exception as error:  # noqa: BLE001  nobody who only looks may stop the car
            self._told.tell(error)
