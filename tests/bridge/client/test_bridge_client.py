import select
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request
from websockets.protocol import State
from websockets.server import ServerProtocol
from websockets.sync.server import Server, ServerConnection
from websockets.sync.server import serve as serve_websockets

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.protocol.client_protocol import Goal
from simconsole.values.errors import BridgeError, LocalProtocolError
from tests.patience import PATIENCE_S, wait_until


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
        thread.join(timeout=PATIENCE_S)


def accepted(peer: socket.socket) -> ServerProtocol:
    """Read a client's handshake; the answer to it waits to be sent."""
    web = ServerProtocol()
    while web.state is State.CONNECTING:
        web.receive_data(peer.recv(1000))
        for event in web.events_received():
            assert isinstance(event, Request)
            web.send_response(web.accept(event))
    return web


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
        client = BridgeClient(f"ws://127.0.0.1:{mute.getsockname()[1]}", timeout_s=0.05)
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
        thread.join(timeout=PATIENCE_S)


def test_not_connected_is_said() -> None:
    client = BridgeClient("ws://127.0.0.1:1", comes_back=False)
    client.subscribe("/s", "std_msgs/String")
    client.advertise("/s", "std_msgs/String")
    with pytest.raises(BridgeError, match="not connected"):
        client.publish("/s", {"data": "x"})
    with pytest.raises(BridgeError, match="not connected"):
        client.receive(0.0)
    client.disconnect()


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
        received = other.receive(PATIENCE_S)
        assert received is not None
        assert (received.topic, received.message.data) == ("/talk", "hello")
        client.unsubscribe("/a")
        client.unadvertise("/talk")


def test_answers_to_what_came_together_go_together(faking: Callable[..., str], monkeypatch: pytest.MonkeyPatch) -> None:
    heard: list[bytes] = []

    def serve(server: ServerConnection) -> None:
        texts = [b'{"op":"publish","topic":"/%s","msg":{"data":"?"}}' % topic for topic in (b"a", b"b", b"c")]
        server.socket.sendall(b"".join(bytes((0x81, len(text))) + text for text in texts))  # whole frames, unmasked
        with suppress(ConnectionClosed):
            while True:
                heard.append(server.recv(decode=False))

    with BridgeClient(faking(serve), answers_together=True) as client:
        client.advertise("/talk", "std_msgs/String")
        for topic in ("/a", "/b", "/c"):
            client.subscribe(topic, "std_msgs/String")
        client.connect()
        sent: list[int] = []
        send = client._connection.send

        def counting(*texts: bytes) -> None:
            sent.append(len(texts))
            send(*texts)

        monkeypatch.setattr(client._connection, "send", counting)
        for _ in range(3):
            received = client.receive(PATIENCE_S)
            assert received is not None
            if received.topic != "/c":
                client.publish("/talk", {"data": received.topic})
        assert not sent, "nothing goes before all have been looked at"
        client.receive(0.0)
        assert sent == [2]
        client.publish("/talk", {"data": "at once"})
        assert sent == [2, 1]
        wait_until(lambda: len(heard) == 7, "everything said")
    assert [b"/a" in heard[4], b"/b" in heard[5], b"at once" in heard[6]] == [True, True, True]


def test_what_comes_together_with_the_answer_to_the_handshake_is_received() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def serve() -> None:
            peer, _ = listener.accept()
            with peer:
                web = accepted(peer)
                web.send_text(b'{"op":"publish","topic":"/s","msg":{"data":"at once"}}')
                peer.sendall(b"".join(web.data_to_send()))
                while peer.recv(1000):
                    pass

        thread = threading.Thread(target=serve)
        thread.start()
        with BridgeClient(f"ws://127.0.0.1:{listener.getsockname()[1]}") as client:
            client.subscribe("/s", "std_msgs/String")
            client.connect()
            received = client.receive(1.0)
            assert received is not None
            assert received.message.data == "at once"
        thread.join(timeout=PATIENCE_S)


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
        assert client.receive(PATIENCE_S) is not None


def test_server_that_goes_is_an_error_after_everything_received(
    faking: Callable[[Callable[[ServerConnection], None]], str],
) -> None:
    def handler(peer: ServerConnection) -> None:
        peer.recv()
        for word in ("one", "two"):
            peer.send(f'{{"op":"publish","topic":"/s","msg":{{"data":"{word}"}}}}')

    with BridgeClient(faking(handler), comes_back=False) as client:
        client.connect()
        client.subscribe("/s", "std_msgs/String")
        received = [client.receive(PATIENCE_S) for _ in range(2)]
        assert [each is not None and each.message.data for each in received] == ["one", "two"]
        with pytest.raises(BridgeError, match=r"closed by the server|not connected"):
            client.receive(PATIENCE_S)
        assert not client.connected


def test_server_s_oddities_are_survived(faking: Callable[[Callable[[ServerConnection], None]], str]) -> None:
    def handler(peer: ServerConnection) -> None:
        peer.recv()
        peer.send(b"binary")
        peer.ping().wait(PATIENCE_S)
        peer.send("nonsense")
        peer.send(['{"op":"publish","topic":"/s",', '"msg":{"data":', '"in three pieces"}}'])
        peer.recv()

    with BridgeClient(faking(handler)) as client:
        client.connect()
        client.subscribe("/s", "std_msgs/String")
        received = client.receive(PATIENCE_S)
        assert received is not None
        assert received.message.data == "in three pieces"
        assert client.protocol.refused == 2
        client.unsubscribe("/s")


def test_a_programs_own_mistakes_are_not_swallowed(serving: Callable[..., Any]) -> None:
    with BridgeClient(serving().url) as client:
        client.receive(0.01)
        client.advertise("/a", "std_msgs/String")
        with pytest.raises(LocalProtocolError, match="cannot be std_msgs/msg/Bool too"):
            client.advertise("/a", "std_msgs/Bool")
        with pytest.raises(LocalProtocolError, match="advertise it before"):
            client.publish("/b", {})
        client.unadvertise("/a")
        client.subscribe("/a", "std_msgs/String")
        client.unsubscribe("/a")
        assert client.registry.struct("std_msgs/String")


def test_end_in_order_is_the_end_for_who_says_so(serving: Callable[..., Any]) -> None:
    server = serving()
    with BridgeClient(server.url, until_good_bye=True, first_s=0.001) as client:
        assert client.receive(0.05) is None
        server.stop()
        with pytest.raises(BridgeError, match=r"closed by the server \(1001\)"):
            client.receive(PATIENCE_S)
        with pytest.raises(BridgeError, match="not connected"):
            client.receive(PATIENCE_S)


def test_rude_end_is_not(faking: Callable[[Callable[[ServerConnection], None]], str]) -> None:
    def handler(peer: ServerConnection) -> None:
        peer.send('{"op":"publish","topic":"/s","msg":{"data":"here"}}')
        peer.socket.shutdown(socket.SHUT_RDWR)

    with BridgeClient(faking(handler), until_good_bye=True, first_s=0.001) as client:
        client.subscribe("/s", "std_msgs/String")
        for _ in range(3):
            assert client.receive(PATIENCE_S) is not None
        assert client.connections >= 3
        assert "connection" in client.failure


def test_patience_is_for_a_server_that_is_not_there_yet(serving: Callable[..., Any]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = int(listener.getsockname()[1])
    client = BridgeClient(f"ws://127.0.0.1:{port}")
    with pytest.raises(BridgeError, match="cannot connect"):
        client.connect(patience_s=0.1)
    assert not client.connected
    later = threading.Timer(0.1, lambda: serving(port=port))
    later.start()
    client.connect(patience_s=20.0)
    assert client.connected
    later.join()
    client.disconnect()


def test_services_and_actions_both_ways(serving: Callable[..., Any]) -> None:
    server = serving()
    answers: list[tuple[Any, bool]] = []
    told: list[Any] = []

    def add(args: Any) -> Any:
        if args["b"] == 0:
            raise BridgeError("not with 0")
        return {"sum": args["a"] + args["b"]}

    def count(goal: Goal) -> None:
        goal.tell({"sequence": [1]})
        goal.succeed({"sequence": [1, goal.args["order"]]})

    with BridgeClient(server.url) as provider, BridgeClient(server.url) as caller:
        provider.advertise_service("/add", "example_interfaces/AddTwoInts", add)
        provider.advertise_action("/count", "example_interfaces/Fibonacci", count)
        provider.receive(0.05)
        take = lambda values, result: answers.append((values, result))  # noqa: E731  (it is handed on three times)
        assert caller.call_service("/add", {"a": 2, "b": 40}, take)
        assert caller.call_service("/add", {"a": 2, "b": 0}, take)
        assert caller.send_goal("/count", "example_interfaces/Fibonacci", {"order": 7}, take, told.append)
        while len(answers) < 3:
            provider.receive(0.01)
            caller.receive(0.01)
        assert answers == [({"sum": 42}, True), ("not with 0", False), ({"sequence": [1, 7]}, True)]
        assert told == [{"sequence": [1]}]
        provider.unadvertise_service("/add")
        provider.unadvertise_action("/count")
        provider.receive(0.01)
        caller.call_service("/add", {}, take)
        while len(answers) < 4:
            caller.receive(0.01)
        assert answers[3] == ("/add: nobody provides it", False)
        assert caller.call_service("/rosapi/get_time", None, take)
        caller.disconnect()
        assert answers[4] == ("the connection has ended", False)


def test_good_bye_is_heard_by_who_was_busy_when_the_server_said_it_and_went() -> None:
    """It gives clients half a second. What they sent meanwhile and nobody read makes the kernel cut the rest off."""
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def leave() -> None:
            peer, _ = listener.accept()
            with peer:
                web = accepted(peer)
                peer.sendall(b"".join(web.data_to_send()))
                select.select([peer], [], [], PATIENCE_S)  # something has come, which is left unread
                web.send_close(1001)
                peer.sendall(b"".join(web.data_to_send()))

        thread = threading.Thread(target=leave)
        thread.start()
        client = BridgeClient(f"ws://127.0.0.1:{listener.getsockname()[1]}", until_good_bye=True)
        client.connect()
        client.advertise("/s", "std_msgs/String")
        thread.join(timeout=PATIENCE_S)

    def busy() -> None:
        for _ in range(1000):
            client.publish("/s", {"data": "busy"})

    with pytest.raises(BridgeError, match="connection lost"):
        busy()
