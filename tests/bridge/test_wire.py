import logging

import pytest
from websockets.frames import Frame, Opcode

from simconsole.bridge.protocol import Outcome
from simconsole.bridge.session import Session
from simconsole.bridge.wire import TextAssembler, address_url, is_data, listen, log_outcome
from simconsole.errors import BridgeError, RemoteProtocolError


def test_fragments_are_joined() -> None:
    texts = TextAssembler(4)
    assert texts.add(Frame(Opcode.TEXT, b"whole")) == b"whole"
    assert texts.add(Frame(Opcode.TEXT, b"a", fin=False)) is None
    assert texts.add(Frame(Opcode.CONT, b"b", fin=False)) is None
    assert texts.add(Frame(Opcode.CONT, b"c")) == b"abc"
    assert texts.add(Frame(Opcode.TEXT, b"next")) == b"next"


def test_too_many_fragments_are_refused() -> None:
    texts = TextAssembler(3)
    texts.add(Frame(Opcode.TEXT, b"a", fin=False))
    texts.add(Frame(Opcode.CONT, b"b", fin=False))
    with pytest.raises(RemoteProtocolError, match="more than 3 fragments"):
        texts.add(Frame(Opcode.CONT, b"c", fin=False))


def test_binary_is_refused_once_and_forgotten() -> None:
    texts = TextAssembler(4)
    with pytest.raises(RemoteProtocolError, match="binary"):
        texts.add(Frame(Opcode.BINARY, b"x"))
    assert texts.add(Frame(Opcode.BINARY, b"x", fin=False)) is None
    with pytest.raises(RemoteProtocolError, match="binary"):
        texts.add(Frame(Opcode.CONT, b"y"))
    assert texts.add(Frame(Opcode.TEXT, b"z")) == b"z"


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
