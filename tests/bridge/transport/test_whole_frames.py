"""Whole frames are taken as the library would take them; whatever else comes is left to it."""

import random

import pytest
from websockets.client import ClientProtocol
from websockets.frames import Frame, Opcode
from websockets.protocol import Protocol, State
from websockets.server import ServerProtocol
from websockets.uri import parse_uri

from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.transport.whole_frames import masked_frame, take_whole

SIDES = ["client", "server"]


def opened(side: str) -> Protocol:
    if side == "server":
        return ServerProtocol(state=State.OPEN, max_size=100_000)
    return ClientProtocol(parse_uri("ws://127.0.0.1"), state=State.OPEN, max_size=100_000)


def frame(side: str, opcode: Opcode, data: bytes, fin: bool = True) -> bytes:
    return Frame(opcode, data, fin).serialize(mask=side == "server")


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("length", [0, 1, 125, 126, 127, 65_535])
def test_whole_messages_are_taken_in_order(side: str, length: int) -> None:
    first, second = bytes(random.randrange(256) for _ in range(length)), b"end"
    data = frame(side, Opcode.BINARY, first) + frame(side, Opcode.TEXT, second)
    frames, rest = take_whole(opened(side), data)
    assert frames == [(2, first), (1, second)]
    assert rest == b""


@pytest.mark.parametrize("side", SIDES)
def test_everything_else_is_left_to_the_library(side: str) -> None:
    whole = frame(side, Opcode.TEXT, b"whole")
    for other in (
        frame(side, Opcode.PING, b"x"),
        frame(side, Opcode.CLOSE, b""),
        frame(side, Opcode.TEXT, b"part", fin=False),
        frame(side, Opcode.CONT, b"part"),
        frame(side, Opcode.TEXT, b"x" * 65_536),
        frame("client" if side == "server" else "server", Opcode.TEXT, b"masked as it must not be"),
        bytes((whole[0] | 0x40, *whole[1:])),
    ):
        frames, rest = take_whole(opened(side), whole + other + whole)
        assert frames == [(1, b"whole")]
        assert rest == other + whole


@pytest.mark.parametrize("side", SIDES)
def test_a_frame_that_has_not_arrived_yet_stays_whole(side: str) -> None:
    data = frame(side, Opcode.TEXT, b"a message of some length" * 10)
    for size in range(len(data)):
        assert take_whole(opened(side), data[:size]) == ([], data[:size])


@pytest.mark.parametrize("side", SIDES)
def test_nothing_is_taken_inside_of_what_the_library_has_begun(side: str) -> None:
    whole = frame(side, Opcode.TEXT, b"whole")
    in_frame, in_message = opened(side), opened(side)
    in_frame.receive_data(whole[:3])
    in_message.receive_data(frame(side, Opcode.TEXT, b"part", fin=False))
    closing = opened(side)
    closing.send_close(1000)
    for web in (in_frame, in_message, closing):
        assert take_whole(web, whole) == ([], whole)


@pytest.mark.parametrize("side", SIDES)
def test_a_message_that_is_too_long_is_the_librarys_to_refuse(side: str) -> None:
    web = opened(side)
    web.max_message_size = 10
    data = frame(side, Opcode.TEXT, b"x" * 11)
    assert take_whole(web, data) == ([], data)


@pytest.mark.parametrize("message", [b"", b"text", Binary(b"\x00\xff"), b"x" * 126, b"x" * 65_535])
def test_a_masked_frame_is_read_back_by_the_library(message: bytes) -> None:
    written = masked_frame(message)
    assert written is not None
    server = opened("server")
    server.receive_data(written)
    (read,) = server.events_received()
    assert isinstance(read, Frame)
    assert bytes(read.data) == message
    assert read.opcode is (Opcode.BINARY if isinstance(message, Binary) else Opcode.TEXT)
    assert masked_frame(b"x" * 65_536) is None
