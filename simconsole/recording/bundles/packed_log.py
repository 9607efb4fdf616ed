"""Reads the packed form of a log, which gives the log back byte for byte; packed_writer says what it is."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from simconsole.recording.bundles.packed_writer import MESSAGES, METADATA_KEY, SCHEMA, TICK, Contents
from simconsole.recording.framing import START_OF_CHAIN, Message, Record, SealedMessage, chain, seal, seal_message
from simconsole.recording.log_header import read_header, stream_index
from simconsole.recording.packing import Plain, Stored, needed, problem, unpack
from simconsole.recording.reading import BLOCK_TICKS, Block, LogTable, gathered, places
from simconsole.recording.scan import Break
from simconsole.values.errors import RecordingError


class PackedLog:
    """A packed log. Each pass reads it anew, in constant memory, and only the columns that it needs.

    Attributes:
        header: what the state vectors mean.
        breaks: which row groups were not whole, as found by the latest complete pass over the records.
        last: the last whole record, as found by the latest complete pass; None in a log without.
    """

    def __init__(self, path: Path) -> None:
        """Read what the file says of itself.

        Raises:
            RecordingError: missing, not a packed log, damaged, newer schema or other byte order.
        """
        self.path = path
        self.breaks: tuple[Break, ...] = ()
        self.last: Record | None = None
        with _opened(path) as file:
            text, groups = (file.metadata.metadata or {}).get(METADATA_KEY), file.metadata.num_row_groups
        if text is None:
            raise RecordingError(f"{path}: not a packed log: its metadata lack {METADATA_KEY.decode()!r}")
        contents = _contents(text, path)
        self._start, self._rules = contents.start, contents.rules
        self.header, _ = read_header(BytesIO(self._start).read, str(path))
        with _told(path):
            self._digests = [[bytes.fromhex(digest) for digest in group] for group in contents.digests]
        widths = {len(group) for group in self._digests} | {len(self.header.streams)}
        if tuple(self._rules) != self.header.columns or len(self._digests) != groups or len(widths) > 1:
            raise RecordingError(f"{path}: damaged: its columns, streams or row groups are not those that it states")

    def __iter__(self) -> Iterator[Record]:
        """Yield all records; row groups that are not whole are named in `breaks` and left out."""
        breaks, record = list[Break](), None
        digests = [START_OF_CHAIN] * len(self.header.streams)
        with _opened(self.path) as file:
            for index, stated in enumerate(self._digests):
                try:
                    records = self._records(file, index, digests)
                    reason = "" if digests == stated else "it does not give its hashes"
                except RecordingError as error:
                    records, reason = [], str(error)
                if reason:
                    breaks.append(_break(file, index, reason))
                    digests = list(stated)
                else:
                    yield from records
                    record = records[-1]
        self.breaks, self.last = tuple(breaks), record

    def messages(self, stream: str) -> Iterator[Message]:
        """Yield the messages of one stream in the order in which they arrived.

        Raises:
            RecordingError: no such stream in this recording, or damage.
        """
        wanted = stream_index(self.header, stream)
        with _opened(self.path) as file:
            for index in range(len(self._digests)):
                ticks = self._block(file, index, ()).ticks
                for row, messages in self._messages(file, index).items():
                    yield from (Message(int(ticks[row]), content) for at, content in messages if at == wanted)

    def blocks(self, columns: Sequence[str] | None = None) -> Iterator[Block]:
        """Yield the ticks in blocks of at most BLOCK_TICKS, with only these columns (None: all).

        Raises:
            RecordingError: no such column in this recording, or damage in one of them.
        """
        places(self.header, columns)
        names = self.header.columns if columns is None else tuple(columns)
        with _opened(self.path) as file:
            for index in range(len(self._digests)):
                yield self._block(file, index, names)

    def table(self, columns: Sequence[str] | None = None) -> LogTable:
        """Return all ticks as arrays, with only these columns (None: all).

        Raises:
            RecordingError: no such column in this recording, or damage in one of them.
        """
        return gathered(self.header, columns, self.blocks(columns))

    def log_bytes(self) -> Iterator[bytes]:
        """Yield the bytes of the log that this file stands for, in order.

        Raises:
            RecordingError: damage.
        """
        yield self._start
        digests = [START_OF_CHAIN] * len(self.header.streams)
        with _opened(self.path) as file:
            for index in range(len(self._digests)):
                frames = []
                block, messages = self._block(file, index, self.header.columns), self._messages(file, index)
                for row, (tick, vector) in enumerate(zip(block.ticks.tolist(), block.vectors, strict=True)):
                    parts = []
                    for stream, content in messages.get(row, ()):
                        part, digests[stream] = seal_message(digests[stream], tick, stream, content)
                        parts.append(part)
                    frame, digests[0] = seal(digests[0], tick, vector.tobytes(), b"".join(parts))
                    frames.append(frame)
                yield b"".join(frames)

    def _records(self, file: Any, index: int, digests: list[bytes]) -> list[Record]:
        """Return the records of a row group; `digests` are those of all streams before it, and then after it."""
        block, messages = self._block(file, index, self.header.columns), self._messages(file, index)
        block.vectors.flags.writeable = False
        records = []
        for row, (tick, vector) in enumerate(zip(block.ticks.tolist(), block.vectors, strict=True)):
            digests[0] = chain(digests[0], tick, vector.tobytes())
            sealed = []
            for stream, content in messages.get(row, ()):
                digests[stream] = chain(digests[stream], tick, content)
                sealed.append(SealedMessage(stream, content, digests[stream]))
            records.append(Record(tick, vector, digests[0], tuple(sealed)))
        return records

    def _block(self, file: Any, index: int, columns: Sequence[str]) -> Block:
        """Return some columns of a row group; not by `to_numpy`, which imports pandas where there is one: 0.3 s."""
        wanted = needed(self._rules, columns)
        with _told(self.path):
            table = file.read_row_group(index, columns=[TICK, *wanted], use_threads=False)
            found: dict[str, NDArray[Any]] = {
                name: np.from_dlpack(table.column(name).combine_chunks()) for name in (TICK, *wanted)
            }
        for name, values in found.items():
            plain = name != TICK and isinstance(self._rules[name], Plain)
            if values.dtype != (np.float64 if plain else np.int64):
                raise RecordingError(f"{self.path}: {name}: of type {values.dtype}, not as its rule says")
        ticks = found.pop(TICK)
        if not 1 <= len(ticks) <= BLOCK_TICKS:
            raise RecordingError(f"{self.path}: row group {index}: {len(ticks)} ticks, allowed 1 to {BLOCK_TICKS}")
        kept: dict[str, Stored] = found
        return Block(ticks, unpack(self._rules, kept, columns, len(ticks)))

    def _messages(self, file: Any, index: int) -> dict[int, list[tuple[int, bytes]]]:
        """Return the messages of a row group by row: the place of each one's stream, and its content."""
        if len(self.header.streams) == 1:
            return {}
        with _told(self.path):
            column = file.read_row_group(index, columns=[MESSAGES], use_threads=False).column(MESSAGES)
            lists = column.combine_chunks()
            offsets, parts = np.from_dlpack(lists.offsets), lists.values.to_pylist()
            found: dict[int, list[tuple[int, bytes]]] = {}
            for row in np.flatnonzero(np.diff(offsets)).tolist():
                for part in parts[offsets[row] : offsets[row + 1]]:
                    at = stream_index(self.header, part["stream"])
                    found.setdefault(row, []).append((at, part["content"]))
        return found


def _contents(text: bytes, path: Path) -> Contents:
    try:
        raw = msgspec.json.decode(text, type=dict[str, Any])
        if raw.get("schema") != SCHEMA:
            raise RecordingError(
                f"{path}: schema: {raw.get('schema')!r} cannot be read, this simconsole reads {SCHEMA}"
            )
        contents = msgspec.convert(raw, Contents)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise RecordingError(f"{path}: {METADATA_KEY.decode()}: {error}") from None
    unfit = problem(contents.rules)
    if unfit is not None:
        raise RecordingError(f"{path}: rules: {unfit}")
    return contents


def _break(file: Any, index: int, reason: str) -> Break:
    group = file.metadata.row_group(index)
    chunks = [group.column(column) for column in range(group.num_columns)]
    sizes = sum(chunk.total_compressed_size for chunk in chunks)
    return Break(min(chunk.data_page_offset for chunk in chunks), sizes, f"row group {index}: {reason}")


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    from pyarrow.parquet import ParquetFile

    with ExitStack() as stack:
        with _told(path):
            source = stack.enter_context(path.open("rb"))
            file = stack.enter_context(ParquetFile(source, page_checksum_verification=True, pre_buffer=False))
        yield file


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """Turn what pyarrow raises over a damaged file into one line. It has many kinds; none of them is a bug of ours."""
    from pyarrow import ArrowException

    try:
        yield
    except (ArrowException, OSError, ValueError, KeyError) as error:
        line = " ".join(str(getattr(error, "strerror", None) or error).split())
        raise RecordingError(f"{path}: cannot be read: {line}") from None
