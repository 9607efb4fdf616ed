"""A client of a drive in lockstep, by the bytes that go in and out."""

from collections.abc import Callable
from typing import Any, cast

from simconsole.bridge.console.surroundings import NOWHERE
from simconsole.bridge.transport.lockstep_connection import UNSENT_BYTES, LockstepConnection
from simconsole.bridge.transport.lockstep_server import LockstepBridge
from simconsole.profiles.bridge import BridgeProfile

HANDSHAKE = (
    b"GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
)


class Taking:
    """A socket that takes whatever it is given, at once."""

    def __init__(self) -> None:
        self.sizes: list[int] = []

    def setblocking(self, flag: bool) -> None:
        pass

    def setsockopt(self, *what: int) -> None:
        pass

    def recv(self, most: int) -> bytes:
        return HANDSHAKE

    def send(self, data: bytearray) -> int:
        self.sizes.append(len(data))
        return len(data)


def test_a_system_that_takes_all_is_given_all(snapshot: Callable[..., Any]) -> None:
    """Who waits behind a message of several parts: nothing asks the server to go on once a part has gone."""
    profile = BridgeProfile(port=0)
    around = NOWHERE._replace(route=tuple((0.1 * number, 0.0, 0.0) for number in range(5000)))
    taking = Taking()
    with LockstepBridge(profile, around=around) as bridge:
        connection = LockstepConnection(bridge, cast("Any", taking), "peer", profile)
        connection.read()
        session = connection.session
        assert session is not None
        for topic, kind in (("/route", "nav_msgs/Path"), ("/odom", "nav_msgs/Odometry")):
            bridge.received(session, f'{{"op": "subscribe", "topic": "{topic}", "type": "{kind}"}}'.encode())
        bridge.console.publish(snapshot(5), 0, odometry=True)
        connection.flush(0)
    assert session.due_ns() is None
    assert sum(taking.sizes) > 2 * UNSENT_BYTES
    assert max(taking.sizes) <= UNSENT_BYTES + 1000
