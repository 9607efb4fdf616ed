"""An exception in a part of a drive never ends the drive: the part is isolated, and the arbiter reacts to its loss.

Devices that raise count as unplugged, also where the simulated person raises; a controller whose source raises counts
as lost; an output or a recorder that raises is called no more; a pace that raises counts as a stall of the loop, and
another one takes its place. Each failure is reported once, on standard error.
"""

import contextlib
import sys
from collections.abc import Callable

from simconsole.tick.foresight import BlockRecorder, ForeseeingCommands, ForeseeingDevices, PatientOutput
from simconsole.tick.loop import Components, Pace, Recorder, Standby
from simconsole.values.kernels import Row
from simconsole.values.protocols import CommandSource, DeviceSource, Output, Seat
from simconsole.values.signals import NO_COMMAND, NO_SAMPLE, DeviceSample, Event, EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot


def isolated(components: Components, spare: Callable[[], Pace]) -> Components:
    """Return the components of a drive, each isolated; `spare` makes a pace for one that has failed."""
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


def _without_raising(foresee: Callable[[int, Row], int]) -> Callable[[int, Row], int]:
    """Return a `foresee` that foresees nothing where it would raise: `poll` or `take` will tell."""

    def safely(tick: int, rows: Row) -> int:
        try:
            return foresee(tick, rows)
        except Exception:  # noqa: BLE001  told by the call for the single tick, which comes next
            return 0

    return safely


class Told:
    """Reports the first failure of a part."""

    def __init__(self, part: str) -> None:
        self._part = part
        self.failed = False

    def tell(self, error: Exception) -> None:
        """Report the error on standard error, once."""
        if not self.failed:
            with contextlib.suppress(OSError):  # a closed terminal, a pipe without a reader
                print(f"simconsole: {self._part} failed: {type(error).__name__}: {error}", file=sys.stderr, flush=True)
        self.failed = True


class IsolatedDevices:
    """Devices; while they raise, they count as unplugged."""

    def __init__(self, devices: DeviceSource, seat: "IsolatedSeat | None" = None) -> None:
        self._devices = devices
        self._seat = seat
        self._told = Told("the cockpit")
        if isinstance(devices, ForeseeingDevices):
            self.foresee = _without_raising(devices.foresee)

    def poll(self, tick: int) -> DeviceSample:
        """Return the newest sample."""
        if self._seat is not None and self._seat.failed:
            return NO_SAMPLE  # nobody moves the devices any more; the accelerator may be pressed
        try:
            return self._devices.poll(tick)
        except Exception as error:  # noqa: BLE001  whatever it is, the car must come to rest
            self._told.tell(error)
            return NO_SAMPLE

    def close(self) -> None:
        """Release the devices."""
        self._devices.close()


class IsolatedSeat:
    """A simulated person; once it raised, it is called no more."""

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
    """A pace; one that raised is replaced by another, and counts as a stall: how long it took is unknown."""

    def __init__(self, pace: Pace, spare: Callable[[], Pace]) -> None:
        self._pace = pace
        self._spare = spare
        self.never_waits = getattr(pace, "never_waits", False)
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
    """A recorder; once it raised, it is called no more: a log with a gap is worse than a short one."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self._told = Told("the recorder")
        if isinstance(recorder, BlockRecorder):
            self._write_block = recorder.write_block
            self.write_block = self._isolated_block

    def write(self, snapshot: Snapshot) -> int:
        """Keep one tick and return the events of the next one."""
        if not self._told.failed:
            try:
                return self._recorder.write(snapshot)
            except Exception as error:  # noqa: BLE001  recording may end, driving must not
                self._told.tell(error)
        return int(Event.RECORDING_FAILED)

    def _isolated_block(self, tick: int, vectors: Row) -> tuple[int, int]:
        if not self._told.failed:
            try:
                return self._write_block(tick, vectors)
            except Exception as error:  # noqa: BLE001  recording may end, driving must not
                self._told.tell(error)
        return len(vectors), int(Event.RECORDING_FAILED)


class IsolatedStandby:
    """A function called while simulated time stands; once it raised, it is called no more."""

    def __init__(self, standby: Standby) -> None:
        self._standby = standby
        self._told = Told(getattr(standby, "__qualname__", type(standby).__name__))

    def __call__(self, snapshot: Snapshot) -> None:
        """Serve, listen or sleep for a short time."""
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
        if isinstance(source, ForeseeingCommands):
            self.foresee = _without_raising(source.foresee)

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
    """An output; once it raised, it is called no more."""

    def __init__(self, output: Output) -> None:
        self._output = output
        self._told = Told(type(output).__name__)
        if hasattr(output, "hop"):
            self.hop = output.hop
        if isinstance(output, PatientOutput):
            self.unseen = output.unseen

    def publish(self, snapshot: Snapshot) -> None:
        """Show it one tick."""
        if self._told.failed:
            return
        try:
            self._output.publish(snapshot)
        except Exception as error:  # noqa: BLE001  nobody who only looks may stop the car
            self._told.tell(error)
