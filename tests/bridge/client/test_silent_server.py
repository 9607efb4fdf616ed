"""A server that says nothing: its machine is gone, it waits for others, or it hangs."""

import math
import threading
from collections.abc import Callable
from typing import Any

import pytest
from websockets.sync.server import ServerConnection
from websockets.sync.server import serve as serve_websockets

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.protocol.backoff import HUNG_AFTER_S
from tests.bridge.networks import far_end, go_deaf
from tests.patience import PATIENCE_S, stamp_ns, wait_until


def test_silent_server_whose_machine_is_gone_is_given_up(serving: Callable[..., Any]) -> None:
    server = serving()
    with BridgeClient(server.url, first_s=0.01, cap_s=0.02) as client:
        assert client.receive(0.05) is None
        assert client.state == "connected"
        assert client._connection._socket is not None
        with far_end(client._connection._socket) as far:
            go_deaf(far)
        client.advertise("/a", "std_msgs/String")
        # As if three seconds had passed in silence, and a ping had not been answered.
        client._liveness.begin(stamp_ns() / 1e9 - 3.5)
        client._connection.heard_s = 0.0
        # One call may both give it up and connect again.
        wait_until(lambda: client.receive(0.01) is None and client.connections == 2, "the next connection")
        assert "silent" in client.failure
        assert client.state == "connected"


def test_silent_server_whose_machine_acknowledges_is_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """A console in lockstep that waits for SUMO or for another controller says nothing, and answers no ping."""
    wakes = threading.Event()
    heard: list[Any] = []

    def handler(peer: ServerConnection) -> None:
        assert wakes.wait(PATIENCE_S)
        peer.send('{"op":"publish","topic":"/s","msg":{"data":"at last"}}')
        heard.extend(peer)

    with serve_websockets(handler, "127.0.0.1", 0, ping_interval=None) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        with BridgeClient(f"ws://127.0.0.1:{server.socket.getsockname()[1]}") as client:
            client.subscribe("/s", "std_msgs/String")
            client.connect()
            monkeypatch.setattr(client._connection, "ping", lambda: None)  # the stock server would answer it
            for _ in range(5):
                client._liveness.begin(stamp_ns() / 1e9 - 3.5)
                client._connection.heard_s = 0.0
                assert client.receive(0.02) is None
            wakes.set()
            received = client.receive(PATIENCE_S)
            assert received is not None
            assert received.message.data == "at last"
            assert client.connections == 1
            client._liveness.begin(stamp_ns() / 1e9 - HUNG_AFTER_S)
            client._connection.heard_s = 0.0
            assert client.receive(0.02) is None
            assert "silent" in client.failure, "it hangs, or something between acknowledges in its place"
        server.shutdown()
        thread.join(timeout=PATIENCE_S)


def test_a_server_may_be_silent_for_as_long_as_the_client_allows(serving: Callable[..., Any]) -> None:
    with BridgeClient(serving().url, dead_after_s=math.inf) as client:
        assert client.receive(0.05) is None
        client._liveness.begin(stamp_ns() / 1e9 - 3600.0)
        client._connection.heard_s = 0.0
        assert client.receive(0.0) is None
        assert (client.state, client.connections) == ("connected", 1)


def test_ping_keeps_a_quiet_connection(serving: Callable[..., Any]) -> None:
    with BridgeClient(serving().url) as client:
        client.receive(0.01)
        client._liveness.begin(stamp_ns() / 1e9 - 1.5)
        client._connection.heard_s = 0.0
        wait_until(lambda: client.receive(0.01) is None and client._connection.heard_s > 0.0, "the answer to its ping")
        assert client.connections == 1
