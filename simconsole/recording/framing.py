"""The frames of the append log: one frame holds all of one tick and is written at once.

::

    length u32 | crc32 u32 | tick i64 | state vector, float64 * columns | chained hash (8) | messages
    each message    stream u16 | length u32 | content | chained hash (8)

Lengths, checksums and ticks are little-endian everywhere, so that a log of another machine is at least recognised;
state vectors are the recording machine's own float64, whose byte order the header states. A chained hash is blake2b
over the stream's previous hash, the tick and the content: two drives are equal exactly if their last hashes are.
"""

from collections.abc import Iterator
from hashlib import blake2b
from struct import Struct
from typing import Final, NamedTuple
from zlib import crc32

import numpy as np

from simconsole.recording.log_header import LogHeader
from simconsole.values.kernels import Row

HASH_BYTES: Final = 8
START_OF_CHAIN: Final = bytes(HASH_BYTES)
MAX_FRAME_BYTES: Final = 1 << 22
"""A reader holds one frame in memory, and this much of what a damaged length promises."""
TORN: Final = "torn"
_HEAD: Final = Struct("<II")
_TICK: Final = Struct("<q")
_MESSAGE: Final = Struct("<HI")
_HASHER: Final = blake2b(digest_size=HASH_BYTES)


class SealedMessage(NamedTuple):
    """One message as recorded: its stream's place in the header, and the stream's chained hash up to it."""

    stream: int
    content: bytes
    digest: bytes


class Record(NamedTuple):
    """One tick as recorded: state vector, the chained hash up to and including it, and the messages of the tick."""

    tick: int
    vector: Row
    digest: bytes
    messages: tuple[SealedMessage, ...] = ()


class Message(NamedTuple):
    """One message of a stream, and the tick in which it arrived."""

    tick: int
    content: bytes


def _chained(previous: bytes, content: bytes) -> bytes:
    hasher = _HASHER.copy()  # takes half the time of a new one with a digest_size
    hasher.update(previous)
    hasher.update(content)
    return hasher.digest()


def frame_size(width: int) -> int:
    """Return the bytes of a tick's frame without messages, for state vectors of `width` columns."""
    return _HEAD.size + _TICK.size + 8 * width + HASH_BYTES


def chain(previous: bytes, tick: int, content: bytes) -> bytes:
    """Return a stream's chained hash after a vector or message, from the hash before it."""
    return _chained(previous, _TICK.pack(tick) + content)


def seal(previous: bytes, tick: int, vector: bytes, messages: bytes = b"") -> tuple[bytes, bytes]:
    """Return the frame of one tick and the state's chained hash in it; `messages` are sealed ones, in a row."""
    body = _TICK.pack(tick) + vector
    digest = _chained(previous, body)
    body += digest + messages
    return _HEAD.pack(len(body), crc32(body)) + body, digest


def seal_block(previous: bytes, tick: int, vectors: Row, messages: bytes = b"") -> tuple[bytes, bytes]:
    """Return the frames of ticks, one behind the other, as `seal` makes them, and the state's chained hash in the last.

    Args:
        previous: the chained hash before them.
        tick: the first.
        vectors: float64 [ticks, columns], the state vectors.
        messages: those of the first tick, sealed, in a row.
    """
    content, size = vectors.tobytes(), 8 * vectors.shape[1]
    frames: list[bytes] = []
    for at in range(0, len(content), size):
        frame, previous = seal(previous, tick, content[at : at + size], messages)
        frames.append(frame)
        tick, messages = tick + 1, b""
    return b"".join(frames), previous


def seal_message(previous: bytes, tick: int, stream: int, content: bytes) -> tuple[bytes, bytes]:
    """Return the bytes of one message in its tick's frame, and its stream's chained hash in it."""
    digest = chain(previous, tick, content)
    return _MESSAGE.pack(stream, len(content)) + content + digest, digest


def unseal(frame: bytes, header: LogHeader) -> Record | str:
    """Return the record in one frame, or why there is none. The state vector is a read-only view of the frame."""
    size, width = len(frame), len(header.columns)
    least = frame_size(width)
    length = promised_size(frame, least)
    if not plausible(length, header):
        return f"damaged, length {length - _HEAD.size} instead of {least - _HEAD.size}"
    if size < length:
        return _torn(frame, length, header)
    if crc32(memoryview(frame)[_HEAD.size :]) != _HEAD.unpack_from(frame)[1]:
        return "damaged, wrong checksum"
    vector = np.frombuffer(frame, dtype=np.float64, count=width, offset=_HEAD.size + _TICK.size)
    messages: tuple[SealedMessage, ...] = ()
    if size > least:
        messages = tuple(_messages(frame, least, len(header.streams)))
        if not messages or sum(_message_size(message) for message in messages) != size - least:
            return "damaged, its messages do not fill it"
    return Record(_TICK.unpack_from(frame, _HEAD.size)[0], vector, frame[least - HASH_BYTES : least], messages)


def promised_size(frame: bytes, least: int) -> int:
    """Return the size in bytes that the first bytes of a frame state, `least` where they are cut off."""
    return _HEAD.size + int.from_bytes(frame[:4], "little") if len(frame) >= 4 else least


def plausible(size: int, header: LogHeader) -> bool:
    """Return whether a frame of a log with this header may have `size` bytes."""
    least = frame_size(len(header.columns))
    return size == least or (len(header.streams) > 1 and least < size <= MAX_FRAME_BYTES)


def _torn(frame: bytes, length: int, header: LogHeader) -> str:
    """Return why a frame is shorter than it says: the file ends in it, or its length is damaged."""
    least = frame_size(len(header.columns))
    if len(frame) >= least:
        if crc32(memoryview(frame)[_HEAD.size :]) == _HEAD.unpack_from(frame)[1]:
            return f"damaged, length {length - _HEAD.size} instead of {len(frame) - _HEAD.size}"
        messages = list(_messages(frame, least, len(header.streams)))
        rest = least + sum(_message_size(message) for message in messages)
        if len(frame) >= rest + 2 and not 0 < int.from_bytes(frame[rest : rest + 2], "little") < len(header.streams):
            return "damaged, wrong length"
    return f"{TORN}, {len(frame)} of {length} bytes"


def _messages(frame: bytes, at: int, streams: int) -> Iterator[SealedMessage]:
    """Yield the whole messages that lie one behind the other from byte `at` on."""
    while at + _MESSAGE.size <= len(frame):
        stream, length = _MESSAGE.unpack_from(frame, at)
        start, end = at + _MESSAGE.size, at + _MESSAGE.size + length
        at = end + HASH_BYTES
        if not 0 < stream < streams or at > len(frame):
            return
        yield SealedMessage(stream, frame[start:end], frame[end:at])


def _message_size(message: SealedMessage) -> int:
    return _MESSAGE.size + len(message.content) + HASH_BYTES
