import socket
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from websockets.sync.server import Server, ServerConnection
from websockets.sync.server import serve as serve_websockets

from simconsole.bridge.client import BridgeClient
from simconsole.errors import BridgeError


@pytest.fixture
def faking() -> Iterator[Callable[[Callable[[ServerConnection], None]], str]]:
    """Start a server with a handler of one's own; returns its address."""
    servers: list[tuple[Server, threading.Thread]] = []

    def start(handler: Callable[[ServerConnection], None]) -> str:
        server = serve_websockets(handler, "127.0.0.1", 0)
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        servers.append((server, thread))
        return f"ws://127.0.0.1:{server.socket.getsockname()[1]}"

    yield start
    for server, thread in servers:
        server.shutdown()
        thread.join(timeout=10.0)


@pytest.mark.parametrize("url", ["http://localhost", "localhost:9090", "ws://"])
def test_what_is_no_address(url: str) -> None:
    with pytest.raises(BridgeError, match="url: "):
        BridgeClient(url)


def test_nobody_listens() -> None:
    with socket.create_server(("127.0.0.1", 0)) as closed:
        port = closed.getsockname()[1]
    with pytest.raises(BridgeError, match="cannot connect"):
        BridgeClient(f"ws://127.0.0.1:{port}").connect()


def test_somebody_listens_but_says_nothing() -> None:
    with socket.create_server(("127.0.0.1", 0)) as mute:
        client = BridgeClient(f"ws://127.0.0.1:{mute.getsockname()[1]}", connect_timeout_s=0.05)
        with pytest.raises(BridgeError, match="no answer within"):
            client.connect()
        assert not client.connected


def test_server_that_is_none() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        client = BridgeClient(f"ws://127.0.0.1:{listener.getsockname()[1]}")

        def answer() -> None:
            peer, _ = listener.accept()
            with peer:
                peer.recv(1000)
                peer.sendall(b"SSH-2.0-x\r\n\r\n")

        thread = threading.Thread(target=answer)
        thread.start()
        with pytest.raises(BridgeError, match="refused"):
            client.connect()
        thread.join(timeout=10.0)


def test_not_connected_is_said() -> None:
    client = BridgeClient("ws://127.0.0.1:1")
    client.subscribe("/s", "std_msgs/String")
    client.advertise("/s", "std_msgs/String")
    with pytest.raises(BridgeError, match="not connected"):
        client.publish("/s", {"data": "x"})
    with pytest.raises(BridgeError, match="not connected"):
        client.receive(0.0)
    client.close()


def test_wishes_made_before_and_after_connecting_hold_again_after_another_connect(serving: Callable[..., Any]) -> None:
    server = serving()
    with BridgeClient(server.url) as client, BridgeClient(server.url) as other:
        client.subscribe("/a", "std_msgs/String")
        client.connect()
        client.subscribe("/b", "std_msgs/String")
        client.advertise("/talk", "std_msgs/String")
        client.connect()
        other.connect()
        other.subscribe("/talk", "std_msgs/String")
        other.advertise("/a", "std_msgs/String")
        other.advertise("/b", "std_msgs/String")
        for topic in ("/a", "/b"):
            heard = None
            while heard is None:
                other.publish(topic, {"data": topic})
                heard = client.receive(0.05)
            while heard is not None:
                assert heard.message.data in ("/a", "/b")
                heard = client.receive(0.05)
        client.publish("/talk", {"data": "hello"})
        received = other.receive(10.0)
        assert received is not None
        assert (received.topic, received.message.data) == ("/talk", "hello")
        client.unsubscribe("/a")
        client.unadvertise("/talk")


def test_time_out_returns_none_and_the_connection_stays(
    serving: Callable[..., Any], snapshot: Callable[..., Any]
) -> None:
    server = serving()
    with BridgeClient(server.url) as client:
        client.connect()
        client.subscribe("/odom", "nav_msgs/Odometry")
        assert client.receive(0.01) is None
        assert client.connected
        client.advertise("/odom", "nav_msgs/Odometry")
        while not client.statuses:
            client.receive(0.01)
        assert "only the console publishes" in client.statuses[0].msg
        server.snapshots.put(snapshot(5))
        assert client.receive(10.0) is not None


def test_server_that_goes_is_an_error_after_everything_received(
    faking: Callable[[Callable[[ServerConnection], None]], str],
) -> None:
    def handler(peer: ServerConnection) -> None:
        peer.recv()
        for word in ("one", "two"):
            peer.send(f'{{"op":"publish","topic":"/s","msg":{{"data":"{word}"}}}}')

    with BridgeClient(faking(handler)) as client:
        client.connect()
        client.subscribe("/s", "std_msgs/String")
        received = [client.receive(10.0) for _ in range(2)]
        assert [each is not None and each.message.data for each in received] == ["one", "two"]
        with pytest.raises(BridgeError, match=r"closed by the server|not connected"):
            client.receive(10.0)
        assert not client.connected


def test_server_s_oddities_are_survived(faking: Callable[[Callable[[ServerConnection], None]], str]) -> None:
    def handler(peer: ServerConnection) -> None:
        peer.recv()
        peer.send(b"binary")
        peer.ping().wait(10.0)
        peer.send("nonsense")
        peer.send(['{"op":"publish","topic":"/s",', '"msg":{"data":', '"in three pieces"}}'])
        peer.recv()

    with BridgeClient(faking(handler)) as client:
        client.connect()
        client.subscribe("/s", "std_msgs/String")
        received = client.receive(10.0)
        assert received is not None
        assert received.message.data == "in three pieces"
        assert client.protocol.refused == 2
        client.unsubscribe("/s")
