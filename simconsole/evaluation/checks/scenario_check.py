"""Drive one scenario headless and judge it: bounds on columns, its golden, the limits of its manoeuvre.

Worker of `simconsole check`.
"""

import math
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple, Self, TextIO, TypeVar

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.drivers.scripted_controller import ScriptedCommands
from simconsole.evaluation.checks import golden
from simconsole.evaluation.checks.manoeuvre_check import drive, judge_limit
from simconsole.evaluation.manoeuvres.attempt import Result
from simconsole.faults.schedule import with_faults
from simconsole.profiles.manoeuvre import Limit, Manoeuvre
from simconsole.profiles.scenario import Check, ScenarioProfile
from simconsole.recording.framing import START_OF_CHAIN, chain
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.resolution import load_scenario, resolve
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.tick.isolation import isolated
from simconsole.tick.loop import Components, Recorder, run
from simconsole.values.errors import ProfileError
from simconsole.values.host.files import replaced
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import Row
from simconsole.values.protocols import DeviceSource, NobodySeated
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
    with ExitStack() as stack:

        def watched(console: Console) -> Watch:
            sampled = (Accepting if update_golden else Comparing)(accepted, console.tick_hz, console.columns)
            stack.enter_context(sampled)
            bounds = [Bound(check, console.columns, console.tick_hz, str(path)) for check in scenario.checks]
            return Watch(bounds, sampled, golden.step_ticks(console.tick_hz, scenario.golden_hz))

        watch = drive_scenario(scenario, watched)
        digest = watch.digest.hex()
        judged = [bound.problem(watch.ticks) for bound in watch.bounds]
        problems = [problem for problem in judged if problem is not None] + watch.samples.end(digest)
    return Verdict(
        scenario=path.stem,
        passed=not problems,
        ticks=watch.ticks,
        digest=digest,
        problems=problems,
        title=scenario.title,
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
    scenario: ScenarioProfile, recorder_of: Callable[[Console], R], resolved: ResolvedSession | None = None
) -> R:
    """Drive a scenario without files into the recorder that `recorder_of` makes, and return that.

    `resolved` takes the place of the scenario's own session: the same with other values.
    """
    resolved = resolve(scenario.session) if resolved is None else resolved
    console, state = assemble(resolved, compiled)
    tick_hz = console.tick_hz
    devices: DeviceSource = NobodySeated()
    if scenario.script is not None:
        devices = ScriptSource(scenario.script, cockpit_settings(resolved.cockpit, tick_hz), tick_hz=tick_hz)
    recorder = recorder_of(console)
    commands = ScriptedCommands(scenario.remote, scenario.events, tick_hz)
    ecu = ScriptedCommands(scenario.ecu, scenario.ecu_events, tick_hz)
    components = Components(devices, commands, recorder, outputs=(), pace=UnpacedPacer(), ecu=ecu)
    components = isolated(with_faults(components, resolved, tick_hz), UnpacedPacer)
    components = components._replace(recorder=recorder)  # in a check, unlike in a drive, a failing recorder raises
    run(console, state, components, round(scenario.duration_s * tick_hz))
    return recorder


class Watch:
    """The recorder of a check: looks at every tick as it is driven and keeps none, so that a drive may be long.

    Attributes:
        bounds: checked at every tick.
        samples: writes the golden, or compares with it.
        ticks: seen so far.
        digest: chained hash of them.
    """

    def __init__(self, bounds: "Sequence[Bound]", samples: "Accepting | Comparing", step_ticks: int) -> None:
        self.bounds, self.samples = bounds, samples
        self._step_ticks = step_ticks
        self.ticks = 0
        self.digest = START_OF_CHAIN

    def write(self, snapshot: Snapshot) -> int:
        """Look at one tick."""
        self.ticks += 1
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


class Accepting:
    """Writes the drive as the new golden, which replaces the old one at the end."""

    def __init__(self, path: Path, tick_hz: int, columns: tuple[str, ...]) -> None:
        self._path, self._tick_hz, self._columns = path, tick_hz, columns
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        """Open the draft of the golden."""
        self._path.parent.mkdir(exist_ok=True)
        draft = self._stack.enter_context(replaced(self._path))
        self._file = self._stack.enter_context(draft.open("w", encoding="utf-8", newline="\n"))
        self._file.write(self._head(START_OF_CHAIN.hex()))
        return self

    def __exit__(self, *error: Any) -> None:
        """Replace the golden by the draft, or remove the draft after an error."""
        self._stack.__exit__(*error)

    def see(self, tick: int, vector: Row) -> None:
        """Write one sample."""
        self._file.write(golden.line(tick, vector))

    def end(self, digest: str) -> list[str]:
        """Write the hash of the drive into the golden's head; return no differences, for the drive is accepted."""
        self._file.seek(0)
        self._file.write(self._head(digest))
        return []

    def _head(self, digest: str) -> str:
        return golden.head(digest, self._tick_hz, self._columns)


class Comparing:
    """Compares the drive with its golden."""

    def __init__(self, path: Path, tick_hz: int, columns: tuple[str, ...]) -> None:
        self._path, self._columns = path, columns
        self._file: TextIO | None = None

    def __enter__(self) -> Self:
        """Open the golden, if there is one.

        Raises:
            ProfileError: it is no golden of this version.
        """
        if self._path.is_file():
            self._file = self._path.open(encoding="utf-8", newline="")
            self._golden = golden.Golden(self._file, str(self._path))
            self._comparison = golden.Comparison(self._golden, self._columns)
        return self

    def __exit__(self, *error: Any) -> None:
        """Close it."""
        if self._file is not None:
            self._file.close()

    def see(self, tick: int, vector: Row) -> None:
        """Compare one sample."""
        if self._file is not None:
            self._comparison.see(tick, vector)

    def end(self, digest: str) -> list[str]:
        """Return how the finished drive differs from the golden, one line or none."""
        if self._file is None:
            return [f"{self._path}: no golden; accept one with --update-golden"]
        difference = self._comparison.first_difference()
        if (self._golden.hash, self._golden.columns) == (digest, self._columns):
            return []
        if difference is None:
            return [f"{self._path}: hash {digest}, accepted {self._golden.hash}; no sampled value differs"]
        return [
            f"{self._path}: tick {difference.tick}: {difference.column}: "
            f"driven {difference.driven!r}, accepted {difference.accepted!r}"
        ]
