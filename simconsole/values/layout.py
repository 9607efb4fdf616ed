"""Where records lie in a vector of floats: offsets and widths that follow from the records' fields.

A record is a `typing.NamedTuple` of floats, or of such records. Kernels use `read` and `write` too; there the part is a
module constant, or a field of one.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, Generic, TypeVar, get_args, get_type_hints

from simconsole.values.kernels import Row

R = TypeVar("R", bound=tuple[Any, ...])
L = TypeVar("L", bound=tuple[Any, ...])


class Part(Generic[R]):
    """The place of one record in a vector: the floats from `start` up to `stop`."""

    __slots__ = ("inner", "names", "record", "start", "stop", "width")

    def __init__(self, record: type[R], start: int = 0) -> None:
        hints = get_type_hints(record)
        self.record: Callable[..., R] = record
        self.start = start
        self.inner = () if set(hints.values()) <= {float} else in_order(hints.values(), start)
        self.names = tuple(hints)
        if self.inner:
            self.names = tuple(
                f"{outer}.{name}" for outer, part in zip(hints, self.inner, strict=True) for name in part.names
            )
        self.width = len(self.names)
        self.stop = start + self.width

    @property
    def slice(self) -> slice:
        """The columns of the record."""
        return slice(self.start, self.stop)

    def at(self, name: str) -> int:
        """Return the column of a field; that of an inner record is `outer.inner`.

        Raises:
            ValueError: the record has no such field.
        """
        return self.start + self.names.index(name)


def in_order(records: Iterable[type[Any]], start: int = 0) -> tuple[Part[Any], ...]:
    """Return the parts of records that lie one behind the other."""
    parts: list[Part[Any]] = []
    for record in records:
        parts.append(Part(record, parts[-1].stop if parts else start))
    return tuple(parts)


def lay_out(layout: type[L]) -> L:
    """Return parts one behind the other: a NamedTuple whose fields have the type `Part[Record]`."""
    build: Callable[..., L] = layout
    return build(*in_order(get_args(part)[0] for part in get_type_hints(layout).values()))


def read(row: Row, part: Part[R]) -> R:
    """Return the record that lies at `part` of a vector."""
    values = row[part.start : part.stop].tolist()
    return _built(part, values, part.start) if part.inner else part.record(*values)


def _built(part: Part[Any], values: list[float], start: int) -> Any:
    """Return the record of a part; the first of `values` is that of the column `start`."""
    if part.inner:
        return part.record(*[_built(inner, values, start) for inner in part.inner])
    return part.record(*values[part.start - start : part.stop - start])


def write(row: Row, part: Part[R], record: R) -> None:
    """Write a record to its place in a vector."""
    row[part.start : part.stop] = tuple(_floats(record)) if part.inner else record


def _floats(record: tuple[Any, ...]) -> Iterator[float]:
    for value in record:
        if isinstance(value, tuple):
            yield from _floats(value)
        else:
            yield value
