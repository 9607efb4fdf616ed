"""One connection of a client before and after it is open; what it says over a network see test_bridge_client.py."""

import pytest
from websockets.datastructures import Headers
from websockets.exceptions import InvalidStatus
from websockets.http11 import Response

from simconsole.bridge.client.client_connection import ClientConnection
from simconsole.values.errors import BridgeError, OtherDriveError

URL = "ws://127.0.0.1:9"


def connection(drive: str | None = None) -> ClientConnection:
    return ClientConnection(URL, 0.1, None, None, drive)


def turned_away(status: int, body: bytes = b"") -> InvalidStatus:
    return InvalidStatus(Response(status, "", Headers(), body))


def test_only_of_a_drives_own_program_is_a_refusal_that_of_another_drive() -> None:
    why = turned_away(403, b"another drive\n")
    assert type(connection("nonce")._refusal(why)) is OtherDriveError
    assert type(connection()._refusal(why)) is BridgeError
    assert type(connection("nonce")._refusal(turned_away(401))) is BridgeError
    assert str(connection()._refusal(why)).startswith(f"{URL}: refused: ")
    assert str(connection()._refusal(why)).endswith("403, another drive")


def test_words_of_a_server_that_are_no_text_are_told_all_the_same() -> None:
    assert str(connection()._refusal(turned_away(503, b"\xff full"))).endswith(", \ufffd full")
    assert str(connection()._refusal(ValueError("no HTTP"))) == f"{URL}: refused: no HTTP"


def test_nothing_is_sent_before_it_is_open_and_closing_twice_is_nothing() -> None:
    closed = connection()
    assert not closed.is_open
    with pytest.raises(BridgeError, match=f"{URL}: not connected"):
        closed.send(b"{}")
    closed.close()
    closed.close()
    assert not closed.is_open


@pytest.mark.parametrize("url", ["", "http://host", "ws://", "host:9090"])
def test_address_that_is_none_is_refused_at_once(url: str) -> None:
    with pytest.raises(BridgeError, match=r"^url: "):
        ClientConnection(url, 0.1, None, None)
