import logging
import socket

import pytest
from websockets.frames import Frame, Opcode

from simconsole.bridge.documents import Binary
from simconsole.bridge.protocol import Outcome
from simconsole.bridge.session import Session
from simconsole.bridge.wire import (
    ASSEMBLY_NS,
    FragmentLimit,
    MessageAssembler,
    address_url,
    frame_head,
    is_data,
    is_unacknowledged,
    listen,
    log_outcome,
)
from simconsole.errors import BridgeError
from tests.bridge.networks import go_deaf


def test_fragments_are_joined() -> None:
    messages = MessageAssembler()
    assert messages.add(Frame(Opcode.TEXT, b"whole")) == b"whole"
    assert messages.add(Frame(Opcode.TEXT, b"a", fin=False)) is None
    assert messages.add(Frame(Opcode.CONT, b"b", fin=False)) is None
    assert messages.add(Frame(Opcode.CONT, b"c")) == b"abc"
    assert messages.add(Frame(Opcode.TEXT, b"next")) == b"next"


def test_binary_messages_are_told_from_texts() -> None:
    messages = MessageAssembler()
    assert isinstance(messages.add(Frame(Opcode.BINARY, b"x")), Binary)
    assert messages.add(Frame(Opcode.BINARY, b"x", fin=False)) is None
    whole = messages.add(Frame(Opcode.CONT, b"y"))
    assert isinstance(whole, Binary)
    assert whole == b"xy"
    assert not isinstance(messages.add(Frame(Opcode.TEXT, b"z")), Binary)


def test_number_of_fragments_and_their_time_are_limited() -> None:
    limit = FragmentLimit(3)
    begin, more, end = Frame(Opcode.TEXT, b"a", fin=False), Frame(Opcode.CONT, b"b", fin=False), Frame(Opcode.CONT, b"")
    for _ in range(2):
        assert [limit.add(frame, 0) for frame in (begin, more, end)] == [None] * 3
    assert limit.add(begin, 0) is None
    assert limit.add(more, 0) is None
    assert "more than 3 fragments" in str(limit.add(more, 0))
    assert limit.add(begin, 5) is None
    assert limit.overdue(5 + ASSEMBLY_NS) is None
    assert limit.add(Frame(Opcode.PING, b""), 6 + ASSEMBLY_NS) is None
    assert limit.overdue(6 + ASSEMBLY_NS) == limit.add(more, 6 + ASSEMBLY_NS) != None  # noqa: E711  (a chain)
    assert limit.add(end, 6 + ASSEMBLY_NS) is None
    assert limit.overdue(99 * ASSEMBLY_NS) is None


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


@pytest.mark.parametrize("length", [0, 1, 125, 126, 65_535, 65_536, 300_000])
@pytest.mark.parametrize("kind", [bytes, Binary])
def test_frames_are_the_library_s_own(length: int, kind: type[bytes]) -> None:
    message = kind(b"x" * length)
    opcode = Opcode.BINARY if kind is Binary else Opcode.TEXT
    assert frame_head(message) + message == Frame(opcode, message).serialize(mask=False)


def test_control_frames_carry_no_message() -> None:
    assert [is_data(Frame(opcode, b"")) for opcode in Opcode] == [True, True, True, False, False, False]


def test_address_in_use_is_one_line() -> None:
    with listen("127.0.0.1", 0) as taken:
        port = taken.getsockname()[1]
        assert not taken.getblocking()
        with pytest.raises(BridgeError, match=f"cannot listen on 127.0.0.1 port {port}"):
            listen("127.0.0.1", port)


def test_addresses_as_clients_write_them() -> None:
    assert address_url("127.0.0.1", 9090) == "ws://127.0.0.1:9090"
    assert address_url("::1", 9090) == "ws://[::1]:9090"


def test_flood_of_refusals_does_not_fill_the_log(caplog: pytest.LogCaptureFixture) -> None:
    logger = logging.getLogger("simconsole.bridge.test")
    session = Session(1, "peer", 1000, lambda: None)
    with caplog.at_level(logging.INFO, logger.name):
        for number in range(1, 5001):
            session.refused = number
            log_outcome(logger, session, Outcome("refused", "/cmd", "no"))
        log_outcome(logger, session, Outcome("done", "/cmd", ""))
        log_outcome(logger, session, Outcome("remark", "", "info: hello"))
    lines = [record.getMessage() for record in caplog.records]
    assert len(lines) == 10 + 5 + 1
    assert lines[0] == "peer: refused (1): /cmd no"
    assert lines[-1] == "peer: says info: hello"
