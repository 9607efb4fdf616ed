"""WebSocket frames and messages, independent of the library (RFC 6455): reassembly, limits, frame headers."""

import codecs
import struct
from collections.abc import Callable, Iterable, Iterator
from typing import Final

from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.values.errors import FrameError
from simconsole.values.units import NS_PER_S

CONTINUATION: Final = 0
TEXT: Final = 1
BINARY: Final = 2
CLOSE: Final = 8
PING: Final = 9
"""Opcodes (5.2); those from CLOSE on are of control frames, those before carry messages."""

GOING_AWAY: Final = 1001
PROTOCOL_ERROR: Final = 1002
INVALID_DATA: Final = 1007
POLICY_VIOLATION: Final = 1008
TOO_BIG: Final = 1009
"""Close codes (7.4.1)."""

ASSEMBLY_NS: Final = 2 * NS_PER_S
"""The longest that one message may be on its way once its first frame is here."""
_MEDIUM: Final = struct.Struct("!BBH")
"""The header of a frame of 126 to 65,535 bytes: what most messages have."""
FRAME_BYTES: Final = 262_144
"""A longer message is sent in several frames, so that no more than one of them waits outside of the bounded queues."""
_Utf8: Final = codecs.getincrementaldecoder("utf-8")
_REGISTERED: Final = {1000, 1001, 1002, 1003, *range(1007, 1015)}
_PRIVATE: Final = range(3000, 5000)


class MessageAssembler:
    """Joins the frames of messages; refuses one in too many of them, too long, too long on its way, or no UTF-8.

    The first three are N08 and N13; text is checked frame by frame (8.1), so that wrong text is refused with the first
    frame that has it.

    Time is given, in ns.
    """

    def __init__(self, max_bytes: int, max_fragments: int | None = None) -> None:
        """Allow messages of `max_bytes` in `max_fragments` frames within ASSEMBLY_NS; None: in any number and time."""
        self.max_bytes = max_bytes
        self._max_fragments = max_fragments
        self._parts: list[bytes] = []
        self._bytes = 0
        self._binary = False
        self._utf8 = _Utf8()
        self._since_ns = 0

    def add(self, opcode: int, data: bytes, fin: bool, now_ns: int) -> bytes | None:
        """Take the next data frame; return the message when it is complete, `Binary` if it is no text.

        Raises:
            FrameError: the connection has to be closed.
        """
        if (opcode == CONTINUATION) is not bool(self._parts):
            raise FrameError(PROTOCOL_ERROR, "a message begins inside of another, or goes on where there is none")
        if opcode != CONTINUATION:
            self._binary = opcode == BINARY
            if fin and len(data) <= self.max_bytes:
                if not self._binary and not data.isascii():
                    self._check_text(data, True)
                return Binary(data) if self._binary else data
            self._bytes, self._since_ns = 0, now_ns
        self._parts.append(data)
        self._bytes += len(data)
        if self._bytes > self.max_bytes:
            raise FrameError(TOO_BIG, f"message is longer than {self.max_bytes} bytes")
        late = self.overdue(now_ns)
        if late is not None:
            raise FrameError(POLICY_VIOLATION, late)
        if not self._binary:
            self._check_text(data, fin)
        if not fin:
            if self._max_fragments is not None and len(self._parts) >= self._max_fragments:
                raise FrameError(POLICY_VIOLATION, f"message is in more than {self._max_fragments} fragments")
            return None
        whole = b"".join(self._parts)
        self._parts = []
        return Binary(whole) if self._binary else whole

    def _check_text(self, data: bytes, fin: bool) -> None:
        try:
            self._utf8.decode(data, fin)
        except UnicodeDecodeError:
            raise FrameError(INVALID_DATA, "a text is no UTF-8") from None

    def overdue(self, now_ns: int) -> str | None:
        """Return why a message that is not complete is no longer waited for, None while it is or there is none."""
        if self._parts and self._max_fragments is not None and now_ns - self._since_ns > ASSEMBLY_NS:
            return f"message has been coming for more than {ASSEMBLY_NS // NS_PER_S} s"
        return None


def check_close(data: bytes) -> None:
    """Check what a close frame carries: nothing, or a code that may be sent and a reason in UTF-8 (5.5.1, 7.4).

    Raises:
        FrameError: it is none of these.
    """
    if not data:
        return
    code = int.from_bytes(data[:2])
    if len(data) < 2 or not (code in _REGISTERED or code in _PRIVATE):
        raise FrameError(PROTOCOL_ERROR, "a close frame has a code that no frame may carry")
    try:
        data[2:].decode()
    except UnicodeDecodeError:
        raise FrameError(INVALID_DATA, "a close frame's reason is no UTF-8") from None


class FrameWriter:
    """What one connection sends: messages, text or `Binary`, as a server's frames, some at a time."""

    def __init__(self) -> None:
        """Start between two messages."""
        self._rest: Iterator[bytes] | None = None

    @property
    def is_inside(self) -> bool:
        """Whether a message has begun of which frames are left."""
        return self._rest is not None

    def batch(self, take: Callable[[], bytes | None], enough_bytes: int) -> bytes:
        """Return frames of the messages that `take` gives until it gives None or they are `enough_bytes`."""
        parts: list[bytes] = []
        size = 0
        while size < enough_bytes:
            if self._rest is not None:
                part = next(self._rest, None)
                if part is None:
                    self._rest = None
                    continue
            else:
                part = take()
                if part is None:
                    break
                if len(part) > FRAME_BYTES:
                    self._rest = _in_frames(part)
                    continue
                parts.append(_header(part))
            parts.append(part)
            size += len(part)
        return b"".join(parts)


def framed(messages: Iterable[bytes]) -> bytes:
    """Return whole messages, text or `Binary`, as a server's frames, one after another."""
    return b"".join(part for message in messages for part in (_header(message), message))


def _in_frames(message: bytes) -> Iterator[bytes]:
    opcode = BINARY if isinstance(message, Binary) else TEXT
    for start in range(0, len(message), FRAME_BYTES):
        data = message[start : start + FRAME_BYTES]
        last = start + FRAME_BYTES >= len(message)
        yield _head((0x80 if last else 0) | (CONTINUATION if start else opcode), len(data)) + data


def _header(message: bytes) -> bytes:
    """Return the header of a server's frame for a whole message: final, unmasked, binary or text (5.2)."""
    return _head(0x80 | (BINARY if isinstance(message, Binary) else TEXT), len(message))


def _head(opcode: int, length: int) -> bytes:
    if length < 126:
        return bytes((opcode, length))
    if length < 65_536:
        return _MEDIUM.pack(opcode, 126, length)
    return bytes((opcode, 127)) + length.to_bytes(8)
