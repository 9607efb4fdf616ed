"""Goldens: what a scripted drive gave when it was accepted, thinned to a readable table. Pure but for numpy.

A golden is CSV text: one line per sample, every column of a row, `repr` of each float (exact), and the chained hash
of the whole drive in the header. Equal hash means every bit of every tick is equal; otherwise the table says where.
"""

import csv
import io
from typing import Final, NamedTuple

from simconsole.errors import ProfileError
from simconsole.kernels import Row

SCHEMA: Final = 1


class Golden(NamedTuple):
    """An accepted drive."""

    hash: str
    tick_hz: int
    columns: tuple[str, ...]
    samples: tuple[tuple[int, tuple[float, ...]], ...]  # (tick, row)


class Difference(NamedTuple):
    """The first sample that differs from its golden."""

    tick: int
    column: str
    accepted: float
    driven: float


def write(golden: Golden) -> str:
    """Return the golden as text."""
    out = io.StringIO()
    out.write(f"# simconsole golden schema {SCHEMA} tick_hz {golden.tick_hz} hash {golden.hash}\n")
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(("tick", *golden.columns))
    for tick, row in golden.samples:
        writer.writerow((tick, *(repr(value) for value in row)))
    return out.getvalue()


def read(text: str, name: str) -> Golden:
    """Return the golden in `text`.

    Raises:
        ProfileError: the text is not a golden of this schema; the message names `name` and the line.
    """
    lines = text.splitlines()
    head = lines[0].split() if lines else []
    if len(head) != 9 or head[:4] != ["#", "simconsole", "golden", "schema"] or head[4] != str(SCHEMA):
        raise ProfileError(f"{name}: line 1: not a golden of schema {SCHEMA}")
    rows = list(csv.reader(lines[1:]))
    samples = []
    for number, row in enumerate(rows[1:], start=3):
        try:
            samples.append((int(row[0]), tuple(float(value) for value in row[1:])))
        except ValueError:
            raise ProfileError(f"{name}: line {number}: a value is not a number") from None
    return Golden(head[8], int(head[6]), tuple(rows[0][1:]), tuple(samples))


def first_difference(accepted: Golden, driven: Golden) -> Difference | None:
    """Return where `driven` first leaves `accepted`, comparing bits of the columns both have; None when nowhere."""
    shared = [name for name in accepted.columns if name in driven.columns]
    ours = dict(driven.samples)
    for tick, row in accepted.samples:
        values = dict(zip(accepted.columns, row, strict=True))
        if tick not in ours:
            return Difference(tick, "tick", float(tick), float(len(ours)))
        now = dict(zip(driven.columns, ours[tick], strict=True))
        for name in shared:
            if values[name] != now[name] and not (values[name] != values[name] and now[name] != now[name]):
                return Difference(tick, name, values[name], now[name])
    return None


def sample(rows: Row, tick_hz: int, rate_hz: int, columns: tuple[str, ...], digest: str) -> Golden:
    """Thin a drive (`rows`, shape (ticks, columns), first row = tick 1) to `rate_hz`."""
    step = max(1, tick_hz // rate_hz)
    ticks = range(step, len(rows) + 1, step)
    return Golden(digest, tick_hz, columns, tuple((tick, tuple(rows[tick - 1].tolist())) for tick in ticks))
