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
from simconsole.values.signals import Button, Event, Mode
from simconsole.values.state_vector import Snapshot


class Armed(NamedTuple):
    """A fault of the list and its switch."""

    fault: Fault
    switch: "Switch"


class Switch:
    """Whether one fault is on in the coming tick."""

    def __init__(self, onset: Onset, tick_hz: int) -> None:
        self._onset = onset
        self._tick_hz = tick_hz
        self._delay = round(onset.delay_s * tick_hz)
        self._start = None if onset.at_s is None else round(onset.at_s * tick_hz) + self._delay
        self.ticks = 0
        """How many ticks it has been on, the coming one included; 0 while it is off."""

    def turn(self, tick: int, before: Snapshot) -> None:
        """Decide about `tick` from the tick before it."""
        if self._start is None and self._reached(before):
            self._start = tick + self._delay
        length = None if self._onset.for_s is None else max(1, round(self._onset.for_s * self._tick_hz))
        on = self._start is not None and tick >= self._start and (length is None or tick < self._start + length)
        self.ticks = self.ticks + 1 if on else 0

    def _reached(self, before: Snapshot) -> bool:
        onset = self._onset
        if onset.at_distance_m is not None:
            return before.vehicle.distance_m >= onset.at_distance_m
        if onset.near is not None:
            x, y = before.vehicle.x_m - onset.near.x_m, before.vehicle.y_m - onset.near.y_m
            return x * x + y * y <= onset.near.radius_m * onset.near.radius_m
        if onset.on_mode is not None:
            return before.arbitration.mode == float(Mode[onset.on_mode.upper()])
        if onset.on_event is not None:
            pressed = int(before.driver.edges) & Button.FAULT and onset.on_event == "fault"
            return bool(int(before.events.events) & Event[onset.on_event.upper()] or pressed)
        return False


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
        outputs=(*before.outputs, RaisingOutput(switches["stations"])) if "stations" in switches else before.outputs,
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
