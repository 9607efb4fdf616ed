"""The head of a log: what its streams are called, what their columns mean and which sources made them.

::

    magic (8)   length u32 | crc32 u32 | header JSON

A stream has a name and a hash chain of its own. The first one holds the state vector of each tick; the others hold
messages, for what has no fixed width. A log of schema 1 has one nameless stream of state vectors; it is read as a log
whose only stream is called "state".
"""

import sys
from collections.abc import Callable
from struct import Struct
from typing import Any, Final, Literal
from zlib import crc32

import msgspec

from simconsole.values.errors import RecordingError
from simconsole.values.units import unit_of

MAGIC: Final = b"\x89SIMLOG\n"  # a byte above 127 first: no text file starts so, and a 7-bit copy destroys it
SCHEMA: Final = 2
MAX_HEADER_BYTES: Final = 1 << 20
STATE: Final = "state"
"""The stream of the state vectors."""
ACTS: Final = "acts"
"""The stream of the operator's acts and notes, JSON."""
ROAD_USERS: Final = "road_users"
"""The stream of the road users, a table of float64."""
SIGNALS: Final = "signals"
"""The stream of the signals that another simulator runs, JSON: those that have changed."""
PLANS: Final = "plans"
"""The stream of what the autopilot plans."""
ADVICE: Final = "advice"
"""The stream of the speed advice that the driver was given, JSON: each when it is another."""
_HEAD: Final = Struct("<II")


class Stream(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One named stream of a log: vectors of one width, one a tick, or messages, any number a tick."""

    name: str
    kind: Literal["vectors", "messages"]
    columns: tuple[str, ...] = ()  # of vectors
    units: tuple[str, ...] = ()  # of the columns; "1" for shares, flags, counts and enumerations
    input_columns: int = 0  # number of leading columns that hold inputs from outside
    encoding: str = ""  # of messages, as "json"


class LogHeader(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What a reader must know before the first tick. Holds no wall time: equal drives make equal logs."""

    tick_hz: int
    streams: tuple[Stream, ...]
    console_version: str
    source_sha256: str  # of the sources that made the state vectors
    session_sha256: str  # of the resolved session profile
    schema: int = SCHEMA
    byte_order: str = sys.byteorder
    values: str = "float64"

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns of the state vectors."""
        return self.streams[0].columns

    @property
    def input_columns(self) -> int:
        """The number of leading columns of the state vectors that hold inputs from outside."""
        return self.streams[0].input_columns


def vector_stream(columns: tuple[str, ...], input_columns: int, name: str = STATE) -> Stream:
    """Return a stream of vectors with these columns, the first `input_columns` of which are inputs from outside."""
    units = tuple(unit_of(column) for column in columns)
    return Stream(name=name, kind="vectors", columns=columns, units=units, input_columns=input_columns)


def message_stream(name: str, encoding: str = "json") -> Stream:
    """Return a stream of messages."""
    return Stream(name=name, kind="messages", encoding=encoding)


def stream_index(header: LogHeader, name: str) -> int:
    """Return which stream of a log is called `name`.

    Raises:
        RecordingError: none is.
    """
    names = [stream.name for stream in header.streams]
    if name not in names:
        raise RecordingError(f"the recording has no stream {name!r}, only {', '.join(names)}")
    return names.index(name)


def encode_header(header: LogHeader) -> bytes:
    """Return the first bytes of a log: magic and header frame."""
    text = msgspec.json.encode(header)
    return MAGIC + _HEAD.pack(len(text), crc32(text)) + text


def read_header(read: Callable[[int], bytes], name: str) -> tuple[LogHeader, bytes]:
    """Read magic and header through `read(size)`; `name` is the file for messages.

    Returns:
        The header and the bytes it was read from, magic included.

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
    return decode_header(text, name), start + text


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
        header = _of_first_schema(raw) if schema == 1 else msgspec.convert(raw, LogHeader)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise RecordingError(f"{name}: header: {error}") from None
    if header.byte_order != sys.byteorder:
        raise RecordingError(f"{name}: byte_order: {header.byte_order!r} cannot be read here, only {sys.byteorder!r}")
    if header.values != "float64":
        raise RecordingError(f"{name}: values: {header.values!r} cannot be read, only 'float64'")
    if not 1 <= header.tick_hz <= 1000:
        raise RecordingError(f"{name}: tick_hz: {header.tick_hz} is outside 1 to 1000")
    if problem := _stream_problem(header.streams):
        raise RecordingError(f"{name}: {problem}")
    return header


class _FirstHeader(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The header of schema 1."""

    tick_hz: int
    columns: tuple[str, ...]
    input_columns: int
    console_version: str
    source_sha256: str
    session_sha256: str
    schema: int
    byte_order: str
    values: str


def _of_first_schema(raw: dict[str, Any]) -> LogHeader:
    first = msgspec.convert(raw, _FirstHeader)
    return LogHeader(
        tick_hz=first.tick_hz,
        streams=(vector_stream(first.columns, first.input_columns),),
        console_version=first.console_version,
        source_sha256=first.source_sha256,
        session_sha256=first.session_sha256,
        byte_order=first.byte_order,
        values=first.values,
    )


def _stream_problem(streams: tuple[Stream, ...]) -> str | None:
    kinds = [stream.kind for stream in streams]
    if kinds[:1] != ["vectors"] or "vectors" in kinds[1:]:
        return f"streams: of the kinds {kinds}, this simconsole reads one of vectors, then any number of messages"
    names = [stream.name for stream in streams]
    if len(set(names)) < len(names):
        return f"streams: name: {names}, each must be another"
    state = streams[0]
    if not 0 <= state.input_columns <= len(state.columns):
        return f"input_columns: {state.input_columns} is outside 0 to {len(state.columns)}"
    if len(state.units) != len(state.columns):
        return f"streams: units: {len(state.units)} for {len(state.columns)} columns"
    return None
