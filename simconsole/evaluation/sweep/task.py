"""One drive of a sweep: what a worker is told and what it gives back. What drives it is `driving.py`."""

from typing import Final, Literal

import msgspec

from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.sweep import Value
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError, one_line

Outcome = Literal["driven", "passed", "failed", "refused", "crashed", "timed out"]
"""driven: a session to its end; passed, failed: a scenario's bounds or limits; refused: it cannot be driven, `detail`
says why; crashed, timed out: twice, so that the drive is lost."""

GOOD: Final = ("driven", "passed")
RECEIVED: Final = b"\n"
"""Tells a worker that its result has come."""
FORK: Final = b"fork\n"
"""Asks a worker for a copy of itself."""


class Task(msgspec.Struct, frozen=True, kw_only=True):
    """One drive of a sweep, with every profile in full.

    Attributes:
        index: its place in the plan, from 0.
        source: the name of its session or scenario.
        values: what was changed, by dotted key.
        resolved: its session with these values.
        scenario: in the place of a session, a scenario, of which `resolved` is the session.
        timeout_s: after which it is given up.
    """

    index: int
    source: str
    values: dict[str, Value]
    resolved: ResolvedSession
    scenario: ScenarioProfile | None
    timeout_s: float


class TaskResult(msgspec.Struct, frozen=True, kw_only=True):
    """What came of a task.

    Attributes:
        index: that of the task.
        outcome: how it ended.
        detail: why, where it did not end well.
        ticks: that were driven.
        digest: chained hash of its state vectors.
        metrics: numbers by dotted name, the unit in each.
    """

    index: int
    outcome: Outcome
    detail: str = ""
    ticks: int = 0
    digest: str = ""
    metrics: dict[str, float] = msgspec.field(default_factory=dict)


def to_bytes(task: Task) -> bytes:
    """Return a task as one line of JSON."""
    return msgspec.json.encode(task)


def from_bytes(line: bytes) -> Task:
    """Return the task of such a line.

    Raises:
        ProfileError: it is none.
    """
    try:
        return msgspec.json.decode(line, type=Task)
    except msgspec.MsgspecError as error:
        raise ProfileError(f"task: {one_line(error)}") from error
