"""Writes the packed form of a log: drive.parquet, which any program that reads Parquet opens.

One row a tick: `tick`, the stored columns of the state vector and, where the log has streams of messages, `messages`;
in row groups of at most BLOCK_TICKS, each of which is decoded by itself. The file's metadata hold, under METADATA_KEY
as JSON, what `Contents` says.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Final

import msgspec
import numpy as np
from numpy.typing import NDArray

from simconsole.recording.framing import START_OF_CHAIN, Record
from simconsole.recording.log_header import LogHeader
from simconsole.recording.packing import Plain, Rule, Rules, pack, stored
from simconsole.recording.reading import BLOCK_TICKS

METADATA_KEY: Final = b"simconsole.recording"
TICK: Final = "tick"
MESSAGES: Final = "messages"
SCHEMA: Final = 1
COMPRESSION_LEVEL: Final = 13
"""Of zstd; 16 makes the file 1.5 % smaller and takes twice the time, 9 the reverse."""


class Contents(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What drive.parquet says of itself besides its columns."""

    schema: int = SCHEMA
    start: bytes  # the first bytes of the log, up to its first tick; in base64
    rules: dict[str, Rule]  # of each column of the state vector, in its order
    digests: list[list[str]]  # after the last tick of each row group the chained hash of each stream, hexadecimal


class PackedLogWriter:
    """Writes a packed log. What it leaves is a whole file only once it is closed."""

    def __init__(self, path: Path, header: LogHeader, start: bytes, rules: Rules) -> None:
        """Create the file.

        Args:
            path: the file; replaced if it is there.
            header: what the log's streams mean.
            start: the log's first bytes, up to its first tick.
            rules: of all columns of the state vector.
        """
        import pyarrow as pa
        from pyarrow.parquet import ParquetWriter

        self._header, self._start, self._rules = header, start, rules
        self._digests = [[START_OF_CHAIN] * len(header.streams)]  # before the first tick and after each row group
        self._schema = _schema(header, rules)
        names = stored(rules)
        self._writer = ParquetWriter(
            path,
            self._schema,
            compression="zstd",
            compression_level=COMPRESSION_LEVEL,
            use_dictionary=False,
            column_encoding={TICK: "DELTA_BINARY_PACKED", **dict.fromkeys(names, "BYTE_STREAM_SPLIT")},
            write_statistics=False,
            write_page_checksum=True,
        )
        self._pa = pa

    def append(self, records: Sequence[Record]) -> None:
        """Write the next ticks, 1 to BLOCK_TICKS."""
        ticks = np.array([record.tick for record in records])
        columns = {TICK: ticks, **pack(self._rules, np.array([record.vector for record in records]))}
        digests = list(self._digests[-1])
        digests[0] = records[-1].digest
        arrays = [self._numbers(field.type, columns[field.name]) for field in self._schema if field.name != MESSAGES]
        if MESSAGES in self._schema.names:
            arrays.append(self._messages(records))
            for message in (message for record in records for message in record.messages):
                digests[message.stream] = message.digest
        self._writer.write_table(self._pa.table(arrays, schema=self._schema), row_group_size=BLOCK_TICKS)
        self._digests.append(digests)

    # Columns are put together as they lie in memory: `pa.array` imports pandas where there is one, in 0.3 s.

    def _numbers(self, kind: Any, values: Any) -> Any:
        numbers = values.astype(kind.to_pandas_dtype(), order="C", casting="safe", copy=False)
        return self._pa.Array.from_buffers(kind, len(numbers), [None, self._pa.py_buffer(numbers)])

    def _messages(self, records: Sequence[Record]) -> Any:
        """Return the messages of each tick."""
        kind = self._schema.field(MESSAGES).type
        names = [stream.name.encode() for stream in self._header.streams]
        messages = [message for record in records for message in record.messages]
        parts = [
            self._texts(kind.value_type.field("stream").type, [names[message.stream] for message in messages]),
            self._texts(kind.value_type.field("content").type, [message.content for message in messages]),
        ]
        each = self._pa.Array.from_buffers(kind.value_type, len(messages), [None], children=parts)
        starts = self._pa.py_buffer(_starts(len(record.messages) for record in records))
        return self._pa.Array.from_buffers(kind, len(records), [None, starts], children=[each])

    def _texts(self, kind: Any, texts: Sequence[bytes]) -> Any:
        parts = [None, self._pa.py_buffer(_starts(map(len, texts))), self._pa.py_buffer(b"".join(texts))]
        return self._pa.Array.from_buffers(kind, len(texts), parts)

    def close(self) -> None:
        """Write what the file says of itself, and close it."""
        digests = [[digest.hex() for digest in group] for group in self._digests[1:]]
        contents = Contents(start=self._start, rules=dict(self._rules), digests=digests)
        self._writer.add_key_value_metadata({METADATA_KEY: msgspec.json.encode(contents)})
        self._writer.close()

    def __enter__(self) -> "PackedLogWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _starts(lengths: Iterable[int]) -> NDArray[np.int32]:
    """Return where in a row things of these lengths begin, and where the last one ends."""
    return np.cumsum([0, *lengths], dtype=np.int32)


def _schema(header: LogHeader, rules: Rules) -> Any:
    """Return the columns of the file, each with its unit where it is plain."""
    import pyarrow as pa

    units = dict(zip(header.columns, header.streams[0].units, strict=True))
    fields = [pa.field(TICK, pa.int64(), nullable=False)]
    for name in stored(rules):
        if isinstance(rules[name], Plain):
            fields.append(pa.field(name, pa.float64(), nullable=False, metadata={"unit": units[name]}))
        else:
            fields.append(pa.field(name, pa.int64(), nullable=False))
    if len(header.streams) > 1:
        message = pa.struct(
            [pa.field("stream", pa.string(), nullable=False), pa.field("content", pa.binary(), nullable=False)]
        )
        fields.append(pa.field(MESSAGES, pa.list_(pa.field("message", message, nullable=False)), nullable=False))
    return pa.schema(fields)
