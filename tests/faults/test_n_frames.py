"""N08, N10, N12, N13, N15, N16, N19 of the fault catalogue: bad clients below the protocol, against every server.

After each of them a client that was there before commands, and is obeyed.
"""

import json
import select
import socket
import tracemalloc
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from typing import Any

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from simconsole.profiles.bridge import BridgeLimits
from tests.bridge.networks import BINARY, CLOSE, PING, PONG, TEXT, Raw, frame, handshake
from tests.faults.apart import serving_apart
from tests.patience import PATIENCE_S
from tests.samples import Measured, Sample

CONTROL = "/control/command/control_cmd"
MIB = 1 << 20


def settle(client: ClientConnection) -> None:
    """Return when everything sent before has been applied: a refusal is answered in order."""
    client.send('{"op":"no_such","id":"settle"}')
    while json.loads(client.recv(timeout=PATIENCE_S)).get("id") != "settle":
        pass


@contextmanager
def unharmed(server: Any, control: Callable[..., dict[str, Any]]) -> Iterator[None]:
    """Someone else commands before the block, and still after it."""
    with connect(server.url) as client:
        for road_wheel_rad in (0.1, 0.2):
            client.send(json.dumps({"op": "publish", "topic": CONTROL, "msg": control(road_wheel_rad)}))
            settle(client)
            assert server.applied() == road_wheel_rad
            if road_wheel_rad == 0.1:
                yield


@pytest.mark.fault("N08")
def test_n08_giant_frame_is_refused_by_its_header(edge: Callable[..., Any], control: Callable[..., Any]) -> None:
    server = edge()
    head_of_ten = b"\x81\xff" + (10_000_001).to_bytes(8) + bytes(4)
    with unharmed(server, control):
        tracemalloc.start()
        try:
            with Raw(server.port) as raw:
                raw.sock.sendall(b"\x81\xff" + (1 << 30).to_bytes(8) + bytes(4))
                assert raw.close_code() == 1009
            with Raw(server.port) as raw:
                raw.sock.sendall(head_of_ten)
                assert raw.close_code() == 1009
            assert tracemalloc.get_traced_memory()[1] < 2 * MIB
        finally:
            tracemalloc.stop()


@pytest.mark.fault("N08")
@pytest.mark.parametrize("pieces", [2, 8])
def test_n08_giant_message_in_pieces(edge: Callable[..., Any], control: Callable[..., Any], pieces: int) -> None:
    server = edge(limits=BridgeLimits(message_bytes=65_536))
    with unharmed(server, control), Raw(server.port) as raw:
        for number in range(pieces):
            raw.send(TEXT if not number else 0, b"x" * (70_000 // pieces), fin=number == pieces - 1)
        assert raw.close_code() == 1009


@pytest.mark.fault("N10")
def test_n10_compression_is_off(edge: Callable[..., Any], control: Callable[..., Any]) -> None:
    server = edge()
    offer = "Sec-WebSocket-Extensions: permessage-deflate\r\n"
    with unharmed(server, control), Raw(server.port, headers=offer) as raw:
        assert b"deflate" not in raw.response
        raw.send(TEXT, b"x", rsv=4)
        assert raw.close_code() == 1002


@pytest.mark.fault("N12")
def test_n12_idle_handshakes_are_ended_and_harm_nobody(
    edge: Callable[..., Any], control: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("simconsole.bridge.transport.sockets.HANDSHAKE_S", 0.3)
    server = edge()
    with unharmed(server, control), ExitStack() as stack:
        idle = [stack.enter_context(socket.create_connection(("127.0.0.1", server.port), 20.0)) for _ in range(200)]
        for sock in idle[::2]:
            sock.sendall(handshake(server.port)[:20])
        for sock in idle:
            while ended(sock) is False:
                with socket.create_connection(("127.0.0.1", server.port)):
                    pass  # someone comes: lockstep sweeps then
        assert all(ended(sock) for sock in idle)


def ended(sock: socket.socket) -> bool:
    """Whether the server has closed; waits a moment for it."""
    sock.settimeout(0.1)
    try:
        return sock.recv(1000) == b""
    except TimeoutError:
        return False
    except ConnectionError:
        return True


@pytest.mark.fault("N13")
def test_n13_message_in_a_million_fragments(edge: Callable[..., Any], control: Callable[..., Any]) -> None:
    """The limit, 256, and one more; then as many of a million as the connection takes."""
    server = edge()
    with unharmed(server, control):
        for fragments in (256, 257):
            with Raw(server.port) as raw:
                raw.send(TEXT, b" ", fin=False)
                raw.sock.sendall(frame(0, b" ", fin=False) * (fragments - 2) + frame(0, b"{}"))
                if fragments == 256:
                    raw.send(CLOSE, (1000).to_bytes(2))
                assert raw.close_code() == (1000 if fragments == 256 else 1008)
        with Raw(server.port) as raw:
            assert flooded(raw, 1_000_000) == 1008


def flooded(raw: Raw, fragments: int) -> int | None:
    """Send a message of one-byte fragments until the server has had enough; return with which code it closed."""
    thousand = frame(0, b"x", fin=False) * 1000
    raw.send(TEXT, b"x", fin=False)
    with suppress(ConnectionError):
        for _ in range(fragments // 1000):
            raw.sock.sendall(thousand)
            if select.select([raw.sock], [], [], 0.0)[0]:
                break
    return raw.close_code()


@pytest.mark.fault("N13")
@pytest.mark.parametrize("transport", ["websockets", "picows"])
def test_n13_many_such_messages_take_no_memory(transport: str, sample: Sample, measured: Measured) -> None:
    """Kept whole, each would be 40 MB of Python's bytes, or in the sample 10 MB."""
    rounds, fragments, resident = sample.of(12, 200), sample.of(250_000, 1_000_000), 0
    codes: list[int | None] = []
    with serving_apart(transport) as server:
        for number in range(rounds):
            with Raw(server.port) as raw:
                codes.append(flooded(raw, fragments))
            resident = server.resident_bytes() if number == 5 else resident
        grown = server.resident_bytes() - resident
    seen = f"{grown / MIB:+.2f} MiB after {rounds - 6} more"
    measured("N13", f"resident memory, {transport}", seen, "at most 4 MiB")
    # A reset may overtake the code where the client goes on writing.
    assert set(codes) <= {1008, None}
    assert 1008 in codes
    assert grown <= 4 * MIB


@pytest.mark.fault("N13")
def test_n13_fragments_within_the_limit_are_a_message(edge: Callable[..., Any], control: Callable[..., Any]) -> None:
    server = edge()
    text = json.dumps({"op": "publish", "topic": CONTROL, "msg": control(0.3)}).encode()
    with Raw(server.port) as raw:
        for number, octet in enumerate(text):
            raw.send(TEXT if not number else 0, bytes([octet]), fin=number == len(text) - 1)
        raw.send(TEXT, b'{"op":"no_such"}')
        assert raw.receive() is not None
        assert server.applied() == 0.3


@pytest.mark.fault("N15")
@pytest.mark.parametrize("origin", ["http://evil.example", "null", "file://", "https://localhost.evil.example"])
def test_n15_page_from_elsewhere_is_turned_away(
    edge: Callable[..., Any], control: Callable[..., Any], origin: str
) -> None:
    server = edge()
    with unharmed(server, control):
        with pytest.raises(InvalidStatus) as caught:
            connect(server.url, origin=Origin(origin))
        assert caught.value.response.status_code == 403


@pytest.mark.fault("N16")
@pytest.mark.parametrize("host", ["evil.example", "evil.example:9090", "127.0.0.1.evil.example", "", "a\r\nHost: b"])
def test_n16_other_host_is_turned_away(edge: Callable[..., Any], control: Callable[..., Any], host: str) -> None:
    server = edge()
    with unharmed(server, control), socket.create_connection(("127.0.0.1", server.port), 20.0) as raw:
        raw.sendall(handshake(server.port, f"Host: {host}\r\n"))
        assert raw.recv(100).split()[1] in (b"403", b"400")


@pytest.mark.fault("N16")
@pytest.mark.parametrize(
    ("old", "new", "comes_in"),
    [
        (b"Connection: Upgrade", b"Connection: keep-alive, Upgrade", True),  # as Firefox has it
        (b"Connection: Upgrade", b"Connection: close", False),
        (b"Upgrade: websocket\r\n", b"", False),
        (b"Version: 13", b"Version: 8", False),
        (b"Key: AAAAAAAAAAAAAAAAAAAAAA==", b"Key: AAAA", False),
        (b"GET / ", b"GET /?token=%ff ", False),
        (b"GET / ", b"POST / ", False),
    ],
)
def test_n16_first_requests_are_read_alike(
    edge: Callable[..., Any], control: Callable[..., Any], old: bytes, new: bytes, comes_in: bool
) -> None:
    server = edge()
    with unharmed(server, control), socket.create_connection(("127.0.0.1", server.port), 20.0) as raw:
        raw.sendall(handshake(server.port).replace(old, new))
        status = int(raw.recv(100).split()[1])
        assert status == 101 if comes_in else 400 <= status < 500


@pytest.mark.fault("N19")
@pytest.mark.parametrize(
    ("data", "code"),
    [
        (frame(3), 1002),
        (frame(7), 1002),
        (frame(11), 1002),
        (frame(15), 1002),
        (frame(TEXT, b"x", rsv=1), 1002),
        (frame(TEXT, b"x", rsv=2), 1002),
        (frame(PING, b"", rsv=4), 1002),
        (frame(TEXT, b"{}", masked=False), 1002),
        (frame(0, b"x"), 1002),
        (frame(TEXT, b"x", fin=False) + frame(TEXT, b"y"), 1002),
        (frame(PING, b"", fin=False), 1002),
        (frame(PING, b"x" * 126), 1002),
        (frame(CLOSE, b"x"), 1002),
        *((frame(CLOSE, code.to_bytes(2)), 1002) for code in (0, 999, 1004, 1005, 1006, 1015, 2999, 5000, 65535)),
        (frame(CLOSE, (1000).to_bytes(2) + b"\xff"), 1007),
        (frame(CLOSE, (1000).to_bytes(2)), 1000),
        (frame(CLOSE, (1001).to_bytes(2) + b"bye"), 1001),
        (frame(CLOSE, (4999).to_bytes(2)), 4999),
    ],
)
def test_n19_frames_against_the_rules_end_their_connection_in_order(
    edge: Callable[..., Any], control: Callable[..., Any], data: bytes, code: int
) -> None:
    server = edge()
    with unharmed(server, control), Raw(server.port) as raw:
        raw.sock.sendall(data)
        assert raw.close_code() == code
        assert raw.receive() is None


@pytest.mark.fault("N19")
def test_n19_close_without_a_code_is_answered(edge: Callable[..., Any], control: Callable[..., Any]) -> None:
    server = edge()
    with unharmed(server, control), Raw(server.port) as raw:
        raw.send(CLOSE)
        assert raw.receive() == (CLOSE, b"")


@pytest.mark.fault("N19")
def test_n19_text_that_is_no_unicode_is_answered_or_ends_it(
    edge: Callable[..., Any], control: Callable[..., Any]
) -> None:
    server = edge()
    with unharmed(server, control), Raw(server.port) as raw:
        raw.send(TEXT, b'{"op":"\xff"}')
        received = raw.receive()
        assert received is not None
        opcode, answer = received
        assert (opcode == TEXT and b'"status"' in answer) or (opcode == CLOSE and answer[:2] == (1007).to_bytes(2))


@pytest.mark.fault("N19")
@pytest.mark.parametrize(
    "data", [b"", b"\x00", b"\xff" * 1000, bytes(range(256)), b'{"op":"subscribe","topic":"/odom"}']
)
def test_n19_unsolicited_binary_is_refused_and_the_connection_goes_on(
    edge: Callable[..., Any], control: Callable[..., Any], data: bytes
) -> None:
    server = edge()
    with unharmed(server, control), Raw(server.port) as raw:
        for _ in range(3):
            raw.send(BINARY, data)
            received = raw.receive()
            assert received is not None
            assert json.loads(received[1])["op"] == "status"
        raw.say(op="call_service", service="/rosapi/get_time", id="still")
        received = raw.receive()
        assert received is not None
        assert json.loads(received[1])["id"] == "still"


@pytest.mark.fault("N19")
def test_n19_ping_flood_is_answered_and_pongs_are_passed_over(
    edge: Callable[..., Any], control: Callable[..., Any]
) -> None:
    server = edge()
    with unharmed(server, control), Raw(server.port) as raw:
        for number in range(2000):
            data = number.to_bytes(2)
            raw.sock.sendall(frame(PONG, data) + frame(PING, data) + frame(PONG))
            assert raw.receive() == (PONG, data)


@pytest.mark.fault("N19")
def test_n19_pings_nobody_waits_for_do_not_fill_memory(edge: Callable[..., Any], control: Callable[..., Any]) -> None:
    """A client that sends pings without end and reads none of the answers is stopped or cut, not served from memory."""
    server = edge()
    flood = frame(PING, b"x" * 125) * 1000
    with unharmed(server, control), Raw(server.port, receive_bytes=4096) as raw:
        tracemalloc.start()
        try:
            raw.sock.settimeout(0.2)
            sent = 0
            with suppress(TimeoutError, ConnectionError):
                for sent in range(150):  # noqa: B007  (how far it came, whatever ended it)
                    raw.sock.sendall(flood)
            print("flooded with", sent, "of 150")
            assert tracemalloc.get_traced_memory()[0] < 4 * MIB
        finally:
            tracemalloc.stop()
