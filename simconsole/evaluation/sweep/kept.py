"""A scenario's drive as a bundle: `simconsole sweep --drive` writes it, which `simconsole replay` reads."""

from pathlib import Path

from simconsole.processes.lifetimes import remove_half_made, undone
from simconsole.recording.bundles.provenance import Given
from simconsole.recording.log_header import ACTS, message_stream
from simconsole.session.lifecycle import new_bundle
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import RecordingError
from simconsole.values.kernels import Row


def write_drive(folder: Path, resolved: ResolvedSession, console: Console, vectors: Row, trial: str) -> str:
    """Write a drive that is in memory into the new bundle `folder`, and return its digest.

    Args:
        folder: new, or empty.
        resolved: its session as it was driven.
        console: that drove it.
        vectors: its state vectors [ticks, columns].
        trial: which of the sweep's drives it is.

    Raises:
        RecordingError: it cannot be written.
    """
    with undone(lambda: remove_half_made(folder)):
        given = Given(trial=trial).checked()
        with new_bundle(resolved, console, folder, given, (message_stream(ACTS),)) as bundle:
            written = 0
            while written < len(vectors):
                written += bundle.log.append_block(1 + written, vectors[written:])
            exact = {} if console.platform.exact else {"bit_exact": False}
            manifest = bundle.finish({"interrupted": False, **exact})
    if manifest.recording_failure is not None:
        raise RecordingError(f"{folder}: {manifest.recording_failure}")
    return manifest.digest
