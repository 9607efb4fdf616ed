"""Tokens and TLS over real sockets, on both servers and from our own client."""

import itertools
import socket
import ssl
import threading
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.transport.credentials import load_tls
from simconsole.bridge.transport.lockstep_server import LockstepBridge
from simconsole.bridge.transport.server import BridgeServer
from simconsole.cli.certificate import make, write_private
from simconsole.profiles.bridge import BridgeLimits, BridgeProfile
from simconsole.values.errors import BridgeError, ProfileError
from tests.patience import PATIENCE_S, wait_until

TOKEN = "c" * 20


@pytest.fixture
def files(tmp_path: Path) -> dict[str, str]:
    written = make("127.0.0.1")
    (tmp_path / "b.pem").write_bytes(written.certificate)
    write_private(tmp_path / "b.key", written.key)
    write_private(tmp_path / "tokens", f"control {TOKEN}\n".encode())
    names = {"certificate": "b.pem", "certificate_key": "b.key", "tokens": "tokens"}
    return {key: str(tmp_path / name) for key, name in names.items()}


def test_encrypted_and_authenticated(
    serving: Callable[..., Any], files: dict[str, str], control: Callable[..., Any]
) -> None:
    server = serving(**files)
    url = server.url.replace("ws://", "wss://")
    with BridgeClient(url, token=TOKEN, certificate=files["certificate"]) as client:
        client.connect()
        client.advertise("/control/command/control_cmd", "autoware_control_msgs/Control")
        client.publish("/control/command/control_cmd", control(0.25))
        assert server.command().road_wheel_rad == 0.25
    with pytest.raises(BridgeError, match=r"cannot connect: .*CERTIFICATE_VERIFY_FAILED"):
        BridgeClient(url, token=TOKEN).connect()
    with pytest.raises(BridgeError, match=r"refused: .*401"):
        BridgeClient(url, token="wrong", certificate=files["certificate"]).connect()
    with pytest.raises(BridgeError):
        BridgeClient(server.url, token=TOKEN, timeout_s=2.0).connect()


@pytest.mark.fault("N12")
def test_n12_who_begins_no_encryption_is_ended_too(
    serving: Callable[..., Any], files: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("simconsole.bridge.transport.sockets.HANDSHAKE_S", 0.2)
    server = serving(**files)
    with socket.create_connection(("127.0.0.1", server.port), 20.0) as idle:
        assert idle.recv(100) == b""


def test_stock_client_authenticates_after_connecting(serving: Callable[..., Any], files: dict[str, str]) -> None:
    server = serving(tokens=files["tokens"])
    with connect(server.url) as peer:
        peer.send('{"op":"subscribe","topic":"/odom"}')
        assert "needs the role view; you have no token" in str(peer.recv(timeout=PATIENCE_S))
        peer.send(f'{{"op":"auth","token":"{TOKEN}"}}')
        peer.send('{"op":"publish","topic":"/console/request","msg":{"data":"mark"}}')
        assert server.events.get(timeout=PATIENCE_S)
    with connect(f"{server.url}/?token={TOKEN}") as peer:
        peer.send('{"op":"publish","topic":"/console/request","msg":{"data":"mark"}}')
        assert server.events.get(timeout=PATIENCE_S)


def test_who_shows_no_token_takes_no_place_of_those_who_do_and_does_not_stay(
    serving: Callable[..., Any], files: dict[str, str]
) -> None:
    limits = BridgeLimits(clients=2, tokenless_clients=3, tokenless_s=1.0)
    server = serving(tokens=files["tokens"], limits=limits)
    with ExitStack() as stack:
        strangers = [stack.enter_context(connect(server.url)) for _ in range(3)]
        with pytest.raises(InvalidStatus) as refused:
            connect(server.url)
        assert refused.value.response.status_code == 503
        stack.enter_context(connect(f"{server.url}/?token={TOKEN}"))
        for stranger in strangers:
            with pytest.raises(ConnectionClosed):
                stranger.recv(timeout=PATIENCE_S)


def test_lockstep_asks_for_the_token_too(files: dict[str, str]) -> None:
    profile = BridgeProfile(port=0, tokens=files["tokens"])
    with LockstepBridge(profile) as bridge:
        failures: list[int] = []

        def come(token: str) -> None:
            try:
                with connect(bridge.url, additional_headers={"Authorization": f"Bearer {token}"}) as peer:
                    peer.send('{"op":"subscribe","topic":"/odom"}')
                    peer.recv(timeout=PATIENCE_S)
            except InvalidStatus as error:
                failures.append(error.response.status_code)
            except (TimeoutError, OSError, ConnectionClosed):
                pass

        stranger = threading.Thread(target=come, args=("wrong",))
        stranger.start()
        assert not bridge.wait_for_client(0.5)
        friend = threading.Thread(target=come, args=(TOKEN,), daemon=True)
        friend.start()
        assert bridge.wait_for_client(10.0)
        assert failures == [401]
    for thread in (stranger, friend):
        thread.join(timeout=PATIENCE_S)


def test_who_shows_no_token_does_not_stay_in_lockstep_either(
    files: dict[str, str], snapshot: Callable[..., Any]
) -> None:
    profile = BridgeProfile(port=0, tokens=files["tokens"], limits=BridgeLimits(tokenless_s=0.5))
    with LockstepBridge(profile) as bridge:
        gone = threading.Event()

        def stay() -> None:
            with connect(bridge.url) as stranger, suppress(ConnectionClosed):
                stranger.recv(timeout=PATIENCE_S)
            gone.set()

        threading.Thread(target=stay, daemon=True).start()
        ticks = itertools.count(1)

        def is_gone() -> bool:
            bridge.publish(snapshot(next(ticks)))
            return gone.is_set()

        wait_until(is_gone, "the end of a connection without token")


def test_lockstep_is_encrypted_too(
    files: dict[str, Any], snapshot: Callable[..., Any], control: Callable[..., Any]
) -> None:
    """Long messages both ways, so that several records are on their way at a time."""
    answered = 40
    with LockstepBridge(BridgeProfile(port=0, **files)) as bridge:
        assert bridge.url.startswith("wss://")

        def drive() -> None:
            with BridgeClient(bridge.url, token=TOKEN, certificate=files["certificate"]) as client:
                client.subscribe("/odom", "nav_msgs/Odometry")
                client.subscribe("/echo", "std_msgs/String")
                client.advertise("/echo", "std_msgs/String")
                client.advertise("/control/command/control_cmd", "autoware_control_msgs/Control")
                client.connect()
                echoed = 0
                while echoed < answered:
                    received = client.receive(PATIENCE_S)
                    assert received is not None
                    if received.topic == "/echo":
                        assert received.message.data == "x" * 100_000
                        echoed += 1
                        continue
                    stamp = received.message.header.stamp
                    client.publish("/echo", {"data": "x" * 100_000})
                    client.publish("/control/command/control_cmd", control(0.2, stamp_ns=stamp.nanosec))

        program = threading.Thread(target=drive)
        program.start()
        with socket.create_connection(("127.0.0.1", bridge.port)) as stranger:
            stranger.sendall(b"GET / HTTP/1.1\r\n\r\n")  # speaks no TLS, and harms nobody
            assert bridge.wait_for_client(10.0)
            for tick in range(5, 5 * answered + 1, 5):
                assert bridge.exchange(snapshot(tick), 10.0)
            assert bridge.take(tick + 1)[0].sequence == answered
            while bridge.clients:
                bridge.publish(snapshot(tick))
        program.join(timeout=PATIENCE_S)
        assert not program.is_alive()


def test_profiles_that_cannot_be_served(files: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(ProfileError, match="can be reached from other machines"):
        BridgeServer(BridgeProfile(host="0.0.0.0"))
    with pytest.raises(ProfileError, match=r"outputs\.bridge\.tokens"):
        BridgeServer(BridgeProfile(tokens=str(tmp_path / "none")))
    with pytest.raises(ProfileError, match=r"outputs\.bridge\.certificate"):
        BridgeServer(BridgeProfile(certificate=files["tokens"], certificate_key=files["tokens"]))
    context = load_tls(BridgeProfile(**files))
    assert context is not None
    assert context.minimum_version is ssl.TLSVersion.TLSv1_2


def test_key_is_for_its_owner_alone(files: dict[str, str]) -> None:
    assert Path(files["certificate_key"]).stat().st_mode & 0o777 == 0o600


def test_certificate_that_cannot_be_read() -> None:
    with pytest.raises(BridgeError, match="certificate: /nowhere"):
        BridgeClient("wss://localhost:1", certificate="/nowhere")
