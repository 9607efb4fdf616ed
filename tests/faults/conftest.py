import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from simconsole.bridge.transport.lockstep_server import LockstepBridge
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.signals import RemoteCommand
from tests.bridge.fixtures import Served, bridge, control, join, make_snapshot, peer, serving, snapshot, transport
from tests.patience import PATIENCE_S

__all__ = ["bridge", "control", "join", "peer", "serving", "snapshot", "transport"]


class ServerEdge:
    """The server of a process of its own."""

    def __init__(self, profile: BridgeProfile) -> None:
        self._served = Served(profile)
        self.port, self.url = self._served.port, self._served.url
        self._newest: RemoteCommand | None = None

    def applied(self) -> float:
        """The newest command's angle at the road wheels."""
        while not self._served.commands.empty():
            self._newest = self._served.command()
        assert self._newest is not None
        return self._newest.road_wheel_rad

    def stop(self) -> None:
        self._served.stop()


class LockstepEdge:
    """The server inside of a tick loop, which turns without end here; simulated time stands."""

    def __init__(self, profile: BridgeProfile) -> None:
        self._bridge = LockstepBridge(profile)
        self.port, self.url = self._bridge.port, self._bridge.url
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        while not self._stop.is_set():
            self._bridge.publish(make_snapshot(1))
            self._stop.wait(0.0005)

    def applied(self) -> float:
        """The newest command's angle at the road wheels."""
        return self._bridge.take(1)[0].road_wheel_rad

    def stop(self) -> None:
        self._stop.set()
        self._thread.join(timeout=PATIENCE_S)
        assert not self._thread.is_alive()
        self._bridge.close()


EDGES = {
    "server": (ServerEdge, "websockets"),
    "picows": (ServerEdge, "picows"),
    "lockstep": (LockstepEdge, "websockets"),
}


@pytest.fixture(params=EDGES)
def edge(request: pytest.FixtureRequest) -> Iterator[Callable[..., Any]]:
    """Start each server with a profile on a free port; it is stopped at the end."""
    started: list[Any] = []
    kind, transport = EDGES[request.param]

    def start(**profile: Any) -> Any:
        given = {"port": 0, "lease_ms": 10_000.0, "transport": transport, **profile}
        started.append(kind(BridgeProfile(**given)))
        return started[-1]

    yield start
    for server in started:
        server.stop()
