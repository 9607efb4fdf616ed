"""The node on its bus: in a worker process beside a paced drive, and in the loop of a headless one."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from simconsole.canbus.bus.port import LOG_FILES, CanPort
from simconsole.canbus.codec import Codec
from simconsole.canbus.node import CanNode
from simconsole.canbus.schedule import Phase
from simconsole.profiles.can import CanProfile
from simconsole.profiles.files.loader import read_text
from simconsole.values.signals import Event, EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot

DBC: Final = "simconsole.dbc"
_CYCLE_S: Final = 0.001
"""How long the worker waits for a frame before it looks again for a tick that should be there by now."""
_LONGEST_S: Final = 0.1
_STATUS_S: Final = 1.0
_FRAMES_MAX: Final = 64
"""Frames taken in one tick of a headless drive: a flood must not stop simulated time."""

OnCommand = Callable[[RemoteCommand, int | None], None]
OnStatus = Callable[[dict[str, Any]], None]


def load_codec() -> Codec:
    """Return the codec of the DBC that simconsole ships.

    Raises:
        ProfileError: the installation is damaged.
    """
    return Codec(read_text("can", DBC))


def log_paths(profile: CanProfile, folder: Path) -> list[Path]:
    """Return the files of the logs that a profile asks for, in a bundle's folder."""
    return [folder / LOG_FILES[kind] for kind in dict.fromkeys(profile.log)]


class OnBus:
    """A node with its port: the part that paced and headless drives share."""

    def __init__(self, node: CanNode, port: CanPort) -> None:
        self.node = node
        self.port = port
        self._was_up = True

    def send(self, snapshot: Snapshot, now_ns: int) -> None:
        """Send what is due; nothing while the bus is down."""
        for frame in self.node.transmit(snapshot, now_ns):
            self.port.send(frame)

    def take(self, timeout_s: float, clock_ns: Callable[[], int]) -> tuple[bool, int]:
        """Take at most one frame; return whether there was one, and the events (mask) that it or the bus raised."""
        frame = self.port.receive(timeout_s)
        up = self.port.recovery.up
        events = 0
        if self._was_up and not up and self.node.receipt_ns is not None:
            events = int(Event.COMMANDER_LOST)
        self._was_up = up
        if frame is None:
            return False, events
        return True, events | self.node.receive(frame, clock_ns())

    def status(self, now_ns: int) -> dict[str, Any]:
        """Return counters and states, for the summary."""
        recovery = self.port.recovery
        return {
            "up": recovery.up,
            "down_reason": recovery.reason,
            "command_state": self.node.state(now_ns).name,
            "node": self.node.counters()._asdict(),
            "port": self.port.counters()._asdict(),
        }


def serve(
    on_bus: OnBus,
    snapshots: Callable[[], Snapshot | None],
    on_command: OnCommand,
    on_events: Callable[[int], None],
    on_status: OnStatus,
    stop: Callable[[], bool],
) -> None:
    """Run the node until `stop`. Without a new tick it sends nothing: a console that hangs becomes silent on the bus.

    Args:
        on_bus: node and open port; closed by the caller.
        snapshots: returns the newest snapshot once, None when there is no new one.
        on_command: takes each changed command and its receipt.
        on_events: takes a mask of `signals.Event`.
        on_status: takes `OnBus.status` about once a second, when the bus goes off or comes back, and at the end.
        stop: ends the worker.
    """
    node, clock_ns = on_bus.node, time.monotonic_ns
    written = node.command
    status_ns, told_up = 0, True
    expected_s, phase = 0.0, Phase(node.tick_hz)
    while not stop():
        snapshot = snapshots()
        now_ns = clock_ns()
        if snapshot is not None:
            on_bus.send(snapshot, now_ns)
            phase.saw(snapshot.tick, now_ns / 1e9)
            expected_s = phase.expected_s(node.next_tick(snapshot.tick))
        wait_s = min(max(_CYCLE_S, expected_s - clock_ns() / 1e9), _LONGEST_S)
        _, events = on_bus.take(wait_s, clock_ns)
        if node.command is not written:
            written = node.command
            on_command(written, node.receipt_ns)
        if events:
            on_events(events)
        if now_ns - status_ns >= _STATUS_S * 1e9 or on_bus.port.recovery.up != told_up:
            status_ns, told_up = now_ns, on_bus.port.recovery.up
            on_status(on_bus.status(now_ns))
    on_status(on_bus.status(clock_ns()))


class HeadlessCan:
    """The same node inside a headless drive's loop: a reader of snapshots, and where commands come from.

    Time is the drive's own: a frame that is there after tick k has age 0 in tick k + 1.
    """

    def __init__(self, on_bus: OnBus) -> None:
        self._on_bus = on_bus
        self._tick = 0
        self._receipt_tick = 0
        self._now_ns = 0
        self._events = 0

    def publish(self, snapshot: Snapshot) -> None:
        """Take the frames that are there, then send what is due."""
        self.listen(snapshot)
        self._on_bus.send(snapshot, snapshot.t_ns)

    def listen(self, snapshot: Snapshot) -> None:
        """Take the frames that are there; nothing else is done while simulated time stands."""
        self._tick, self._now_ns = snapshot.tick, snapshot.t_ns
        node = self._on_bus.node
        before = node.command.sequence
        for _ in range(_FRAMES_MAX):
            found, events = self._on_bus.take(0.0, lambda: snapshot.t_ns)
            self._events |= events
            if not found:
                break
        if node.command.sequence != before:
            self._receipt_tick = snapshot.tick

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command, its age in ticks, and the edges since the last call."""
        events, self._events = self._events, 0
        command = self._on_bus.node.command
        if self._on_bus.node.receipt_ns is not None:
            command = command._replace(age_ticks=float(max(0, tick - 1 - self._receipt_tick)))
        return command, EventInput(events=float(events))

    def summary(self) -> dict[str, Any]:
        """Return counters and states."""
        return {"can": self._on_bus.status(self._now_ns)}


def put_on_bus(
    profile: CanProfile,
    tick_hz: int,
    *,
    wheels: tuple[int, ...] | None,
    folder: Path,
) -> OnBus:
    """Open the bus with the console on it; logs go into `folder`. The caller closes `port`.

    Raises:
        CanError: the bus or a log cannot be opened.
        ProfileError: the DBC is missing.
    """
    node = CanNode(load_codec(), profile, tick_hz, wheels=wheels)
    port = CanPort(profile, node.transmit_ids, node.receive_ids, logs=log_paths(profile, folder))
    return OnBus(node, port)
