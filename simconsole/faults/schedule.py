"""Faults put into a drive: the clock that says which are on, and the layers that each kind acts through. Pure.

`SERVES` is the one place that maps each kind of fault to its layer: a layer takes the components of a drive and its
own faults and returns the components, some of them wrapped. The recorder keeps what comes out of a layer, so a replay
needs no faults; the state vector tells which were on (`events.faults`, a bit for each place in the list).
"""

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple, get_args

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.faults.cockpit_faults import FaultyDevices
from simconsole.faults.command_faults import FaultyCommands
from simconsole.faults.process_faults import RaisingCommands, RaisingDevices, RaisingOutput, StallingPace
from simconsole.faults.switched import Switched
from simconsole.profiles import faults as kinds
from simconsole.profiles.faults import Fault, Onset
from simconsole.tick.assembly import ResolvedSession
from simconsole.tick.loop import Components
from simconsole.tick.triggers import TriggerWatch
from simconsole.values.state_vector import Snapshot


class Armed(NamedTuple):
    """A fault of the list and its switch."""

    fault: Fault
    switch: "Switch"


class Switch:
    """Whether one fault is on in the coming tick."""

    def __init__(self, onset: Onset, tick_hz: int) -> None:
        self._watch = TriggerWatch(onset, tick_hz)
        self._length = None if onset.for_s is None else max(1, round(onset.for_s * tick_hz))
        self.ticks = 0
        """How many ticks it has been on, the coming one included; 0 while it is off."""

    def turn(self, tick: int, before: Snapshot) -> None:
        """Decide about `tick` from the tick before it."""
        start = self._watch.turn(tick, before)
        on = start is not None and tick >= start and (self._length is None or tick < start + self._length)
        self.ticks = self.ticks + 1 if on else 0


class FaultClock:
    """All faults of a drive; turned once a tick, before anything is read."""

    def __init__(self, faults: Sequence[Fault], tick_hz: int) -> None:
        self.armed = tuple(Armed(fault, Switch(fault, tick_hz)) for fault in faults)

    def turn(self, tick: int, before: Snapshot) -> float:
        """Return which faults are on in `tick` as the bits of `EventInput.faults`."""
        mask = 0
        for place, (_, switch) in enumerate(self.armed):
            switch.turn(tick, before)
            mask |= (switch.ticks > 0) << place
        return float(mask)


class Setting(NamedTuple):
    """The facts about the drive that a layer may use."""

    resolved: ResolvedSession
    tick_hz: int


Layer = Callable[[Components, Sequence[Armed], Setting], Components]


def devices(components: Components, armed: Sequence[Armed], setting: Setting) -> Components:
    """Put device faults between the devices and the console."""
    cockpit, tick_hz = setting.resolved.cockpit, setting.tick_hz
    faulty = FaultyDevices(components.devices, armed, cockpit, cockpit_settings(cockpit, tick_hz), tick_hz)
    return components._replace(devices=faulty)


def controllers(components: Components, armed: Sequence[Armed], setting: Setting) -> Components:
    """Put command faults between the controllers and the arbiter."""
    ros = [entry for entry in armed if entry.fault.controller == "ros"]  # type: ignore[union-attr]  # CommandFault
    can = [entry for entry in armed if entry.fault.controller == "can"]  # type: ignore[union-attr]  # CommandFault
    return components._replace(
        commands=FaultyCommands(components.commands, ros, setting.tick_hz) if ros else components.commands,
        ecu=FaultyCommands(components.ecu, can, setting.tick_hz) if can else components.ecu,
    )


def process(before: Components, armed: Sequence[Armed], setting: Setting) -> Components:
    """Make the loop stall and its parts raise."""
    switches: dict[str, list[Switched]] = {}
    for fault, switch in armed:
        if isinstance(fault, kinds.Raises):
            switches.setdefault(fault.part, []).append(switch)
    stalls = [(fault.stall_ms, switch) for fault, switch in armed if isinstance(fault, kinds.Stall)]
    return before._replace(
        pace=StallingPace(before.pace, stalls) if stalls else before.pace,
        devices=RaisingDevices(before.devices, switches["devices"]) if "devices" in switches else before.devices,
        commands=RaisingCommands(before.commands, switches["ros"]) if "ros" in switches else before.commands,
        ecu=RaisingCommands(before.ecu, switches["can"]) if "can" in switches else before.ecu,
        outputs=(*before.outputs, RaisingOutput(switches["outputs"])) if "outputs" in switches else before.outputs,
    )


SERVES: Final[dict[type[Onset], Layer]] = {
    **dict.fromkeys(get_args(kinds.DeviceFault), devices),
    **dict.fromkeys(get_args(kinds.CommandFault), controllers),
    **dict.fromkeys(get_args(kinds.ProcessFault), process),
}
"""The layer of every kind of fault."""


def with_faults(components: Components, resolved: ResolvedSession, tick_hz: int) -> Components:
    """Return the components of a drive wrapped in the faults of its scenario; unchanged where there are none.

    Raises:
        ProfileError: a fault does not fit this cockpit.
    """
    faults = resolved.session.scenario.faults
    if not faults:
        return components
    clock = FaultClock(faults, tick_hz)
    for layer in dict.fromkeys(SERVES.values()):
        armed = [entry for entry in clock.armed if SERVES[type(entry.fault)] is layer]
        if armed:
            components = layer(components, armed, Setting(resolved, tick_hz))
    return components._replace(faults=clock)
