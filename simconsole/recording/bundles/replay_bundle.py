"""Replay of a bundle: build the console that the bundle describes and make every tick again."""

import hashlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Final

import msgspec
import numpy as np

from simconsole.profiles.files.world_files import located, with_kind
from simconsole.profiles.strict_yaml import parse
from simconsole.profiles.validation import convert
from simconsole.recording.bundles.bundle import SESSION_FILE, Bundle, open_bundle, session_problem
from simconsole.recording.framing import Record
from simconsole.recording.replay import Remade, ReplayResult, replay
from simconsole.tick.advance import Console, ConsoleState, advance_vector, decide
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.errors import RecordingError
from simconsole.values.host import jit
from simconsole.values.host.jit import compiled
from simconsole.values.signals import NO_COMMAND, NO_EVENTS, NO_SAMPLE
from simconsole.values.state_vector import TickInputs, input_vector
from simconsole.values.version import __version__
from simconsole.world.obstacles.striking import strike
from simconsole.world.rules.situation import look_around

_TICKS_BETWEEN_WORDS: Final = 500


def recorded_session(bundle: Bundle) -> ResolvedSession:
    """Return the session as it was driven, every profile in full.

    Raises:
        RecordingError: the bundle does not hold it, or another one than the log was recorded with.
        ProfileError: it was altered into something that is no session.
    """
    text, path = bundle.text(SESSION_FILE), bundle.folder / SESSION_FILE
    if problem := session_problem(path, text, bundle.log.header):
        raise RecordingError(problem)
    plain = parse(text, str(path))
    if isinstance(plain, dict) and plain.get("world") is not None:
        plain["world"] = with_kind(plain["world"])
    resolved = convert(plain, ResolvedSession, str(path))
    if resolved.world is None:
        return resolved
    return msgspec.structs.replace(resolved, world=located(resolved.world, bundle.folder))


def sources_sha256(console: Console) -> str:
    """Return what a log says of the sources that made its state vectors."""
    on = console.platform
    # A step that is not compiled is whatever its package makes of it: it says itself by what it is known, if at all.
    step = jit.digest(on.step) if on.compiled else str(getattr(on.step, "digest", on.name))
    sources = "".join((jit.digest(decide), jit.digest(strike), step, jit.digest(look_around)))
    return hashlib.sha256(sources.encode()).hexdigest()


def state_at(folder: Path, tick: int) -> tuple[Console, ConsoleState]:
    """Return the console of a bundle and its state after `tick`; the vector is the whole state, so a drive can go on.

    Raises:
        RecordingError: not a bundle, of another version, or without this tick.
    """
    bundle = open_bundle(folder)
    console, start = assemble(recorded_session(bundle), compiled)
    if tick == 0:
        return console, start
    if bundle.log.header.columns != console.columns:
        raise RecordingError(f"{folder}: its columns are not this version's: no drive can go on from it")
    last = 0
    for record in bundle.log:
        if record.tick == tick:
            return console, ConsoleState(tick, np.array(record.vector))
        last = record.tick
    raise RecordingError(f"{folder}: tick: value {tick}: 0 to {last}, and recorded")


def replay_bundle(
    folder: Path,
    tolerances: Mapping[str, float] | None = None,
    told: Callable[[int, int], None] = lambda done, of: None,
) -> ReplayResult:
    """Make every tick of the bundle in `folder` again from its recorded inputs, and compare the fields of both.

    `tolerances` are absolute differences that are allowed, by column or pattern, as of `allowed_differences`; `told` is
    told now and then how many ticks of how many (0: unknown) are made.

    Raises:
        RecordingError: not a bundle, truncated, with a gap, or a tolerance for no field.
    """
    bundle = open_bundle(folder)
    console, state = assemble(recorded_session(bundle), compiled)
    found = replay(
        _counted(bundle, told),
        bundle.log.header,
        Remade(
            columns=console.columns,
            no_inputs=input_vector(TickInputs(NO_SAMPLE, NO_COMMAND, NO_EVENTS, others=(0.0,) * console.others)),
            initial=state.vector,
            advance=lambda tick, previous, inputs: advance_vector(previous, inputs, console),
            others=console.others,
        ),
        tolerances=tolerances,
        first_tick=1,
        recorded_ticks=bundle.manifest.ticks if bundle.manifest.finished else None,
    )
    remarks = bundle.remarks() + _other_sources(bundle, console)
    broken = [f"{bundle.log.path}: {problem}" for problem in found.problems]
    return found._replace(problems=(*broken, *bundle.problems()), remarks=tuple(remarks))


def _counted(bundle: Bundle, told: Callable[[int, int], None]) -> Iterator[Record]:
    total = bundle.manifest.ticks if bundle.manifest.finished else 0
    for done, record in enumerate(bundle.log):
        if done % _TICKS_BETWEEN_WORDS == 0:
            told(done, total)
        yield record


def _other_sources(bundle: Bundle, console: Console) -> list[str]:
    header, here = bundle.log.header, sources_sha256(console)
    if header.source_sha256 == here:
        return []
    recorded = f"{header.source_sha256[:12]} (simconsole {header.console_version})"
    return [f"{bundle.log.path}: recorded with other sources: {recorded}, here {here[:12]} ({__version__})"]
