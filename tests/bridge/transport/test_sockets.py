import errno
import socket

import pytest

from simconsole.bridge.transport.sockets import address_url, bind, is_unacknowledged, listen
from simconsole.values.errors import BridgeError
from tests.bridge.networks import go_deaf


def test_what_the_other_machine_has_not_acknowledged_is_known() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        client = socket.create_connection(listener.getsockname())
        server, _ = listener.accept()
    with server, client:
        server.sendall(b"x")
        client.recv(1)
        assert not is_unacknowledged(server)
        go_deaf(client)
        server.sendall(b"x")
        assert is_unacknowledged(server, 0)
        assert not is_unacknowledged(server, 10**9)
    assert is_unacknowledged(server)


def test_where_the_system_does_not_say_nobody_is_trusted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr("socket.TCP_INFO")
    with socket.socket() as unconnected:
        assert is_unacknowledged(unconnected)


def test_address_in_use_is_one_line() -> None:
    with listen("127.0.0.1", 0) as taken:
        port = taken.getsockname()[1]
        assert not taken.getblocking()
        with pytest.raises(BridgeError, match=f"cannot listen on 127.0.0.1 port {port}"):
            listen("127.0.0.1", port)
        with pytest.raises(BridgeError, match=f"cannot listen on 127.0.0.1 port {port}"):
            bind("127.0.0.1", port)


def test_an_address_without_listening_lets_nobody_connect() -> None:
    """Who is let in and then cut off takes the server for one that has failed."""
    with bind("127.0.0.1", 0) as sock, socket.socket() as client:
        assert client.connect_ex(sock.getsockname()) == errno.ECONNREFUSED


def test_addresses_as_clients_write_them() -> None:
    assert address_url("127.0.0.1", 9090) == "ws://127.0.0.1:9090"
    assert address_url("::1", 9090) == "ws://[::1]:9090"
