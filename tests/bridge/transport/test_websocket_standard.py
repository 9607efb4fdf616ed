"""The WebSocket standard's cases of UTF-8 (RFC 6455, 5.6, 7.1.6, 8.1) and compression (RFC 7692) on each transport.

Compression is never agreed on: an offer is answered without it, and a frame that claims it ends the connection. By
themselves neither library checks the UTF-8 of a text here, and picows no reserved bits: the checks are the bridge's own
(`frames.MessageAssembler`, `PicowsConnection.on_ws_frame`), for the lockstep server as for the two others.
"""

import json
import zlib
from collections.abc import Iterator
from typing import Any, Final

import pytest

from simconsole.profiles.bridge import BridgeProfile
from tests.bridge.networks import CLOSE, PING, PONG, TEXT, Raw
from tests.faults.conftest import EDGES

CONTINUATION: Final = 0
VALID: Final = {
    "nothing": b"",
    "ascii": b"Hello",
    "greek": b"\xce\xba\xe1\xbd\xb9\xcf\x83\xce\xbc\xce\xb5",
    "delete": b"\x7f",
    "first of two octets": b"\xc2\x80",
    "last of two octets": b"\xdf\xbf",
    "first of three octets": b"\xe0\xa0\x80",
    "last before the surrogates": b"\xed\x9f\xbf",
    "first after the surrogates": b"\xee\x80\x80",
    "replacement character": b"\xef\xbf\xbd",
    "last of three octets": b"\xef\xbf\xbf",
    "byte order mark": b"\xef\xbb\xbf",
    "non-characters": b"\xef\xb7\x90\xef\xbf\xbe\xf0\x9f\xbf\xbe",
    "first of four octets": b"\xf0\x90\x80\x80",
    "last of all": b"\xf4\x8f\xbf\xbf",
}
INVALID: Final = {
    "continuation alone": b"\x80",
    "last continuation alone": b"\xbf",
    "continuations": b"\x80\xbf\x80\xbf",
    "start of two alone": b"\xc2",
    "start of two before a space": b"\xc3\x20",
    "start of three cut": b"\xe2\x82",
    "start of four cut": b"\xf0\x9f\x9a",
    "two cut ones": b"\xe2\x82\xf0\x9f\x9a",
    "overlong slash in two": b"\xc0\xaf",
    "overlong slash in three": b"\xe0\x80\xaf",
    "overlong slash in four": b"\xf0\x80\x80\xaf",
    "overlong slash in five": b"\xf8\x80\x80\x80\xaf",
    "overlong slash in six": b"\xfc\x80\x80\x80\x80\xaf",
    "longest overlong of two": b"\xc1\xbf",
    "longest overlong of three": b"\xe0\x9f\xbf",
    "longest overlong of four": b"\xf0\x8f\xbf\xbf",
    "overlong zero": b"\xc0\x80",
    "first surrogate": b"\xed\xa0\x80",
    "last surrogate": b"\xed\xbf\xbf",
    "pair of surrogates": b"\xed\xa0\xbd\xed\xba\x97",
    "beyond the last": b"\xf4\x90\x80\x80",
    "five octets": b"\xf8\x88\x80\x80\x80",
    "six octets": b"\xfc\x84\x80\x80\x80\x80",
    "octet fe": b"\xfe",
    "octet ff": b"\xff",
    "invalid behind valid": b"\xce\xba\xe1\xbd\xb9\xed\xa0\x80edited",
}
OFFERS: Final = [
    "permessage-deflate",
    "permessage-deflate; client_no_context_takeover; server_no_context_takeover",
    "permessage-deflate; client_max_window_bits",
    "permessage-deflate; client_max_window_bits=15; server_max_window_bits=10",
    "permessage-deflate; server_max_window_bits=8, permessage-deflate",
    "permessage-deflate; no_such_parameter=1",
    "x-webkit-deflate-frame",
]


@pytest.fixture(params=EDGES, scope="module")
def server(request: pytest.FixtureRequest) -> Iterator[Any]:
    kind, transport = EDGES[request.param]
    profile: dict[str, Any] = {"port": 0, "transport": transport}
    started: Any = kind(BridgeProfile(**profile))
    yield started
    started.stop()


def ways(data: bytes) -> list[list[bytes]]:
    """A message whole, in two frames at each place near its end, and octet by octet."""
    return [[data], [data[:-4], data[-4:]], [data[:-3], b"", data[-3:]], [bytes([octet]) for octet in data]]


def say(raw: Raw, frames: list[bytes], **first: Any) -> None:
    for number, part in enumerate(frames):
        opcode = CONTINUATION if number else TEXT
        raw.send(opcode, part, fin=number == len(frames) - 1, **(first if not number else {}))


def publication(text: bytes) -> bytes:
    return b'{"op":"publish","topic":"/echo","type":"std_msgs/String","msg":{"data":"' + text + b'"}}'


@pytest.mark.parametrize("text", VALID.values(), ids=VALID)
def test_text_of_the_standard_passes(server: Any, text: bytes) -> None:
    with Raw(server.port) as raw:
        raw.say(op="subscribe", topic="/echo", type="std_msgs/String")
        for frames in ways(publication(text)):
            say(raw, frames)
            received = raw.receive()
            assert received is not None
            assert received[0] == TEXT
            assert json.loads(received[1])["msg"]["data"].encode() == text


@pytest.mark.parametrize("text", INVALID.values(), ids=INVALID)
def test_text_that_is_none_closes_with_1007(server: Any, text: bytes) -> None:
    for frames in ways(publication(text)):
        with Raw(server.port) as raw:
            say(raw, frames)
            assert raw.close_code() == 1007


def test_wrong_text_is_refused_before_its_message_ends(server: Any) -> None:
    with Raw(server.port) as raw:
        raw.send(TEXT, b'{"\xff', fin=False)
        assert raw.close_code() == 1007


@pytest.mark.parametrize("text", INVALID.values(), ids=INVALID)
def test_reason_of_a_close_must_be_text_too(server: Any, text: bytes) -> None:
    with Raw(server.port) as raw:
        raw.send(CLOSE, (1000).to_bytes(2) + text)
        assert raw.close_code() in (1002, 1007)


@pytest.mark.parametrize("offer", OFFERS)
def test_offer_of_compression_is_answered_without_it(server: Any, offer: str) -> None:
    with Raw(server.port, headers=f"Sec-WebSocket-Extensions: {offer}\r\n") as raw:
        assert raw.response.startswith(b"HTTP/1.1 101")
        assert b"extensions" not in raw.response.lower()
        raw.send(PING, b"x")
        assert raw.receive() == (PONG, b"x")


@pytest.mark.parametrize("rsv", [1, 2, 4, 5, 7])
@pytest.mark.parametrize("opcode", [TEXT, 2, PING, CLOSE])
def test_reserved_bits_without_an_extension_close_with_1002(server: Any, rsv: int, opcode: int) -> None:
    with Raw(server.port) as raw:
        raw.send(opcode, b"", rsv=rsv)
        assert raw.close_code() == 1002


def test_compressed_message_that_nobody_agreed_on_closes_with_1002(server: Any) -> None:
    squeezer = zlib.compressobj(wbits=-15)
    data = squeezer.compress(publication(b"x" * 1000)) + squeezer.flush(zlib.Z_SYNC_FLUSH)
    with Raw(server.port, headers="Sec-WebSocket-Extensions: permessage-deflate\r\n") as raw:
        raw.send(TEXT, data[:-4], rsv=4)
        assert raw.close_code() == 1002
    with Raw(server.port) as raw:
        raw.send(TEXT, b"{", fin=False)
        raw.send(CONTINUATION, b"}", rsv=4)
        assert raw.close_code() == 1002
