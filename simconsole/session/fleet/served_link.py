"""The rosbridge server of several platforms as one of them sees it where a clock paces the drive."""

from typing import Any

from simconsole.session.lockstep import LockstepServer
from simconsole.values.latency import Hop
from simconsole.values.signals import EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot


class ServedLink:
    """Publishes what is due and serves what has arrived in each tick, and waits for nobody."""

    hop = Hop.EXCHANGE

    def __init__(self, port: LockstepServer) -> None:
        """Take the platform's port of the server."""
        self._port = port

    def publish(self, snapshot: Snapshot) -> None:
        """Publish what is due and serve what has arrived."""
        self._port.publish(snapshot)

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command, its age in ticks, and the edges."""
        return self._port.take(tick)

    def stand(self, snapshot: Snapshot) -> None:
        """Serve what has arrived while simulated time stands; the pace waits."""
        self._port.stand(0.0)

    def take_acts(self) -> list[bytes]:
        """Return what operators have done since the last call, each as JSON."""
        return self._port.take_acts()

    def counters(self) -> dict[str, Any]:
        """Return what the server counted."""
        return {"bridge": self._port.counts()}

    @property
    def clients(self) -> int:
        """Clients that hear the platform's odometry."""
        return self._port.clients
