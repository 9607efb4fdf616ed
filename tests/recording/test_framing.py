import struct
from zlib import crc32

import numpy as np
import pytest

from simconsole.recording.framing import (
    START_OF_CHAIN,
    Record,
    chain,
    frame_size,
    plausible,
    promised_size,
    seal,
    seal_block,
    seal_message,
    unseal,
)
from simconsole.recording.log_header import LogHeader, vector_stream
from tests.recording.conftest import with_messages

ROW = np.array([np.nan, -0.0, np.inf, 5e-324])


def test_a_frame_of_the_first_schema_is_what_it_was(header: LogHeader) -> None:
    frame, digest = seal(bytes(range(8)), 9, ROW.tobytes())
    body = struct.pack("<q", 9) + ROW.tobytes() + digest
    assert frame == struct.pack("<II", len(body), crc32(body)) + body
    assert len(frame) == frame_size(4) == promised_size(frame, frame_size(4))
    record = unseal(frame, header)
    assert isinstance(record, Record)
    assert (record.tick, record.vector.tobytes(), record.digest, record.messages) == (9, ROW.tobytes(), digest, ())


@pytest.mark.parametrize("messages", [b"", b"sealed messages of the first tick"])
@pytest.mark.parametrize("ticks", [1, 2, 65])
def test_a_block_of_frames_is_the_frames_one_by_one(ticks: int, messages: bytes) -> None:
    vectors = np.random.default_rng(ticks).normal(size=(ticks, 7))
    vectors[0, :4] = ROW
    digest, expected = bytes(range(8)), b""
    for tick, vector in enumerate(vectors, start=9):
        frame, digest = seal(digest, tick, vector.tobytes(), messages if tick == 9 else b"")
        expected += frame
    frames, last = seal_block(bytes(range(8)), 9, vectors, messages)
    assert bytes(frames) == expected
    assert last == digest


def test_the_hash_chains_over_tick_and_content() -> None:
    assert chain(START_OF_CHAIN, 1, b"a") != chain(START_OF_CHAIN, 2, b"a")
    assert chain(START_OF_CHAIN, 1, b"a") != chain(bytes(7) + b"\1", 1, b"a")
    assert seal(START_OF_CHAIN, 1, b"a" * 8)[1] == chain(START_OF_CHAIN, 1, b"a" * 8)
    assert seal_message(START_OF_CHAIN, 1, 1, b"note")[1] == chain(START_OF_CHAIN, 1, b"note")


def test_messages_lie_behind_the_vector_and_leave_its_hash_alone(header: LogHeader) -> None:
    first, digest = seal_message(START_OF_CHAIN, 9, 1, b"a note")
    second, _ = seal_message(digest, 9, 1, b"")
    frame, state = seal(START_OF_CHAIN, 9, ROW.tobytes(), first + second)
    assert state == seal(START_OF_CHAIN, 9, ROW.tobytes())[1]
    record = unseal(frame, with_messages(header))
    assert isinstance(record, Record)
    assert record.digest == state
    assert [message[:2] for message in record.messages] == [(1, b"a note"), (1, b"")]
    assert [message.digest for message in record.messages] == [digest, chain(digest, 9, b"")]


@pytest.mark.parametrize("tail", [b"\0", struct.pack("<HI", 3, 0) + bytes(8), struct.pack("<HI", 1, 9) + bytes(8)])
def test_a_frame_whose_messages_do_not_fill_it_is_damaged(header: LogHeader, tail: bytes) -> None:
    frame, _ = seal(START_OF_CHAIN, 9, ROW.tobytes(), tail)
    assert unseal(frame, with_messages(header)) == "damaged, its messages do not fill it"


def test_a_log_without_messages_has_frames_of_one_size(header: LogHeader) -> None:
    message, _ = seal_message(START_OF_CHAIN, 9, 1, b"a note")
    frame, _ = seal(START_OF_CHAIN, 9, ROW.tobytes(), message)
    assert str(unseal(frame, header)).startswith("damaged, length ")
    assert not plausible(frame_size(4) + 1, header)
    assert plausible(frame_size(4) + 1, with_messages(header))
    assert not plausible(1 << 31, with_messages(header))
    assert not plausible(frame_size(4) - 1, with_messages(header))
    assert vector_stream(header.columns, 2) == header.streams[0]
