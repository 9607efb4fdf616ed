"""Replay of a bundle: build the console that the bundle describes and make every tick again."""

from pathlib import Path

import numpy as np

from simconsole.assembly import ResolvedSession, assemble
from simconsole.compiling import compiled
from simconsole.errors import RecordingError
from simconsole.pipeline import Console, ConsoleState, advance_row
from simconsole.profile_files import parse
from simconsole.recording.bundle import Bundle, open_bundle
from simconsole.recording.replay import ReplayResult, replay

SESSION_FILE = "session.json"


def recorded_session(bundle: Bundle) -> ResolvedSession:
    """Return the session as it was driven, every profile in full.

    Raises:
        RecordingError: the bundle does not hold it.
        ProfileError: it was altered into something that is no session.
    """
    return parse(bundle.text(SESSION_FILE), ResolvedSession, str(bundle.folder / SESSION_FILE))


def state_at(folder: Path, tick: int) -> tuple[Console, ConsoleState]:
    """Return the console of a bundle and its state after `tick`: a row is the whole state, so a drive can go on there.

    Raises:
        RecordingError: not a bundle, of another version, or without this tick.
    """
    bundle = open_bundle(folder)
    console, start = assemble(recorded_session(bundle), compiled)
    table = bundle.log.table()
    if tick == 0:
        return console, start
    if not 1 <= tick <= len(table.rows) or table.columns != console.columns:
        raise RecordingError(f"{folder}: tick: value {tick}: 0 to {len(table.rows)}, of a drive with the same columns")
    return console, ConsoleState(tick, np.array(table.rows[tick - 1]))


def replay_bundle(folder: Path) -> ReplayResult:
    """Make every tick of the bundle in `folder` again from its recorded inputs.

    Raises:
        RecordingError: not a bundle, truncated, or of another version.
    """
    bundle = open_bundle(folder)
    console, state = assemble(recorded_session(bundle), compiled)
    return replay(
        bundle.log,
        bundle.log.header,
        console.columns,
        state.row,
        lambda tick, previous, inputs: advance_row(previous, inputs, console),
        first_tick=1,
        recorded_ticks=bundle.manifest.ticks if bundle.manifest.finished else None,
    )
