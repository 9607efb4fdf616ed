"""The trace format: raw device samples as readable lines, one per tick. Pure; sources/trace_files.py opens the files.

::

    # simconsole trace schema 1 tick_hz 250 cockpit t500rs_th8rs
    tick,wheel_axis,throttle_axis,...
    1,0.0,1.0,...

Every tick has a line: time that goes back, repeats or jumps is refused, naming the line. Floats are written with
`repr`, so that reading gives the same bits.
"""

import re
from collections.abc import Callable, Iterable, Iterator
from typing import Final, NamedTuple

from simconsole.devices.calibration.validity import axis_good, mask_good
from simconsole.values.errors import ProfileError
from simconsole.values.kernels import is_finite
from simconsole.values.signals import NO_SAMPLE, DeviceSample

SCHEMA: Final = 1
COLUMNS: Final = ("tick", *DeviceSample._fields)
MAX_LINE: Final = 1000
"""Longest line that is read: a file without line ends must not be read into memory."""

_HEADER: Final = re.compile(r"# simconsole trace schema (\d{1,9}) tick_hz (\d{1,9}) cockpit (\S{1,255})")


class TraceHeader(NamedTuple):
    """What a trace says about itself."""

    tick_hz: int
    cockpit: str


def header_text(header: TraceHeader) -> str:
    """Return the first two lines of a trace. Blanks in the cockpit's name become underscores."""
    cockpit = "_".join(header.cockpit.split()) or "unnamed"
    return f"# simconsole trace schema {SCHEMA} tick_hz {header.tick_hz} cockpit {cockpit}\n{','.join(COLUMNS)}\n"


def row_text(tick: int, sample: DeviceSample) -> str:
    """Return the line of one tick."""
    return f"{tick},{','.join(map(repr, sample))}\n"


def read_header(lines: Iterator[str], name: str) -> TraceHeader:
    """Take the first two lines and return what they say.

    Raises:
        ProfileError: not a trace of this schema, or other columns; names file and line.
    """
    first = next(lines, "").rstrip("\r\n")
    found = _HEADER.fullmatch(first)
    if found is None:
        raise ProfileError(f"{name}: line 1: value {first[:60]!r}: `# simconsole trace schema {SCHEMA} ...`")
    if int(found[1]) != SCHEMA:
        raise ProfileError(f"{name}: line 1: schema: value {found[1]}: {SCHEMA}, what this version reads")
    columns = tuple(next(lines, "").rstrip("\r\n").split(","))
    if columns != COLUMNS:
        missing = [column for column in COLUMNS if column not in columns]
        detail = f"{missing[0]} missing" if missing else "other columns or another order"
        raise ProfileError(f"{name}: line 2: columns: value {detail}: {','.join(COLUMNS)}")
    return TraceHeader(int(found[2]), found[3])


def read_rows(lines: Iterable[str], name: str) -> Iterator[tuple[int, DeviceSample]]:
    """Yield (tick, sample) of the lines after the header, one at a time, in constant memory.

    Raises:
        ProfileError: a line that is not a sample, or time that does not go on by one tick; names file and line.
    """
    last: int | None = None
    for number, line in enumerate(lines, start=3):
        tick, sample = _row(line, name, number)
        if last is not None and tick != last + 1:
            what = "time goes back" if tick <= last else "ticks are missing"
            raise ProfileError(f"{name}: line {number}: tick: value {tick}: {last + 1} ({what})")
        last = tick
        yield tick, sample


def _row(line: str, name: str, number: int) -> tuple[int, DeviceSample]:
    cells = line.rstrip("\r\n").split(",")
    if len(cells) != len(COLUMNS):
        raise ProfileError(f"{name}: line {number}: value {len(cells)} cells: {len(COLUMNS)} cells")
    try:
        tick = int(cells[0])
        sample = DeviceSample(*map(float, cells[1:]))
    except ValueError:
        raise ProfileError(f"{name}: line {number}: value {line.strip()[:60]!r}: numbers only") from None
    wrong = _first_wrong(sample)
    if wrong:
        field, allowed = wrong
        raise ProfileError(f"{name}: line {number}: {field}: value {getattr(sample, field)}: {allowed}")
    return tick, sample


def _first_wrong(sample: DeviceSample) -> tuple[str, str] | None:
    values: tuple[float, ...] = sample
    for index, value in enumerate(values):
        good, allowed = _RULES[index]
        if not good(value):
            return DeviceSample._fields[index], allowed
    return None


def _hat_good(value: float) -> bool:
    return value in (-1.0, 0.0, 1.0)


def _flag_good(value: float) -> bool:
    return value in (0.0, 1.0)


def _age_good(value: float) -> bool:
    return is_finite(value) and value >= 0.0


_RULES: Final[tuple[tuple[Callable[[float], bool], str], ...]] = (
    *((axis_good, "a number from -1 to 1"),) * 5,
    *((mask_good, "a whole number below 2**24"),) * 2,
    *((_hat_good, "-1, 0 or 1"),) * 2,
    *((_age_good, "a number of ticks, 0 or more"),) * 4,
    (_flag_good, "0 or 1"),
)


def aged(sample: DeviceSample, ticks: float) -> DeviceSample:
    """Return the sample as it looks when nothing new came for `ticks` ticks."""
    return sample._replace(
        wheel_age_ticks=sample.wheel_age_ticks + ticks,
        pedals_age_ticks=sample.pedals_age_ticks + ticks,
        shifter_age_ticks=sample.shifter_age_ticks + ticks,
        handbrake_age_ticks=sample.handbrake_age_ticks + ticks,
    )


class TracePlayer:
    """Plays samples: the first poll gives the first one. After the last the devices are silent: their ages grow."""

    def __init__(self, rows: Iterator[tuple[int, DeviceSample]]) -> None:
        self._rows = rows
        self._offset: int | None = None
        self._tick = 0
        self._sample = NO_SAMPLE

    def poll(self, tick: int) -> DeviceSample:
        """Return the sample of this tick.

        Raises:
            ProfileError: the trace's next line cannot be used.
        """
        while self._offset is None or self._tick + self._offset < tick:
            row = next(self._rows, None)
            if row is None:
                break
            self._tick, self._sample = row
            if self._offset is None:
                self._offset = tick - self._tick
        behind = 0 if self._offset is None else tick - self._tick - self._offset
        return aged(self._sample, float(behind)) if behind > 0 else self._sample
