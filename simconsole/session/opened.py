"""What a drive consists of once it is open, and what headless and paced drives open alike."""

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from simconsole.bridge.link.delay import over_link
from simconsole.session.traffic_source import TrafficSource, open_traffic
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.tick.loop import Components, Pace
from simconsole.values.protocols import CommandSource, DeviceIdentity, Output
from simconsole.values.state_vector import Snapshot


class Opened(NamedTuple):
    """The components of a drive, ready to run."""

    components: Components
    finished: Callable[[Snapshot], bool]
    summary: Callable[[], dict[str, Any]]
    bridge_url: str | None = None
    """Where the bridge listens, of a paced drive."""
    identities: tuple[DeviceIdentity, ...] = ()
    """Of the cockpit's devices."""
    left: Callable[[], bool] = lambda: False
    """Whether the driver has closed the window, or the drive cannot go on: it ends in order, as by a signal."""
    failure: Callable[[], BaseException | None] = lambda: None
    """What a lab's own code has raised; it has ended the drive."""


class LinkAmong(CommandSource, Output, Protocol):
    """What one of several platforms has of the server that they share, where a clock paces the drive."""

    def stand(self, snapshot: Snapshot) -> None:
        """Serve while simulated time stands."""

    def take_acts(self) -> list[bytes]:
        """Return what operators have done since the last call."""

    def counters(self) -> dict[str, Any]:
        """Return what the drive's summary says of it."""


class PaceAmong(Pace, Protocol):
    """The pace of several platforms, as one of them sees it."""

    def summary(self) -> dict[str, Any]:
        """Return what the drive's summary says of it."""


class Among(NamedTuple):
    """What one platform of a paced session has with the others."""

    others: TrafficSource | None
    """Its road users; None for a robot."""
    link: LinkAmong | None
    """Its topics on the server that they share; None without one."""
    pace: PaceAmong
    not_granted: list[str]
    """What the system has not granted to the process, once it has been asked (`realtime_hints`)."""


def traffic_of(
    resolved: ResolvedSession, console: Console, stack: ExitStack, run_folder: Path | None = None
) -> TrafficSource | None:
    """Open the session's road users, to be closed with the drive; None where it has none."""
    traffic = open_traffic(resolved, console, run_folder)
    if traffic is not None:
        stack.callback(traffic.close)
    return traffic


def outputs_of(traffic: TrafficSource | None) -> tuple[Output, ...]:
    """Return what traffic must be told of each tick."""
    return () if traffic is None else (traffic,)


def summary_of(traffic: TrafficSource | None) -> dict[str, Any]:
    """Return what the summary of a drive tells of its traffic."""
    return {} if traffic is None else traffic.summary()


def commands_over_link(source: CommandSource, resolved: ResolvedSession, console: Console) -> CommandSource:
    """Return the ROS side's commands as they arrive over the link that the session describes."""
    bridge = resolved.session.outputs.bridge
    return source if bridge is None else over_link(source, bridge.link, console.tick_hz)
