"""One of several platforms on the rosbridge server that they share in lockstep."""

from collections.abc import Callable, Sequence
from typing import Self

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.input_slots import Question
from simconsole.bridge.console.surroundings import Surroundings
from simconsole.bridge.transport.lockstep_server import LockstepBridge, acts_of, in_lockstep, listeners
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.signals import EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot


class LockstepPort:
    """Topics, commander and command slot of one platform: what the drive loop needs of a bridge in lockstep.

    Attributes:
        console: the platform's topics and its slot.
    """

    def __init__(self, bridge: LockstepBridge, console: ConsoleBridge) -> None:
        """Take the server and what is on it of the platform."""
        self._bridge = bridge
        self.console = console

    @classmethod
    def of_first(cls, bridge: LockstepBridge) -> Self:
        """Return the port of the platform whose server it is."""
        return cls(bridge, bridge.console)

    @classmethod
    def beside(cls, bridge: LockstepBridge, profile: BridgeProfile, odometry_hz: float, around: Surroundings) -> Self:
        """Add the topics of a further platform to the server and return its port.

        Args:
            bridge: the server.
            profile: with the platform's namespace, else as that of the first platform.
            odometry_hz: rate of its odometry: the control rate.
            around: what there is to tell of beside the state vector.

        Raises:
            ProfileError: as `ConsoleBridge`.
        """
        return cls(bridge, ConsoleBridge(in_lockstep(profile, odometry_hz), around=around, beside=bridge.console))

    def ask(self, snapshot: Snapshot) -> Question:
        """Publish; return what answers this very snapshot, as `LockstepBridge.ask`."""
        return self._bridge.ask(snapshot, self.console)

    def hear(self, asked: Sequence[Question], timeout_s: float, stop: Callable[[], bool]) -> list[bool]:
        """Wait for the answers to questions of any platforms, as `LockstepBridge.hear`."""
        return self._bridge.hear(asked, timeout_s, stop)

    def exchange(self, snapshot: Snapshot, timeout_s: float, stop: Callable[[], bool]) -> bool:
        """Publish, then wait for the command that answers this very snapshot, as `LockstepBridge.exchange`."""
        return self._bridge.exchange(snapshot, timeout_s, stop, self.console)

    def publish(self, snapshot: Snapshot) -> None:
        """Publish what is due, without waiting."""
        self._bridge.publish(snapshot, self.console)

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command with its age for the coming `tick`, and all edges since the last call."""
        return self.console.inputs.take(tick)

    def stand(self, timeout_s: float) -> None:
        """Serve for a short time without publishing anything."""
        self._bridge.stand(timeout_s)

    def counts(self) -> dict[str, int]:
        """Return how many messages went to and from all clients of the server."""
        return self._bridge.counts()

    @property
    def clients(self) -> int:
        """How many clients hear the platform's odometry."""
        return listeners(self.console)

    def take_acts(self) -> list[bytes]:
        """Return what operators have done with the platform since the last call, each as JSON."""
        return acts_of(self.console)
