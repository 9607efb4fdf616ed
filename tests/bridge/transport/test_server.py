import asyncio
import base64
import http.client
import json
import logging
import math
import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cbor2
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.transport.server import BridgeServer
from simconsole.profiles.bridge import BridgeLimits, BridgeProfile
from simconsole.values.errors import BridgeError
from simconsole.values.signals import Event, RemoteKind
from tests.patience import PATIENCE_S, stamp_ns, until

CONTROL = "/control/command/control_cmd"


def send(peer: ClientConnection, **operation: Any) -> None:
    peer.send(json.dumps(operation))


def answer(peer: ClientConnection) -> dict[str, Any]:
    return json.loads(peer.recv(timeout=PATIENCE_S))  # type: ignore[no-any-return]  # always an object


def settle(peer: ClientConnection) -> None:
    """Return when everything sent before has been applied: a refusal is answered in order."""
    send(peer, op="no_such", id="settle")
    while answer(peer).get("id") != "settle":
        pass


def test_state_goes_out_and_commands_come_in(
    serving: Callable[..., Any], snapshot: Callable[..., Any], control: Callable[..., Any]
) -> None:
    server = serving()
    with BridgeClient(server.url) as client:
        client.connect()
        client.subscribe("/odom", "nav_msgs/Odometry")
        client.advertise(CONTROL, "autoware_control_msgs/Control")
        before_ns = stamp_ns()
        client.publish(CONTROL, control(0.1, 2.0, stamp_ns=1))
        command, receipt_ns = server.commands.get(timeout=PATIENCE_S)
        assert (command.kind, command.road_wheel_rad, command.accel_mps2) == (RemoteKind.ACCELERATION, 0.1, 2.0)
        assert receipt_ns is not None
        assert before_ns < receipt_ns < stamp_ns()
        server.snapshots.put(snapshot(5, x_m=7.0))
        received = client.receive(PATIENCE_S)
        assert received is not None
        assert received.message.pose.pose.position.x == 7.0


def test_refusal_reaches_the_client_and_the_count(serving: Callable[..., Any], control: Callable[..., Any]) -> None:
    server = serving()
    with connect(server.url) as peer:
        nan = json.dumps({"op": "publish", "topic": CONTROL, "msg": {"lateral": {"steering_tire_angle": math.nan}}})
        for bad in (nan, "garbage"):
            peer.send(bad)
            assert answer(peer)["op"] == "status"
        send(peer, op="publish", topic=CONTROL, msg=control(0.2))
        commands = [server.command() for _ in range(2)]
        assert [(command.sequence, command.refused) for command in commands] == [(0.0, 1.0), (1.0, 1.0)]
        peer.send(b"binary")
        assert "not one CBOR document" in answer(peer)["msg"]
        assert server.command().refused == 2.0
        send(peer, op="publish", topic=CONTROL, msg=control(0.3))
        assert server.command().road_wheel_rad == 0.3


def test_emergency_stop_is_written_at_once(serving: Callable[..., Any]) -> None:
    server = serving()
    with connect(server.url) as peer:
        send(peer, op="publish", topic="/console/request", msg={"data": "estop"})
        assert server.events.get(timeout=PATIENCE_S) == Event.EMERGENCY_STOP


@pytest.mark.parametrize("rude", [False, True])
def test_vanished_commander_is_an_event_and_logged(
    serving: Callable[..., Any], control: Callable[..., Any], caplog: pytest.LogCaptureFixture, rude: bool
) -> None:
    server = serving(lease_ms=10_000.0)
    with caplog.at_level(logging.INFO, "simconsole.bridge.transport.server"):
        with connect(server.url) as peer:
            send(peer, op="publish", topic=CONTROL, msg=control())
            server.command()
            if rude:
                peer.socket.shutdown(socket.SHUT_RDWR)
        assert server.events.get(timeout=PATIENCE_S) == Event.COMMANDER_LOST
        with connect(server.url) as other:
            send(other, op="publish", topic=CONTROL, msg=control(0.4))
            assert server.command().road_wheel_rad == 0.4
    assert "was commanding and is gone" in caplog.text


def test_second_commander_is_told(serving: Callable[..., Any], control: Callable[..., Any]) -> None:
    server = serving(lease_ms=10_000.0)
    with connect(server.url) as first, connect(server.url) as second:
        send(first, op="publish", topic=CONTROL, msg=control(0.1))
        server.command()
        send(second, op="publish", topic=CONTROL, msg=control(0.2), id="mine")
        refusal = answer(second)
        assert refusal["id"] == "mine"
        assert "another client commands" in refusal["msg"]
        send(first, op="publish", topic=CONTROL, msg=control(0.3))
        assert server.command()._replace(accel_mps2=0.0)[1:5] == (2.0, 0.0, 0.0, 0.3)


def test_flood_of_commands_leaves_the_newest(serving: Callable[..., Any], control: Callable[..., Any]) -> None:
    server = serving(limits=BridgeLimits(commands_hz=100_000.0))
    with connect(server.url) as peer:
        for number in range(1, 2001):
            send(peer, op="publish", topic=CONTROL, msg=control(number / 2000, stamp_ns=number))
        settle(peer)
    commands = [server.command() for _ in range(2000)]
    assert (commands[-1].sequence, commands[-1].road_wheel_rad) == (2000.0, 1.0)


@pytest.mark.parametrize("origin", ["http://evil.example", "null"])
def test_page_from_elsewhere_is_turned_away_and_the_log_says_why(
    serving: Callable[..., Any], origin: str, caplog: pytest.LogCaptureFixture
) -> None:
    with pytest.raises(InvalidStatus) as caught:
        connect(serving().url, origin=Origin(origin))
    assert caught.value.response.status_code == 403
    assert f"pages of Origin {origin!r}, which allowed_origins does not name" in caplog.text


@pytest.mark.parametrize("origin", ["null", "file://", "app://foxglove"])
def test_pages_of_files_and_desktop_programs_can_be_let_in_by_name(serving: Callable[..., Any], origin: str) -> None:
    server = serving(allowed_origins=(origin,))
    with connect(server.url, origin=Origin(origin)) as peer:
        settle(peer)
    with pytest.raises(InvalidStatus):
        connect(server.url, origin=Origin("app://other"))


def test_server_does_not_answer_to_other_names(serving: Callable[..., Any]) -> None:
    server = serving()
    for host, code in (("evil.example", b"403"), (f"localhost:{server.port}", b"101")):
        with socket.create_connection(("127.0.0.1", server.port)) as raw:
            raw.sendall(
                f"GET / HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
            )
            assert raw.recv(100).split()[1] == code


def test_plain_http_is_answered(serving: Callable[..., Any]) -> None:
    port = serving().port
    found = {}
    for path in ("/", "/version"):
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
        connection.request("GET", path)
        response = connection.getresponse()
        found[path] = (response.status, response.getheader("Content-Type"), response.read().decode())
    assert found["/"][:2] == (426, "text/plain; charset=utf-8")
    assert "rosbridge" in found["/"][2]
    assert found["/version"][:2] == (200, "application/json")
    assert json.loads(found["/version"][2])["name"] == "simconsole"


def test_text_that_is_no_utf8_ends_its_connection_only(serving: Callable[..., Any]) -> None:
    server = serving()
    with connect(server.url) as other, connect(server.url) as peer:
        peer.send(b'{"op": "\xff"}', text=True)
        with pytest.raises(ConnectionClosed) as closed:
            peer.recv(timeout=PATIENCE_S)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1007
        settle(other)


def test_only_so_many_clients_are_let_in(serving: Callable[..., Any]) -> None:
    server = serving(limits=BridgeLimits(clients=2))
    with connect(server.url) as first, connect(server.url) as second:
        settle(first)
        settle(second)
        with pytest.raises(InvalidStatus) as caught:
            connect(server.url)
        assert caught.value.response.status_code == 503


def test_message_that_is_too_long_ends_its_connection_only(
    serving: Callable[..., Any], control: Callable[..., Any]
) -> None:
    server = serving(limits=BridgeLimits(message_bytes=2000))
    with connect(server.url) as good, connect(server.url) as bad:
        bad.send("x" * 3000)
        with pytest.raises(ConnectionClosed) as caught:
            answer(bad)
        assert caught.value.rcvd is not None
        assert caught.value.rcvd.code == 1009
        send(good, op="publish", topic=CONTROL, msg=control(0.2))
        assert server.command().road_wheel_rad == 0.2


def test_pictures_pass_in_every_form(serving: Callable[..., Any]) -> None:
    server = serving()
    data = bytes(range(256)) * 12 * 1200  # 3.7 MB
    topic = {"topic": "/picture", "type": "sensor_msgs/Image"}
    with connect(server.url) as camera, connect(server.url, max_size=None) as viewer:
        for compression in ("none", "cbor", "cbor-raw"):
            send(viewer, op="subscribe", **topic, compression=compression)
            settle(viewer)
            send(camera, op="publish", **topic, msg={"data": base64.b64encode(data).decode()})
            heard = viewer.recv(timeout=PATIENCE_S)
            if isinstance(heard, str):
                assert base64.b64decode(json.loads(heard)["msg"]["data"]) == data
            else:
                message = cbor2.loads(heard)["msg"]
                assert (message["bytes"].endswith(data)) if compression == "cbor-raw" else message["data"] == data
            send(viewer, op="unsubscribe", topic="/picture")


def test_length_of_messages_goes_by_the_role(serving: Callable[..., Any], tmp_path: Path) -> None:
    tokens = tmp_path / "tokens"
    tokens.write_text(f"view {'v' * 16}\npublish {'p' * 16}\n")
    server = serving(tokens=str(tokens))
    long = json.dumps({"op": "no_such", "id": "long", "more": "x" * 300_000})
    for token in ("v", "p"):
        with connect(f"{server.url}?token={token * 16}") as peer:
            peer.send(long)
            if token == "p":
                assert answer(peer)["id"] == "long"
                continue
            with pytest.raises(ConnectionClosed):
                peer.recv(timeout=PATIENCE_S)
    with connect(f"{server.url}?token={'v' * 16}") as peer:
        send(peer, op="auth", token="p" * 16)
        settle(peer)
        peer.send(long)
        assert answer(peer)["id"] == "long"


def test_stalled_subscriber_costs_others_nothing(serving: Callable[..., Any]) -> None:
    server = serving(limits=BridgeLimits(queued_bytes=65_536))
    big = "x" * 20_000
    with connect(server.url, max_queue=1, close_timeout=0.1) as stalled, connect(server.url) as talker:
        send(stalled, op="subscribe", topic="/chatter", type="std_msgs/String")
        settle(stalled)
        with connect(server.url) as healthy:
            send(healthy, op="subscribe", topic="/chatter", type="std_msgs/String", queue_length=1000)
            settle(healthy)
            send(talker, op="advertise", topic="/chatter", type="std_msgs/String")
            for number in range(600):
                send(talker, op="publish", topic="/chatter", msg={"data": f"{number} {big}"})
                assert answer(healthy)["msg"]["data"].split()[0] == str(number)


def test_throttled_message_comes_when_it_is_due_without_another(serving: Callable[..., Any]) -> None:
    server = serving()
    with connect(server.url) as peer:
        send(peer, op="subscribe", topic="/chatter", type="std_msgs/String", throttle_rate=50, queue_length=1)
        send(peer, op="publish", topic="/chatter", msg={"data": "first"})
        assert answer(peer)["msg"]["data"] == "first"
        for word in ("between", "last"):
            send(peer, op="publish", topic="/chatter", msg={"data": word})
        while answer(peer)["msg"]["data"] != "last":
            pass


def test_clients_are_told_good_bye(serving: Callable[..., Any]) -> None:
    server = serving()
    with connect(server.url) as peer:
        settle(peer)
        server.stop()
        with pytest.raises(ConnectionClosed) as caught:
            answer(peer)
        assert caught.value.rcvd is not None
        assert caught.value.rcvd.code == 1001


def test_port_is_free_again_after_close_and_taken_before(transport: Any) -> None:
    async def twice() -> None:
        first = BridgeServer(BridgeProfile(port=0, transport=transport))
        assert first.port == 0
        await first.start()
        profile = BridgeProfile(port=first.port, transport=transport)
        with pytest.raises(BridgeError, match=f"port {first.port}"):
            await BridgeServer(profile).start()
        await first.close()
        await first.close()
        second = BridgeServer(profile)
        await second.start()
        assert second.url == first.url
        assert second.clients == 0
        await second.close()

    asyncio.run(twice())


def test_client_that_takes_nothing_is_cut(transport: Any) -> None:
    """The clock is ours, so that no second of stalling is waited for."""
    now_ns = 0

    async def main() -> None:
        nonlocal now_ns
        limits = BridgeLimits(queued_bytes=1_000_000)
        profile = BridgeProfile(port=0, stall_close_s=5.0, limits=limits, transport=transport)
        server = BridgeServer(profile, clock_ns=lambda: now_ns)
        await server.start()
        raw = socket.socket()
        raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        raw.setblocking(False)
        loop = asyncio.get_running_loop()
        await loop.sock_connect(raw, ("127.0.0.1", server.port))
        request = (
            f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n"
        )
        await loop.sock_sendall(raw, request.encode())
        assert (await loop.sock_recv(raw, 1000)).startswith(b"HTTP/1.1 101")
        (session,) = server.console.router.sessions
        server.console.receive(session, b'{"op":"subscribe","topic":"/s","type":"std_msgs/String"}', 0)
        text = json.dumps({"op": "publish", "topic": "/s", "msg": {"data": "x" * 200_000}}).encode()
        while session.send_queue.bytes < 500_000:  # the system's buffers are full and the queues begin to fill
            server.console.receive(session, text, 0)
            await asyncio.sleep(0)
        now_ns = 6 * 10**9
        await until(lambda: not server.clients)
        raw.close()
        await server.close()

    asyncio.run(main())


def test_binary_forms_and_dialects_go_over_the_wire(serving: Callable[..., Any], snapshot: Callable[..., Any]) -> None:
    server = serving()
    with connect(server.url) as modern, connect(f"{server.url}/ros1") as old:
        send(modern, op="subscribe", topic="/clock", compression="cbor")
        send(old, op="subscribe", topic="/clock")
        for peer in (modern, old):
            settle(peer)
        server.snapshots.put(snapshot(250))
        assert cbor2.loads(modern.recv(timeout=PATIENCE_S, decode=False))["msg"] == {"clock": {"sec": 1, "nanosec": 0}}
        assert answer(old)["msg"] == {"clock": {"secs": 1, "nsecs": 0}}


def test_how_the_link_stands_is_told_as_it_changes(serving: Callable[..., Any], control: Callable[..., Any]) -> None:
    server = serving(lease_ms=10_000)

    said: list[str] = []

    def wait_for(state: str) -> None:
        while not said or said[-1] != state:
            heard = server.standings.get(timeout=PATIENCE_S)
            if not said or heard != said[-1]:  # each is also said once a second
                said.append(heard)

    wait_for("nobody")
    with connect(server.url) as peer:
        wait_for("1 client")
        send(peer, op="advertise", topic=CONTROL, type="autoware_control_msgs/Control")
        send(peer, op="publish", topic=CONTROL, msg=control(0.1))
        wait_for("commander")
    wait_for("lost")
    assert said == ["nobody", "1 client", "commander", "lost"]
