import socket
from collections.abc import Iterator

import pytest

from simconsole.bridge.protocol.frames import TEXT
from simconsole.bridge.transport.connection_checks import ConnectionChecks
from simconsole.profiles.bridge import BridgeProfile

S = 1_000_000_000
PROFILE = BridgeProfile(ping_interval_s=1.0, dead_after_s=3.0)


class Checked:
    """A connection that was heard at 5 s, over a pair of sockets."""

    def __init__(self, sock: socket.socket) -> None:
        self.checks = ConnectionChecks(PROFILE, 5 * S)
        self.pings = 0
        self._sock = sock

    def at(self, now_s: float) -> str | None:
        return self.checks.check(int(now_s * S), self._sock, self._ping)

    def _ping(self) -> None:
        self.pings += 1


@pytest.fixture
def connection() -> Iterator[Checked]:
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        socket.create_connection(server.getsockname()) as near,
        server.accept()[0],
    ):
        yield Checked(near)


def test_a_quiet_client_is_pinged_once_a_second(connection: Checked) -> None:
    assert [connection.at(now_s) for now_s in (5.9, 6.0, 6.5, 7.0)] == [None] * 4
    assert connection.pings == 2
    connection.checks.heard(int(7.5 * S))
    assert connection.at(8.4) is None
    assert connection.pings == 2


def test_a_silent_client_whose_system_has_acknowledged_everything_is_merely_slow(connection: Checked) -> None:
    assert connection.at(20.0) is None


def test_a_silent_client_is_gone_where_nothing_is_acknowledged(
    connection: Checked, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("simconsole.bridge.transport.sockets.is_unacknowledged", lambda sock: True)
    assert [connection.at(5.0 + 0.25 * look) for look in range(12)] == [None] * 12
    assert connection.at(8.0) == "has been gone for 3 s"


def test_a_client_is_not_gone_because_the_server_or_its_machine_stood_still(
    connection: Checked, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was sent just before is unacknowledged, and nothing was heard, of who could neither send nor acknowledge."""
    monkeypatch.setattr("simconsole.bridge.transport.sockets.is_unacknowledged", lambda sock: True)
    assert connection.at(5.25) is None
    assert connection.at(65.0) is None
    assert connection.at(67.75 - 1.5) is None
    assert connection.at(67.75) is None
    assert connection.at(68.0) == "has been gone for 3 s"


def test_a_message_that_does_not_end_is_not_waited_for(connection: Checked) -> None:
    assert connection.checks.assembler.add(TEXT, b"{", False, 5 * S) is None
    assert connection.at(7.0) is None
    assert str(connection.at(7.1)).startswith("sends too slowly: ")


def test_a_closing_handshake_has_a_second(connection: Checked) -> None:
    assert not connection.checks.is_closing
    assert [connection.checks.closing(int(now_s * S)) for now_s in (9.0, 9.5, 10.0)] == [None] * 3
    assert connection.checks.is_closing
    assert connection.checks.closing(int(10.1 * S)) == "does not close"
