"""Compare two recordings: every field that differs, and where the messages of a stream do."""

from collections.abc import Iterator, Mapping
from itertools import zip_longest
from typing import NamedTuple, Protocol

from simconsole.recording.differences import Differences, FieldDifference, allowed_differences
from simconsole.recording.framing import Record
from simconsole.recording.log_header import LogHeader
from simconsole.recording.matching import RENAMED, matched, renamed


class Recorded(Protocol):
    """What a comparison needs of a `Recording`."""

    header: LogHeader

    def __iter__(self) -> Iterator[Record]:
        """Yield all whole records in the order of their ticks."""


class MessageDifference(NamedTuple):
    """A stream whose messages differ."""

    stream: str
    first_tick: int
    ticks: int  # in how many they differ
    first: tuple[str, ...]  # those of the first such tick
    second: tuple[str, ...]


class Comparison(NamedTuple):
    """What a comparison found."""

    equal: bool
    ticks: int  # compared
    differences: tuple[FieldDifference, ...] = ()
    messages: tuple[MessageDifference, ...] = ()
    only_first: tuple[str, ...] = ()  # columns
    only_second: tuple[str, ...] = ()
    reason: str = ""  # why not all ticks could be compared


def compare(
    first: Recorded,
    second: Recorded,
    tolerances: Mapping[str, float] | None = None,
    names: Mapping[str, str] = RENAMED,
) -> Comparison:
    """Compare two recordings tick by tick, by the names of their columns, in memory that does not grow with them.

    Args:
        first: the one recording.
        second: the other.
        tolerances: as of `allowed_differences`; without, all must be equal to the byte.
        names: earlier names of columns to those of now.

    Returns:
        The fields of both that differ, and the columns that only one has: these do not count as a difference.

    Raises:
        RecordingError: a pattern of the tolerances fits no column, or a recording has two columns of one name.
    """
    if first.header.tick_hz != second.header.tick_hz:
        rates = f"tick_hz {first.header.tick_hz} against {second.header.tick_hz}"
        return Comparison(False, 0, reason=f"the recordings cannot be compared: {rates}")
    match = matched(renamed(first.header, names), renamed(second.header, names))
    fields = Differences(match.columns, allowed_differences(match.columns, tolerances or {}))
    messages = _Messages(first.header, second.header)
    ticks, reason = 0, ""
    for left, right in zip_longest(first, second):
        if left is None or right is None or left.tick != right.tick:
            reason = f"only {ticks} ticks could be compared, then {_name(left)} against {_name(right)}"
            break
        fields.add(left.tick, match.of_first(left.vector), match.of_second(right.vector))
        if left.messages or right.messages:
            messages.add(left, right)
        ticks += 1
    found, texts = fields.found(), messages.found()
    return Comparison(
        equal=not (found or texts or reason),
        ticks=ticks,
        differences=found,
        messages=texts,
        only_first=match.only_first,
        only_second=match.only_second,
        reason=reason,
    )


class _Messages:
    """Compares the messages of each stream, by its name; a stream that one recording lacks is empty there."""

    def __init__(self, first: LogHeader, second: LogHeader) -> None:
        self._first = [stream.name for stream in first.streams]
        self._second = [stream.name for stream in second.streams]
        self._found: dict[str, MessageDifference] = {}

    def add(self, first: Record, second: Record) -> None:
        left, right = _by_stream(first, self._first), _by_stream(second, self._second)
        for name in sorted({*left, *right}):
            mine, other = left.get(name, ()), right.get(name, ())
            if mine != other:
                known = self._found.get(name) or MessageDifference(name, first.tick, 0, _texts(mine), _texts(other))
                self._found[name] = known._replace(ticks=known.ticks + 1)

    def found(self) -> tuple[MessageDifference, ...]:
        return tuple(self._found.values())


def _by_stream(record: Record, names: list[str]) -> dict[str, tuple[bytes, ...]]:
    found: dict[str, tuple[bytes, ...]] = {}
    for message in record.messages:
        name = names[message.stream]
        found[name] = (*found.get(name, ()), message.content)
    return found


def _texts(contents: tuple[bytes, ...]) -> tuple[str, ...]:
    return tuple(content.decode("utf-8", "replace") for content in contents)


def _name(record: Record | None) -> str:
    return "the end" if record is None else f"tick {record.tick}"
