"""Drive one scenario headless and judge it: bounds on columns, its golden, the limits of its manoeuvre.

Worker of `simconsole check`.
"""

import math
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple, TypeVar

from simconsole.evaluation.checks import golden
from simconsole.evaluation.checks.manoeuvre_check import drive, judge_limit
from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.evaluation.checks.sampled import Accepting, Comparing
from simconsole.evaluation.checks.whole_drive import judge_metrics, judge_modes, numbers_of
from simconsole.evaluation.manoeuvres.attempt import Result
from simconsole.evaluation.metrics.table import drive_of
from simconsole.profiles.manoeuvre import Limit, Manoeuvre
from simconsole.profiles.scenario import Check, ScenarioProfile
from simconsole.recording.framing import START_OF_CHAIN, chain
from simconsole.session.resolution import load_scenario, resolve
from simconsole.session.scripted.opening import as_driven, open_scenario
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.tick.loop import Recorder, run
from simconsole.values.errors import ProfileError
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import Row
from simconsole.values.state_vector import Snapshot

R = TypeVar("R", bound=Recorder)


class Verdict(NamedTuple):
    """The result of one scenario."""

    scenario: str
    passed: bool
    ticks: int
    digest: str
    problems: list[str]
    title: str = ""
    result: Result | None = None  # of a manoeuvre
    limits: tuple[Limit, ...] = ()
    exact: bool = True
    """Whether it is its golden to the bit; false where it is within tolerances, or differs."""


def check_scenario(name_or_path: str, update_golden: bool = False) -> Verdict:
    """Drive a scenario and compare; with `update_golden`, what was driven becomes the golden (bounds still count).

    A manoeuvre is judged by its characteristic values: it has no golden.

    Raises:
        ProfileError: scenario or golden cannot be read, or a bound names a column or value that there is not.
    """
    scenario, path = load_scenario(name_or_path)
    if scenario.manoeuvre is not None:
        return _check_manoeuvre(scenario, scenario.manoeuvre, path)
    accepted = path.parent / "golden" / f"{path.stem}.csv"
    resolved = resolve(scenario.session)
    with ExitStack() as stack:

        def watched(console: Console) -> Watch:
            sampled = (Accepting if update_golden else Comparing)(
                accepted, console.tick_hz, console.columns, scenario.tolerances
            )
            stack.enter_context(sampled)
            bounds = [Bound(check, console.columns, console.tick_hz, str(path)) for check in scenario.checks]
            watch = Watch(bounds, sampled, golden.step_ticks(console.tick_hz, scenario.golden_hz), console.columns)
            watch.keep_modes(bool(scenario.modes))
            if scenario.metrics:
                watch.kept = MemoryRecorder(round(scenario.duration_s * console.tick_hz), console.width)
            return watch

        refused: list[str] = []
        watch = drive_scenario(scenario, watched, resolved, refused.append)
        digest = watch.digest.hex()
        judged = [bound.problem(watch.ticks) for bound in watch.bounds]
        problems = refused + [problem for problem in judged if problem is not None]
        problems += judge_modes(scenario.modes, watch.modes)
        if watch.kept is not None:
            drive_kept = drive_of(watch.kept.vectors, watch.columns, resolved.session.mode.tick_hz)
            problems += judge_metrics(scenario.metrics, dict(numbers_of(drive_kept, resolved)))
        problems += watch.samples.end(digest)
        exact = watch.samples.exact
    return Verdict(
        scenario=path.stem,
        passed=not problems,
        ticks=watch.ticks,
        digest=digest,
        problems=problems,
        title=scenario.title,
        exact=exact,
    )


def _check_manoeuvre(scenario: ScenarioProfile, manoeuvre: Manoeuvre, path: Path) -> Verdict:
    driven = drive(scenario, manoeuvre)
    problems = [driven.result.problem] if driven.result.problem is not None else []
    if not problems:
        judged = [judge_limit(limit, driven.result.values, str(path)) for limit in scenario.limits]
        problems = [problem for problem in judged if problem is not None]
    return Verdict(
        scenario=path.stem,
        passed=not problems,
        ticks=driven.ticks,
        digest=driven.digest,
        problems=problems,
        title=scenario.title,
        result=driven.result,
        limits=scenario.limits,
    )


def drive_scenario(
    scenario: ScenarioProfile,
    recorder_of: Callable[[Console], R],
    resolved: ResolvedSession | None = None,
    told: Callable[[str], object] = lambda problem: None,
) -> R:
    """Drive a scenario without a bundle into the recorder that `recorder_of` makes, and return that.

    `resolved` takes the place of the scenario's own session: the same with other values. `told` hears what the console
    refused of the scenario's own messages, and that simulated time stood for ever.

    Raises:
        SimConsoleError: the session cannot be opened, or the scenario's inputs do not fit together.
    """
    resolved = as_driven(scenario, resolve(scenario.session) if resolved is None else resolved)
    console, state = assemble(resolved, compiled)
    recorder = recorder_of(console)
    with ExitStack() as stack:
        opened = open_scenario(scenario, resolved, console, recorder, stack)
        ticks, asked = round(scenario.duration_s * console.tick_hz), resolved.session.mode.start == "on_request"
        run(console, state, opened.components, ticks, opened.finished, on_request=asked)
        problem = opened.problem()
    if problem is not None:
        told(problem)
    return recorder


class Watch:
    """The recorder of a check: looks at every tick as it is driven and keeps none, so that a drive may be long.

    Attributes:
        bounds: checked at every tick.
        samples: writes the golden, or compares with it.
        columns: of a state vector.
        ticks: seen so far.
        digest: chained hash of them.
        modes: that the drive has had, each with the tick at which it began, as far as they are asked for.
        kept: the whole drive, where its metrics are asked for.
    """

    def __init__(
        self, bounds: "Sequence[Bound]", samples: Accepting | Comparing, step_ticks: int, columns: tuple[str, ...]
    ) -> None:
        self.bounds, self.samples, self.columns = bounds, samples, columns
        self.modes: list[tuple[int, int]] = []
        self.kept: MemoryRecorder | None = None
        self._mode_at: int | None = None
        self._step_ticks = step_ticks
        self.ticks = 0
        self.digest = START_OF_CHAIN

    def keep_modes(self, wanted: bool) -> None:
        """Note every change of mode, or none."""
        self._mode_at = self.columns.index("arbitration.mode") if wanted else None

    def write(self, snapshot: Snapshot) -> int:
        """Look at one tick."""
        self.ticks += 1
        if self._mode_at is not None:
            mode = int(snapshot.vector[self._mode_at])
            if not self.modes or self.modes[-1][1] != mode:
                self.modes.append((snapshot.tick, mode))
        if self.kept is not None:
            self.kept.write(snapshot)
        self.digest = chain(self.digest, snapshot.tick, snapshot.vector.tobytes())
        for bound in self.bounds:
            bound.see(snapshot.tick, snapshot.vector)
        if snapshot.tick % self._step_ticks == 0:
            self.samples.see(snapshot.tick, snapshot.vector)
        return 0

    def write_block(self, tick: int, vectors: Row) -> tuple[int, int]:
        """Look at the ticks from `tick` on, all of them."""
        for number, vector in enumerate(vectors, start=tick):
            self.write(Snapshot(number, 0, vector))
        return len(vectors), 0


class Bound:
    """One bound on a column, over some of a drive's ticks."""

    def __init__(self, check: Check, columns: tuple[str, ...], tick_hz: int, origin: str) -> None:
        """`origin` (the scenario's file) opens an error.

        Raises:
            ProfileError: the bound names a column that no state vector has.
        """
        if check.column not in columns:
            raise ProfileError(
                f"{origin}: checks: column: value {check.column}: a column of the state vector, as in its golden"
            )
        self._column, self._at = check.column, columns.index(check.column)
        self._low = -math.inf if check.min is None else check.min
        self._high = math.inf if check.max is None else check.max
        self._first, self._last = _ticks(check, tick_hz)
        self._found: str | None = None

    def see(self, tick: int, vector: Row) -> None:
        """Check one tick; the first that breaks the bound is kept."""
        if self._found is None and self._first <= tick and (self._last is None or tick <= self._last):
            value = float(vector[self._at])
            if not self._low <= value <= self._high:  # so that NaN always fails
                self._found = f"tick {tick}: {self._column}: {value!r} not in {self._low} to {self._high}"

    def problem(self, ticks: int) -> str | None:
        """Return what is wrong after a drive of so many ticks, None if the bound holds."""
        last = ticks if self._last is None else self._last
        if self._first > min(last, ticks):
            return f"{self._column}: no tick from {self._first} to {last}, the drive has {ticks}"
        return self._found


def _ticks(check: Check, tick_hz: int) -> tuple[int, int | None]:
    """Return the first and the last tick a bound looks at; None: to the end."""
    if check.at_s is not None:
        tick = max(1, round(check.at_s * tick_hz))
        return tick, tick
    return round(check.from_s * tick_hz) + 1, None if check.until_s is None else round(check.until_s * tick_hz)
