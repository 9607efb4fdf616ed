"""Faults of the process that the loop runs in: it stands still, or a part of it raises. Pure."""

from collections.abc import Sequence

from simconsole.faults.switched import Switched
from simconsole.tick.loop import Pace
from simconsole.values.protocols import CommandSource, DeviceSource
from simconsole.values.signals import DeviceSample, Event, EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot

STALL_MS = 100.0
"""Longer than this is a stall, as for pacing."""


class InjectedError(RuntimeError):
    """The exception that a `raises` fault raises."""


class StallingPace:
    """A pace that reports a stall of the loop in the tick after the fault's first one."""

    def __init__(self, pace: Pace, stalls: Sequence[tuple[float, Switched]]) -> None:
        self._pace = pace
        self._stalls = stalls
        self._told: set[int] = set()

    def wait(self) -> int:
        """Wait as the pace does; a stall longer than 100 ms is an event."""
        raised = self._pace.wait()
        for number, (stall_ms, switch) in enumerate(self._stalls):
            if switch.ticks > 0 and number not in self._told:
                self._told.add(number)
                if stall_ms > STALL_MS:
                    raised |= int(Event.LOOP_STALL)
        return raised


class RaisingDevices:
    """Devices that raise while the fault is on."""

    def __init__(self, devices: DeviceSource, switches: Sequence[Switched]) -> None:
        self._devices = devices
        self._switches = switches

    def poll(self, tick: int) -> DeviceSample:
        """Raise, or poll."""
        raise_if(self._switches, "devices")
        return self._devices.poll(tick)

    def close(self) -> None:
        """Close the devices."""
        self._devices.close()


class RaisingCommands:
    """A command source that raises while the fault is on."""

    def __init__(self, source: CommandSource, switches: Sequence[Switched]) -> None:
        self._source = source
        self._switches = switches

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Raise, or take."""
        raise_if(self._switches, "commands")
        return self._source.take(tick)


class RaisingOutput:
    """An output that raises while the fault is on."""

    def __init__(self, switches: Sequence[Switched]) -> None:
        self._switches = switches

    def publish(self, snapshot: Snapshot) -> None:
        """Raise, or do nothing."""
        raise_if(self._switches, "output")


def raise_if(switches: Sequence[Switched], part: str) -> None:
    """Raise while one of the faults is on.

    Raises:
        InjectedError: it is.
    """
    if any(switch.ticks > 0 for switch in switches):
        raise InjectedError(f"{part}: a fault of the scenario")
