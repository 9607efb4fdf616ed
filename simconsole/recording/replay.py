"""Replay: make every tick again from its recorded inputs, and say where the result differs from what was recorded."""

from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from simconsole.recording.chains import Chains
from simconsole.recording.differences import Differences, FieldDifference, allowed_differences
from simconsole.recording.framing import START_OF_CHAIN, Record, chain
from simconsole.recording.log_header import LogHeader
from simconsole.recording.matching import RENAMED, matched, renamed
from simconsole.values.errors import RecordingError
from simconsole.values.kernels import Row

AdvanceVector = Callable[[int, Row, Row], Row]
"""`advance(tick, previous, inputs)` makes the state vector of `tick` from the one before it and recorded inputs."""


class Remade(NamedTuple):
    """What a replay makes its ticks with."""

    columns: tuple[str, ...]  # of the state vectors that `advance` makes
    no_inputs: Row  # the inputs from outside, where nothing comes: for those that were not recorded
    initial: Row  # the state vector before the first recorded tick
    advance: AdvanceVector
    others: int = 0  # of the inputs the last columns, which tell of other platforms; the rest are the leading ones


class ReplayResult(NamedTuple):
    """What a replay found.

    `equal` if no field that both have differs by more than its tolerance; `hashes_equal` if every tick gave the same
    bytes and the same hash.
    """

    equal: bool
    hashes_equal: bool
    ticks: int  # made again
    digest: bytes  # chained hash of the replayed state vectors
    differences: tuple[FieldDifference, ...] = ()  # recorded against replayed
    new: tuple[str, ...] = ()  # columns that were not recorded; inputs among them have their default
    missing: tuple[str, ...] = ()  # recorded columns that this version does not have
    problems: tuple[str, ...] = ()  # why equal ticks are not a whole drive: a recording that failed, a damaged log
    remarks: tuple[str, ...] = ()  # worth knowing, but no problem: a torn last tick, other sources

    @property
    def good(self) -> bool:
        """Whether this is a success: the recording is complete, and every tick is equal."""
        return self.equal and not self.problems


def replay(
    records: Iterable[Record],
    header: LogHeader,
    remade: Remade,
    *,
    tolerances: Mapping[str, float] | None = None,
    names: Mapping[str, str] = RENAMED,
    first_tick: int | None = None,
    recorded_ticks: int | None = None,
) -> ReplayResult:
    """Make every state vector of `records` again from its recorded inputs, and compare the columns that both have.

    Inputs are found by the names of their columns. It goes on to the end, whatever differs, in memory that does not
    grow with the drive.

    Args:
        records: the recorded ticks, in order and without gaps (a `Recording`).
        header: of the recording.
        remade: this version's columns, defaults, initial state and step.
        tolerances: as of `allowed_differences`; without, all must be equal to the byte.
        names: earlier names of columns to those of now.
        first_tick: the tick after the initial state, where the caller knows it.
        recorded_ticks: how many ticks were recorded, where the drive was finished and said so.

    Raises:
        RecordingError: its ticks have a gap, or some are gone at the end; a pattern of the tolerances fits no column.
    """
    match = matched(renamed(header, names), remade.columns)
    inputs_of = _InputMap(renamed(header, names), remade)
    differences = Differences(match.columns, allowed_differences(match.columns, tolerances or {}))
    chains, digest = Chains(header), START_OF_CHAIN
    vector, ticks, expected = remade.initial, 0, first_tick
    for record in records:
        if expected is not None and record.tick != expected:
            raise RecordingError(f"the recording cannot be replayed from tick {expected} on: it is missing")
        vector = remade.advance(record.tick, vector, inputs_of(record.vector))
        digest = chain(digest, record.tick, vector.tobytes())
        chains.follow(record)
        differences.add(record.tick, match.of_first(record.vector), match.of_second(vector))
        ticks, expected = ticks + 1, record.tick + 1
    if recorded_ticks is not None and ticks != recorded_ticks:
        raise RecordingError(f"the recording is not whole: {ticks} of {recorded_ticks} ticks could be replayed")
    found = differences.found()
    return ReplayResult(
        equal=not found,
        hashes_equal=digest == chains.digest and not chains.broken,
        ticks=ticks,
        digest=digest,
        differences=found,
        new=match.only_second,
        missing=match.only_first,
        problems=tuple(chains.problems()),
    )


class _InputMap:
    """Takes this version's inputs out of a recorded state vector; one that was not recorded has its default."""

    def __init__(self, recorded: tuple[str, ...], remade: Remade) -> None:
        places = {column: at for at, column in enumerate(recorded)}
        leading, end = len(remade.no_inputs) - remade.others, len(remade.columns)
        wanted = remade.columns[:leading] + remade.columns[end - remade.others :]
        known = [(at, places[column]) for at, column in enumerate(wanted) if column in places]
        self._to = [at for at, _ in known]
        self._from = [at for _, at in known]
        self._no_inputs = remade.no_inputs
        self._same = not remade.others and self._to == self._from == list(range(len(wanted)))

    def __call__(self, vector: Row) -> Row:
        if self._same:
            return vector[: len(self._no_inputs)].copy()  # to numba a read-only view is another type
        inputs = self._no_inputs.copy()
        inputs[self._to] = vector[self._from]
        return inputs
