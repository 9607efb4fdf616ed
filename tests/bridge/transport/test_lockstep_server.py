import http.client
import json
import logging
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.link.measurements import LateMeasurements
from simconsole.bridge.transport.lockstep_server import LockstepBridge
from simconsole.profiles.bridge import BridgeLimits, BridgeProfile
from simconsole.profiles.link import LinkProfile, WayProfile
from simconsole.values.errors import BridgeError
from simconsole.values.signals import NEVER_TICKS, Event, RemoteCommand, RemoteKind
from tests.patience import PATIENCE_S

CONTROL = "/control/command/control_cmd"
TYPE = "autoware_control_msgs/Control"


@contextmanager
def beside(work: Callable[[], None]) -> Iterator[None]:
    """Run `work` on another thread; its exception is raised at the end of the block."""
    failed: list[BaseException] = []

    def run() -> None:
        try:
            work()
        except BaseException as error:  # noqa: BLE001  (whatever it is, the test must show it)
            failed.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        thread.join(timeout=PATIENCE_S)
    assert not thread.is_alive()
    if failed:
        raise failed[0]


def answering(url: str, count: int, answer: Callable[[BridgeClient, Any], None]) -> Callable[[], None]:
    """A controller that answers `count` odometries and leaves."""

    def run() -> None:
        with BridgeClient(url) as client:
            client.subscribe("/odom", "nav_msgs/Odometry")
            client.advertise(CONTROL, TYPE)
            client.advertise("/cmd_vel", "geometry_msgs/Twist")
            client.connect()
            for _ in range(count):
                received = client.receive(PATIENCE_S)
                assert received is not None
                answer(client, received.message)

    return run


def steer(client: BridgeClient, odometry: Any) -> None:
    """Answer with the odometry's own stamp and a command that depends on it."""
    command = client.registry.struct(TYPE)()
    command.stamp = odometry.header.stamp
    command.lateral.steering_tire_angle = odometry.pose.pose.position.x / 1000.0
    client.publish(CONTROL, command)


@pytest.fixture
def lockstep() -> Iterator[LockstepBridge]:
    with LockstepBridge(BridgeProfile(port=0)) as bridge:
        yield bridge


def drive(bridge: LockstepBridge, snapshot: Callable[..., Any], ticks: int, period: int = 5) -> list[RemoteCommand]:
    """The core's loop: one exchange a control period, a look at the sockets on every other tick."""
    commands = []
    for tick in range(1, ticks + 1):
        command, _ = bridge.take(tick)
        commands.append(command)
        state = snapshot(tick, x_m=float(tick))
        if tick % period:
            bridge.publish(state)
        else:
            assert bridge.exchange(state, PATIENCE_S)
    return commands


def test_every_control_period_gets_the_answer_to_its_own_state(
    lockstep: LockstepBridge, snapshot: Callable[..., Any]
) -> None:
    with beside(answering(lockstep.url, 20, steer)):
        assert lockstep.wait_for_client(PATIENCE_S)
        commands = drive(lockstep, snapshot, 100)
    assert commands[4].age_ticks == NEVER_TICKS
    for tick, command in enumerate(commands[5:], start=6):
        asked = (tick - 1) // 5 * 5
        assert command.road_wheel_rad == asked / 1000.0
        assert command.age_ticks == tick - 1 - asked
        assert command.kind == RemoteKind.ACCELERATION


def test_networked_drive_is_as_repeatable_as_a_scripted_one(snapshot: Callable[..., Any]) -> None:
    drives = []
    for _ in range(3):
        with LockstepBridge(BridgeProfile(port=0)) as bridge, beside(answering(bridge.url, 40, steer)):
            assert bridge.wait_for_client(PATIENCE_S)
            drives.append(drive(bridge, snapshot, 200))
    assert drives[0] == drives[1] == drives[2]


def test_a_lost_odometry_is_not_waited_for(snapshot: Callable[..., Any]) -> None:
    """Half are lost: who answers those that come answers all that the console waits for."""
    link = LinkProfile(seed=2, measurements=WayProfile(loss_share=0.5))
    here = [tick for tick in range(5, 201, 5) if _arrives(link, tick)]
    drives = []
    for _ in range(2):
        with (
            LockstepBridge(BridgeProfile(port=0, link=link)) as bridge,
            beside(answering(bridge.url, len(here), steer)),
        ):
            assert bridge.wait_for_client(PATIENCE_S)
            drives.append(drive(bridge, snapshot, 200))
    assert drives[0] == drives[1]
    for tick, command in enumerate(drives[0], start=1):
        assert command.road_wheel_rad == max((one for one in here if one < tick), default=0) / 1000.0


def _arrives(link: LinkProfile, tick: int) -> bool:
    late: LateMeasurements[int] = LateMeasurements(link)
    late.send("/odom", tick, 250, tick)
    return late.arrived(tick) == [tick]


def test_other_commands_do_not_end_the_wait(lockstep: LockstepBridge, snapshot: Callable[..., Any]) -> None:
    def answer(client: BridgeClient, odometry: Any) -> None:
        stamp = odometry.header.stamp
        client.publish(CONTROL, {"stamp": {"sec": 0, "nanosec": 1}, **BODY})  # an earlier state's answer
        client.publish(CONTROL, {"stamp": {"sec": 0, "nanosec": stamp.nanosec}, "lateral": {}})  # refused
        steer(client, odometry)

    with beside(answering(lockstep.url, 1, answer)):
        assert lockstep.wait_for_client(PATIENCE_S)
        assert lockstep.exchange(snapshot(5, x_m=5.0), PATIENCE_S)
        command, _ = lockstep.take(6)
        assert (command.road_wheel_rad, command.sequence, command.refused) == (0.005, 2.0, 1.0)


BODY = {"lateral": {"steering_tire_angle": 0.1}, "longitudinal": {"acceleration": 1.0}}


def test_command_without_a_stamp_answers_by_arriving(lockstep: LockstepBridge, snapshot: Callable[..., Any]) -> None:
    def answer(client: BridgeClient, odometry: Any) -> None:
        client.publish("/cmd_vel", {"linear": {"x": 2.0}, "angular": {"z": 0.1}})

    with beside(answering(lockstep.url, 1, answer)):
        assert lockstep.wait_for_client(PATIENCE_S)
        assert lockstep.exchange(snapshot(5), PATIENCE_S)
        assert lockstep.take(6)[0].speed_mps == 2.0


def test_nobody_answers(lockstep: LockstepBridge, snapshot: Callable[..., Any]) -> None:
    assert not lockstep.wait_for_client(0.0)
    assert not lockstep.exchange(snapshot(5), PATIENCE_S)  # nobody is there who could
    with beside(answering(lockstep.url, 1, lambda client, odometry: None)):
        assert lockstep.wait_for_client(PATIENCE_S)
        assert not lockstep.exchange(snapshot(10), 0.02)
        lockstep.publish(snapshot(15))


def test_commander_that_vanishes_ends_the_wait_at_once_and_is_an_event(
    lockstep: LockstepBridge, snapshot: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    with (
        caplog.at_level(logging.INFO, "simconsole.bridge.transport.lockstep_server"),
        BridgeClient(lockstep.url) as watcher,
    ):
        with served(lockstep, snapshot):
            watcher.connect()
        with beside(answering(lockstep.url, 1, steer)):
            assert lockstep.wait_for_client(PATIENCE_S)
            assert lockstep.exchange(snapshot(5), PATIENCE_S)
            assert not lockstep.exchange(snapshot(10), 100.0)
        command, events = lockstep.take(11)
        assert events.events == Event.COMMANDER_LOST
        assert command.age_ticks == 5.0
        assert lockstep.clients == 1
        assert not lockstep.exchange(snapshot(15), 100.0)
        with beside(answering(lockstep.url, 2, steer)):
            assert lockstep.wait_for_client(PATIENCE_S)
            lockstep.publish(snapshot(20, x_m=20.0))
            while lockstep.take(22)[0].sequence < 2:  # the next commander speaks first, as at the start
                lockstep.stand(0.01)
            assert lockstep.exchange(snapshot(25, x_m=25.0), PATIENCE_S)
    assert "was commanding and is gone" in caplog.text


@contextmanager
def served(bridge: LockstepBridge, snapshot: Callable[..., Any]) -> Iterator[None]:
    """Look at the sockets again and again, as the ticks of a drive do."""
    stop = threading.Event()

    def run() -> None:
        tick = 0
        while not stop.is_set():
            tick += 1
            bridge.publish(snapshot(tick))

    with beside(run):
        try:
            yield
        finally:
            stop.set()


def refusal(peer: ClientConnection) -> str:
    return str(json.loads(peer.recv(timeout=PATIENCE_S))["msg"])


def test_malformed_frames_are_answered_and_the_next_command_applied(
    lockstep: LockstepBridge, snapshot: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    # Simulated time stands, or a slow client would lose the lease between its command and its garbage.
    with served(lockstep, lambda _: snapshot(1)), connect(lockstep.url) as peer:
        peer.send("garbage")
        assert "not one JSON document" in refusal(peer)
        peer.send(b"binary")
        assert "not one CBOR document" in refusal(peer)
        peer.send(json.dumps({"op": "publish", "topic": CONTROL, "msg": BODY}).replace("0.1", "NaN"))
        assert "NaN" in refusal(peer)
        peer.send(['{"op":"publish","topic":"%s","msg":' % CONTROL, json.dumps(BODY) + "}"])  # noqa: UP031  (braces)
        peer.send("garbage")
        refusal(peer)
        peer.ping().wait(PATIENCE_S)
    command, _ = lockstep.take(1)
    assert (command.road_wheel_rad, command.sequence, command.refused) == (0.1, 1.0, 2.0)
    assert "refused (1)" in caplog.text


def test_too_many_fragments_end_the_connection(snapshot: Callable[..., Any]) -> None:
    limits = BridgeLimits(message_fragments=10)
    with (
        LockstepBridge(BridgeProfile(port=0, limits=limits)) as bridge,
        served(bridge, snapshot),
        connect(bridge.url) as peer,
    ):
        with suppress(ConnectionClosed):  # it may be closed before its last fragment is out
            peer.send(["x"] * 10 + [""])
        with pytest.raises(ConnectionClosed) as caught:
            [refusal(peer) for _ in range(2)]
        assert caught.value.rcvd is not None
        assert caught.value.rcvd.code == 1008


def test_message_that_is_too_long_ends_the_connection(snapshot: Callable[..., Any]) -> None:
    limits = BridgeLimits(message_bytes=2000)
    with (
        LockstepBridge(BridgeProfile(port=0, limits=limits)) as bridge,
        served(bridge, snapshot),
        connect(bridge.url) as peer,
    ):
        peer.send("x" * 3000)
        with pytest.raises(ConnectionClosed) as caught:
            peer.recv(timeout=PATIENCE_S)
        assert caught.value.rcvd is not None
        assert caught.value.rcvd.code == 1009


def test_who_may_not_connect_is_turned_away(snapshot: Callable[..., Any]) -> None:
    profile = BridgeProfile(port=0, limits=BridgeLimits(clients=1))
    with LockstepBridge(profile) as bridge, served(bridge, snapshot):
        for arguments, code in (
            ({"origin": "http://evil.example"}, 403),
            ({"additional_headers": {"Host": "evil.example"}}, 403),
        ):
            with pytest.raises(InvalidStatus) as caught:
                connect(bridge.url, **arguments)
            assert caught.value.response.status_code == code
        with connect(bridge.url):
            with pytest.raises(InvalidStatus) as caught:
                connect(bridge.url)
            assert caught.value.response.status_code == 503


def test_plain_http_is_answered(lockstep: LockstepBridge, snapshot: Callable[..., Any]) -> None:
    with served(lockstep, snapshot):
        for path, code in (("/", 426), ("/version", 200)):
            connection = http.client.HTTPConnection("127.0.0.1", lockstep.port, timeout=PATIENCE_S)
            connection.request("GET", path)
            response = connection.getresponse()
            assert (response.status, b"simconsole" in response.read()) == (code, code == 200)


def test_what_is_no_websocket_is_dropped(lockstep: LockstepBridge, snapshot: Callable[..., Any]) -> None:
    with served(lockstep, snapshot):
        for junk in (b"\x16\x03\x01 tls\r\n", b"GET / HTTP/1.0\r\n\r\n", b"x" * 100_000):
            with socket.create_connection(("127.0.0.1", lockstep.port), timeout=PATIENCE_S) as raw:
                raw.sendall(junk)
                while raw.recv(1000):
                    pass
    assert lockstep.clients == 0


def test_who_does_not_finish_the_handshake_is_swept_out_by_the_next(
    lockstep: LockstepBridge, snapshot: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("simconsole.bridge.transport.sockets.HANDSHAKE_S", 0.0)
    with served(lockstep, snapshot), socket.create_connection(("127.0.0.1", lockstep.port), timeout=PATIENCE_S) as idle:
        idle.sendall(b"GET / HT")
        with connect(lockstep.url) as peer:
            peer.ping().wait(PATIENCE_S)
        # Reset if the server never read what was sent, closed in order if it did: gone either way.
        with suppress(ConnectionResetError):
            assert idle.recv(10) == b""


def test_slow_subscriber_costs_bounded_memory_and_the_loop_nothing(snapshot: Callable[..., Any]) -> None:
    limits = BridgeLimits(queued_bytes=65_536)
    profile = BridgeProfile(port=0, limits=limits, rates_hz={"/odom": 250.0, "/console/arbitration": 250.0})
    with LockstepBridge(profile) as bridge:
        with beside(lambda: setups.append(subscribe(bridge.url, "/odom", 1000))):
            assert bridge.wait_for_client(PATIENCE_S)
        with setups.pop() as stalled:
            (session,) = bridge.console.router.sessions
            for tick in range(1, 50_000):
                bridge.publish(snapshot(tick))
                if session.send_queue.dropped > 100:
                    break
            assert session.send_queue.dropped > 0
            assert session.send_queue.bytes <= 65_536
            assert stalled.recv(1) == b"\x81"


setups: list[socket.socket] = []


def subscribe(url: str, topic: str, queue_length: int) -> socket.socket:
    """A raw client that subscribes and then reads nothing."""
    port = int(url.rpartition(":")[2])
    raw = socket.socket()
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    raw.connect(("127.0.0.1", port))
    raw.sendall(
        f"GET / HTTP/1.1\r\nHost: localhost:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
    )
    while b"\r\n\r\n" not in raw.recv(1000):
        pass
    text = json.dumps({"op": "subscribe", "topic": topic, "queue_length": queue_length}).encode()
    raw.sendall(bytes([0x81, 0x80 | len(text), 0, 0, 0, 0]) + text)  # one masked text frame
    return raw


def test_odometry_follows_the_control_rate(snapshot: Callable[..., Any]) -> None:
    with LockstepBridge(BridgeProfile(port=0), odometry_hz=10.0) as bridge:
        with beside(answering(bridge.url, 4, steer)):
            assert bridge.wait_for_client(PATIENCE_S)
            commands = drive(bridge, snapshot, 100, period=25)
        assert commands[-1].sequence == 3.0


def test_clients_are_told_good_bye_and_the_port_is_free(snapshot: Callable[..., Any]) -> None:
    bridge = LockstepBridge(BridgeProfile(port=0))

    def watch() -> None:
        with BridgeClient(bridge.url, comes_back=False) as client:
            client.subscribe("/odom", "nav_msgs/Odometry")
            client.connect()
            with pytest.raises(BridgeError, match=r"closed by the server \(1001\)"):
                client.receive(PATIENCE_S)

    with beside(watch):
        assert bridge.wait_for_client(PATIENCE_S)
        with pytest.raises(BridgeError, match="cannot listen"):
            LockstepBridge(BridgeProfile(port=bridge.port))
        port = bridge.port
        bridge.close()
        bridge.close()
    LockstepBridge(BridgeProfile(port=port)).close()
