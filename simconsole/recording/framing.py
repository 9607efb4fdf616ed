"""The append log's bytes: what a frame is, how it is sealed, and what is still whole in a damaged log.

::

    magic (8)   length u32 | crc32 u32 | header JSON
    per tick    length u32 | crc32 u32 | tick i64 | state vector, float64 * columns | chained hash (8)

Lengths, checksums and ticks are little-endian everywhere, so that a log of another machine is at least recognised;
state vectors are the recording machine's own float64, whose byte order the header states. All tick frames of a log have
one length, so reading goes on behind a damaged frame. The chained hash is blake2b over the previous hash, the tick and
the state vector: two drives are equal exactly if their last hashes are.
"""

import sys
from collections.abc import Callable, Iterator
from hashlib import blake2b
from struct import Struct
from typing import Any, Final, NamedTuple
from zlib import crc32

import msgspec
import numpy as np

from simconsole.values.errors import RecordingError
from simconsole.values.kernels import Row

MAGIC: Final = b"\x89SIMLOG\n"  # a byte above 127 first: no text file starts so, and a 7-bit copy destroys it
SCHEMA: Final = 1
HASH_BYTES: Final = 8
START_OF_CHAIN: Final = bytes(HASH_BYTES)
MAX_HEADER_BYTES: Final = 1 << 20
TORN: Final = "torn"
_HEAD: Final = Struct("<II")
_TICK: Final = Struct("<q")
_HASHER: Final = blake2b(digest_size=HASH_BYTES)


class LogHeader(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What a reader must know before the first state vector. Holds no wall time: equal drives make equal logs."""

    tick_hz: int
    columns: tuple[str, ...]
    input_columns: int  # number of leading columns that hold inputs from outside
    console_version: str
    source_sha256: str  # of the sources that made the state vectors
    session_sha256: str  # of the resolved session profile
    schema: int = SCHEMA
    byte_order: str = sys.byteorder
    values: str = "float64"


class Record(NamedTuple):
    """One tick as recorded: its state vector and the chained hash up to and including it."""

    tick: int
    vector: Row
    digest: bytes


class Break(NamedTuple):
    """A place where the log is not whole."""

    offset: int
    size_bytes: int
    reason: str

    @property
    def torn(self) -> bool:
        """Whether it is the beginning of a tick and no more, as a killed process leaves it; anything else is damage."""
        return self.reason.startswith(TORN)

    def __str__(self) -> str:
        """One line for a person."""
        return f"{self.size_bytes} bytes from byte {self.offset}: {self.reason}"


def encode_header(header: LogHeader) -> bytes:
    """Return the first bytes of a log: magic and header frame."""
    text = msgspec.json.encode(header)
    return MAGIC + _HEAD.pack(len(text), crc32(text)) + text


def read_header(read: Callable[[int], bytes], name: str) -> tuple[LogHeader, int]:
    """Read magic and header through `read(size)`; `name` is the file for messages.

    Returns:
        The header and the number of bytes it took.

    Raises:
        RecordingError: not a log, cut before its first tick, damaged, of a newer schema or of another byte order.
    """
    start = read(len(MAGIC) + _HEAD.size)
    if not start.startswith(MAGIC):
        raise RecordingError(f"{name}: not a simconsole log (its first bytes are {start[:8]!r}, not {MAGIC!r})")
    if len(start) < len(MAGIC) + _HEAD.size:
        raise RecordingError(f"{name}: truncated in its header, no tick was recorded")
    size, checksum = _HEAD.unpack_from(start, len(MAGIC))
    if size > MAX_HEADER_BYTES:
        raise RecordingError(f"{name}: header is damaged (length {size} bytes, allowed up to {MAX_HEADER_BYTES})")
    text = read(size)
    if len(text) < size:
        raise RecordingError(f"{name}: truncated in its header, no tick was recorded")
    if crc32(text) != checksum:
        raise RecordingError(f"{name}: header is damaged (checksum {crc32(text):08x}, recorded {checksum:08x})")
    return decode_header(text, name), len(start) + size


def decode_header(text: bytes, name: str) -> LogHeader:
    """Return the header in `text`, refusing what this version cannot read rightly.

    Raises:
        RecordingError: with file, key, value and what is allowed.
    """
    try:
        raw: dict[str, Any] = msgspec.json.decode(text, type=dict[str, Any])
        schema = raw.get("schema")
        if not isinstance(schema, int) or not 1 <= schema <= SCHEMA:
            raise RecordingError(f"{name}: schema: {schema!r} cannot be read, this simconsole reads 1 to {SCHEMA}")
        header = msgspec.convert(raw, LogHeader)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise RecordingError(f"{name}: header: {error}") from None
    if header.byte_order != sys.byteorder:
        raise RecordingError(f"{name}: byte_order: {header.byte_order!r} cannot be read here, only {sys.byteorder!r}")
    if header.values != "float64":
        raise RecordingError(f"{name}: values: {header.values!r} cannot be read, only 'float64'")
    if not 1 <= header.tick_hz <= 1000:
        raise RecordingError(f"{name}: tick_hz: {header.tick_hz} is outside 1 to 1000")
    if not 0 <= header.input_columns <= len(header.columns):
        raise RecordingError(f"{name}: input_columns: {header.input_columns} is outside 0 to {len(header.columns)}")
    return header


def _hash(content: bytes) -> bytes:
    hasher = _HASHER.copy()  # takes half the time of a new one with a digest_size
    hasher.update(content)
    return hasher.digest()


def frame_size(width: int) -> int:
    """Return the bytes of one tick's frame for state vectors of `width` columns."""
    return _HEAD.size + _TICK.size + 8 * width + HASH_BYTES


def chain(previous: bytes, tick: int, vector: bytes) -> bytes:
    """Return the chained hash after a tick, from the hash before it."""
    return _hash(previous + _TICK.pack(tick) + vector)


def seal(previous: bytes, tick: int, vector: bytes) -> tuple[bytes, bytes]:
    """Return the frame of one tick and the chained hash in it."""
    body = _TICK.pack(tick) + vector
    digest = _hash(previous + body)
    body += digest
    return _HEAD.pack(len(body), crc32(body)) + body, digest


def unseal(frame: bytes, width: int) -> Record | str:
    """Return the record in one frame, or why there is none. The state vector is a read-only view of the frame."""
    size, whole = len(frame), frame_size(width)
    if size < whole:
        return f"{TORN}, {size} of {whole} bytes"
    length, checksum = _HEAD.unpack_from(frame)
    if length != whole - _HEAD.size:
        return f"damaged, length {length} instead of {whole - _HEAD.size}"
    if crc32(memoryview(frame)[_HEAD.size :]) != checksum:
        return "damaged, wrong checksum"
    vector = np.frombuffer(frame, dtype=np.float64, count=width, offset=_HEAD.size + _TICK.size)
    return Record(_TICK.unpack_from(frame, _HEAD.size)[0], vector, frame[-HASH_BYTES:])


class Scan:
    """One pass over a log: iterate for its whole records, then look at `breaks`.

    Raises RecordingError when it is made, for a header that cannot be read; never while iterating.
    """

    def __init__(self, read: Callable[[int], bytes], name: str) -> None:
        self.header, self._offset = read_header(read, name)
        self.breaks: list[Break] = []
        self._read = read

    def __iter__(self) -> Iterator[Record]:
        """Yield every whole record in file order; a damaged one is named in `breaks` and left out."""
        width, size = len(self.header.columns), frame_size(len(self.header.columns))
        first: int | None = None
        index = 0
        while frame := self._read(size):
            record = unseal(frame, width)
            if isinstance(record, str):
                self._note(len(frame), record)
            else:
                first = record.tick - index if first is None else first
                if record.tick == first + index:
                    yield record
                else:
                    self._note(size, f"tick {record.tick} where tick {first + index} belongs")
            self._offset += len(frame)
            index += 1

    def _note(self, size: int, reason: str) -> None:
        last = self.breaks[-1] if self.breaks else None
        if last is not None and last.offset + last.size_bytes == self._offset:
            self.breaks[-1] = Break(last.offset, last.size_bytes + size, last.reason)
        else:
            self.breaks.append(Break(self._offset, size, reason))
