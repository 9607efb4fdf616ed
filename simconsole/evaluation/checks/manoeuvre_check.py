"""Drive a scenario's manoeuvre, attempt by attempt, and judge its characteristic values by the scenario's limits."""

import math
from typing import NamedTuple

from msgspec.structs import replace

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.drivers.manoeuvre_driver.pilot_devices import PilotDevices
from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.evaluation.manoeuvres.attempt import Attempt, Result
from simconsole.evaluation.manoeuvres.library import drive_manoeuvre
from simconsole.evaluation.metrics.table import drive_of
from simconsole.profiles.manoeuvre import Limit, Manoeuvre
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.recording.framing import START_OF_CHAIN
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.resolution import resolve
from simconsole.session.scripted.opening import check_alone
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.tick.loop import Components, run
from simconsole.values.errors import ProfileError
from simconsole.values.host.jit import compiled
from simconsole.values.protocols import NobodyCommands


class Driven(NamedTuple):
    """A manoeuvre as driven."""

    result: Result
    ticks: int
    digest: str  # chained over all attempts


def drive(scenario: ScenarioProfile, manoeuvre: Manoeuvre, resolved: ResolvedSession | None = None) -> Driven:
    """Drive every attempt of a manoeuvre and evaluate it; `resolved` takes the place of the scenario's own session.

    Raises:
        ProfileError: a profile that the scenario names is missing or wrong, its session has several platforms, or it
            watches a script but has none.
    """
    resolved = resolve(scenario.session) if resolved is None else resolved
    check_alone(scenario, resolved)
    console, _ = assemble(resolved, compiled)
    at_work = drive_manoeuvre(manoeuvre, console.platform, scenario.duration_s)
    ticks, digest = 0, START_OF_CHAIN
    attempt = next(at_work)
    while True:
        recorder = _drive(scenario, resolved, attempt, digest)
        ticks, digest = ticks + recorder.ticks, recorder.digest
        try:
            attempt = at_work.send(drive_of(recorder.vectors[: recorder.ticks], console.columns, console.tick_hz))
        except StopIteration as end:
            return Driven(end.value, ticks, digest.hex())


def judge_limit(limit: Limit, values: dict[str, float], origin: str) -> str | None:
    """Return what is wrong with one value, None if it is inside; `origin` (the scenario's file) opens an error.

    Raises:
        ProfileError: the manoeuvre has no such value.
    """
    if limit.value not in values:
        raise ProfileError(f"{origin}: limits: value: value {limit.value}: one of {', '.join(sorted(values))}")
    low = -math.inf if limit.min is None else limit.min
    high = math.inf if limit.max is None else limit.max
    value = values[limit.value]
    return None if low <= value <= high else f"{limit.value}: {value:.6g} not in {low:g} to {high:g}"


def _drive(scenario: ScenarioProfile, resolved: ResolvedSession, attempt: Attempt, digest: bytes) -> MemoryRecorder:
    session = resolved.session
    features = replace(session.features, aids=replace(session.features.aids, **dict.fromkeys(attempt.off, False)))
    if attempt.pilot is not None:
        features = replace(features, control=replace(features.control, manual_automatic=True))
    console, state = assemble(replace(resolved, session=replace(session, features=features)), compiled)
    ticks = round(attempt.longest_s * console.tick_hz)
    recorder = MemoryRecorder(ticks, console.width, digest)
    if attempt.pilot is None:
        run(console, state, _scripted(scenario, resolved, recorder, console), ticks)
        return recorder
    seat = PilotDevices(attempt.pilot, cockpit_settings(resolved.cockpit, console.tick_hz))
    components = Components(seat, NobodyCommands(), recorder, outputs=(), pace=UnpacedPacer(), seat=seat)
    run(console, state, components, ticks, lambda snapshot: seat.finished)
    return recorder


def _scripted(
    scenario: ScenarioProfile, resolved: ResolvedSession, recorder: MemoryRecorder, console: Console
) -> Components:
    if scenario.script is None:
        raise ProfileError(f"{scenario.title}: script: value missing: a script that the manoeuvre can watch")
    source = ScriptSource(scenario.script, cockpit_settings(resolved.cockpit, console.tick_hz), tick_hz=console.tick_hz)
    return Components(source, NobodyCommands(), recorder, outputs=(), pace=UnpacedPacer())
