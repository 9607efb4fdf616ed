import pytest
from websockets.frames import Frame, Opcode
from websockets.protocol import Protocol, Side

from simconsole.bridge.protocol.frames import (
    ASSEMBLY_NS,
    BINARY,
    CLOSE,
    CONTINUATION,
    FRAME_BYTES,
    INVALID_DATA,
    PING,
    TEXT,
    FrameWriter,
    MessageAssembler,
    check_close,
    framed,
)
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.values.errors import FrameError


def test_opcodes_are_those_of_the_rfc() -> None:
    named = {
        Opcode.CONT: CONTINUATION,
        Opcode.TEXT: TEXT,
        Opcode.BINARY: BINARY,
        Opcode.CLOSE: CLOSE,
        Opcode.PING: PING,
    }
    assert all(opcode == number for opcode, number in named.items())
    assert [opcode < CLOSE for opcode in Opcode] == [True, True, True, False, False, False]


def test_fragments_are_joined() -> None:
    messages = MessageAssembler(100, 10)
    assert messages.add(TEXT, b"whole", True, 0) == b"whole"
    assert messages.add(TEXT, b"a", False, 0) is None
    assert messages.add(CONTINUATION, b"b", False, 0) is None
    assert messages.add(CONTINUATION, b"c", True, 0) == b"abc"
    assert messages.add(TEXT, b"", False, 0) is None
    assert messages.add(CONTINUATION, b"next", True, 0) == b"next"


def test_binary_messages_are_told_from_texts() -> None:
    messages = MessageAssembler(100, 10)
    assert isinstance(messages.add(BINARY, b"x", True, 0), Binary)
    assert messages.add(BINARY, b"x", False, 0) is None
    whole = messages.add(CONTINUATION, b"y", True, 0)
    assert isinstance(whole, Binary)
    assert whole == b"xy"
    assert not isinstance(messages.add(TEXT, b"z", True, 0), Binary)


@pytest.mark.parametrize(
    "opening", [(), ((TEXT, b"x", False), (TEXT, b"y", True)), ((BINARY, b"", False), (TEXT, b"", False))]
)
def test_messages_do_not_begin_inside_of_others(opening: tuple[tuple[int, bytes, bool], ...]) -> None:
    messages = MessageAssembler(100, 10)
    *before, last = opening or ((CONTINUATION, b"x", True),)
    for frame in before:
        messages.add(*frame, 0)
    with pytest.raises(FrameError, match="inside of another") as caught:
        messages.add(*last, 0)
    assert caught.value.code == 1002


def test_message_that_is_too_long_is_refused_whole_or_in_pieces() -> None:
    assert MessageAssembler(3, 10).add(TEXT, b"abc", True, 0) == b"abc"
    with pytest.raises(FrameError, match="longer than 3 bytes") as caught:
        MessageAssembler(3, 10).add(TEXT, b"abcd", True, 0)
    assert caught.value.code == 1009
    pieces = MessageAssembler(3, 10)
    assert pieces.add(TEXT, b"ab", False, 0) is None
    with pytest.raises(FrameError, match="longer than 3 bytes"):
        pieces.add(CONTINUATION, b"cd", False, 0)


def test_number_of_fragments_is_limited() -> None:
    messages = MessageAssembler(100, 3)
    for _ in range(2):
        assert messages.add(TEXT, b"a", False, 0) is None
        assert messages.add(CONTINUATION, b"b", False, 0) is None
        assert messages.add(CONTINUATION, b"", True, 0) == b"ab"
    assert messages.add(TEXT, b"", False, 0) is None
    assert messages.add(CONTINUATION, b"", False, 0) is None
    with pytest.raises(FrameError, match="more than 3 fragments") as caught:
        messages.add(CONTINUATION, b"", False, 0)
    assert caught.value.code == 1008


def test_time_of_a_message_is_limited() -> None:
    messages = MessageAssembler(100, 3)
    assert messages.overdue(99 * ASSEMBLY_NS) is None
    assert messages.add(TEXT, b"a", False, 5) is None
    assert messages.overdue(5 + ASSEMBLY_NS) is None
    assert "more than 2 s" in str(messages.overdue(6 + ASSEMBLY_NS))
    with pytest.raises(FrameError, match="more than 2 s") as caught:
        messages.add(CONTINUATION, b"b", True, 6 + ASSEMBLY_NS)
    assert caught.value.code == 1008


def test_client_waits_for_its_server_s_message_as_long_as_it_takes() -> None:
    messages = MessageAssembler(10_000)
    assert messages.add(TEXT, b"a", False, 0) is None
    for _ in range(1000):
        assert messages.add(CONTINUATION, b"a", False, 99 * ASSEMBLY_NS) is None
    assert messages.overdue(99 * ASSEMBLY_NS) is None
    assert messages.add(CONTINUATION, b"a", True, 99 * ASSEMBLY_NS) == b"a" * 1002


@pytest.mark.parametrize("code", [1000, 1001, 1003, 1007, 1014, 3000, 4999])
def test_codes_that_a_frame_may_carry(code: int) -> None:
    check_close(code.to_bytes(2) + "süß".encode())
    check_close(b"")


@pytest.mark.parametrize("code", [0, 999, 1004, 1005, 1006, 1015, 2999, 5000, 65535])
def test_codes_that_none_may(code: int) -> None:
    with pytest.raises(FrameError) as caught:
        check_close(code.to_bytes(2))
    assert caught.value.code == 1002


@pytest.mark.parametrize(("data", "code"), [(b"\x03", 1002), (b"\x03\xe8\xff", 1007)])
def test_close_frames_that_are_none(data: bytes, code: int) -> None:
    with pytest.raises(FrameError) as caught:
        check_close(data)
    assert caught.value.code == code


@pytest.mark.parametrize("length", [0, 1, 125, 126, 65_535, 65_536, 300_000])
@pytest.mark.parametrize("kind", [bytes, Binary])
def test_frames_are_the_library_s_own(length: int, kind: type[bytes]) -> None:
    message = kind(b"x" * length)
    opcode = Opcode.BINARY if kind is Binary else Opcode.TEXT
    frame = Frame(opcode, message).serialize(mask=False)
    assert framed([message]) == frame
    assert framed([message, b"{}"]) == frame + b"\x81\x02{}"


def assemble(parts: list[bytes]) -> bytes | None:
    """What becomes of a text in as many frames."""
    messages, whole = MessageAssembler(100, 100), None
    for number, part in enumerate(parts):
        whole = messages.add(CONTINUATION if number else TEXT, part, number == len(parts) - 1, 0)
    return whole


@pytest.mark.parametrize("text", [b"\xff", b"\xc3", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"\xc0\xaf"])
def test_text_that_is_no_utf8_is_refused_whole_or_in_frames(text: bytes) -> None:
    for parts in ([text], [b"{", text], [bytes([byte]) for byte in b'{"\xc3\xa4":"' + text]):
        with pytest.raises(FrameError) as refusal:
            assemble(parts)
        assert refusal.value.code == INVALID_DATA
    assert MessageAssembler(100, 100).add(BINARY, text, True, 0) == text


def test_wrong_text_is_refused_with_the_first_frame_that_has_it() -> None:
    messages = MessageAssembler(100, 100)
    with pytest.raises(FrameError):
        messages.add(TEXT, b"\xff", False, 0)


def test_characters_may_be_divided_between_frames() -> None:
    text = "\U0001f697 fährt".encode()
    assert assemble([bytes([byte]) for byte in text]) == text


@pytest.mark.parametrize("kind", [bytes, Binary])
def test_long_message_goes_out_in_several_frames_a_batch_at_a_time(kind: type[bytes]) -> None:
    message = kind(bytes(range(97, 123)) * (2 * FRAME_BYTES // 26 + 1))
    given = iter([b"{}", message, b"[]"])
    writer = FrameWriter()
    batches, inside = [], []
    while batch := writer.batch(lambda: next(given, None), 1000):
        batches.append(batch)
        inside.append(writer.is_inside)
    assert (inside[0], inside[-1]) == (True, False)
    assert max(map(len, batches)) <= FRAME_BYTES + 14
    protocol = Protocol(Side.CLIENT, max_size=None)
    protocol.receive_data(b"".join(batches))
    messages, found = MessageAssembler(len(message)), []
    for frame in protocol.events_received():
        assert isinstance(frame, Frame)
        whole = messages.add(frame.opcode, bytes(frame.data), frame.fin, 0)
        if whole is not None:
            found.append(whole)
    assert found == [b"{}", message, b"[]"]
    assert [isinstance(each, Binary) for each in found] == [False, kind is Binary, False]
