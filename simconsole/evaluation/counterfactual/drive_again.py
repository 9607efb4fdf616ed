"""A recorded drive again with one thing changed: the same inputs, other parameters, a bundle of its own.

It is open loop: driver, controller and everybody else on the road do what they did, whatever the vehicle does now.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import msgspec

from simconsole.processes.lifetimes import remove_half_made, undone
from simconsole.profiles.strict_yaml import parse
from simconsole.recording.bundles.bundle import Bundle, open_bundle
from simconsole.recording.bundles.provenance import NOTE_CHARS, Given
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.recording.framing import Record
from simconsole.recording.replay import Remade, ReplayResult, replay
from simconsole.session.lifecycle import new_bundle
from simconsole.session.resolution import parted, with_named_values, with_session_values
from simconsole.tick.advance import Console, ConsoleState, advance_vector
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.errors import ProfileError, RecordingError
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import Row
from simconsole.values.signals import NO_COMMAND, NO_EVENTS, NO_SAMPLE
from simconsole.values.state_vector import TickInputs, input_vector

OPEN_LOOP: Final = "open loop: driver, controller and other road users do what they did and do not react"
_COMPUTES: Final = ("environment.", "scenario.start", "features.control.", "features.aids.", "features.commander")
_NAMES: Final = ("environment.world", "environment.traffic")
"""Keys of a session that a tick is computed with; of the environment without what names a file or other vehicles."""


class Again(NamedTuple):
    """Two drives of the same inputs."""

    folder: Path  # of the new bundle
    unchanged: ReplayResult  # the recorded drive, made again by this version as it was
    changed: ReplayResult  # its columns against those with the values changed


def changes_of(words: Sequence[str]) -> dict[str, object]:
    """Return the values that KEY=VALUE words say, each as in a profile.

    Raises:
        ProfileError: one says none.
    """
    values: dict[str, object] = {}
    for word in words:
        key, equals, text = word.partition("=")
        if not (key and equals and text):
            raise ProfileError(f"--set: value {word}: KEY=VALUE, as body.mass_kg=1600")
        values[key] = parse(text, f"--set {key}")
    return values


def drive_again(folder: Path, values: Mapping[str, object], out: Path) -> Again:
    """Make the drive in the bundle `folder` again with other values, into the new bundle `out`.

    Args:
        folder: a whole drive.
        values: by dotted key, as of `resolution.parted`: of the vehicle, the cockpit, the world, and what of the
            session a tick is computed with. What only says where inputs come from would change nothing and is refused.
        out: new or empty.

    Raises:
        RecordingError: not a bundle, truncated, with a gap, or `out` cannot be written.
        ProfileError: no such key, one that changes nothing, or a value out of its bounds.
    """
    bundle = open_bundle(folder)
    recorded = recorded_session(bundle)
    changed = _changed(recorded, values)
    console, start = assemble(changed, compiled)
    if console.tick_hz != bundle.log.header.tick_hz:
        raise RecordingError(f"{folder}: recorded with {bundle.log.header.tick_hz} ticks a second")
    before = _made(bundle, *assemble(recorded, compiled))
    with undone(lambda: remove_half_made(out)):
        others = bundle.log.header.streams[1:]
        with new_bundle(changed, console, out, _given(bundle, values), others) as writer:
            messages = _Messages(bundle)

            def advance(tick: int, previous: Row, inputs: Row) -> Row:
                vector = advance_vector(previous, inputs, console)
                writer.log.append(tick, vector, messages.of_this_tick)
                return vector

            found = replay(messages, bundle.log.header, _remade(console, start.vector)._replace(advance=advance))
            writer.finish({"counterfactual": dict(values), "of": bundle.manifest.digest, "driver": OPEN_LOOP})
    if writer.log.failure is not None:
        raise RecordingError(writer.log.failure)
    return Again(out, before, found)


def _changed(recorded: ResolvedSession, values: Mapping[str, object]) -> ResolvedSession:
    if not values:
        raise ProfileError("--set: nothing is changed: KEY=VALUE, as body.mass_kg=1600")
    of_session, of_named = parted(values)
    for key in of_session:
        if not key.startswith(_COMPUTES) or key.startswith(_NAMES):
            raise ProfileError(
                f"--set {key}: inputs are recorded, so this would change nothing: a key of the vehicle, cockpit. or "
                "world., environment, scenario.start, features.control, features.aids or features.commander"
            )
    resolved = with_named_values(recorded, of_named, "--set")
    return msgspec.structs.replace(resolved, session=with_session_values(resolved.session, of_session, "--set"))


def _made(bundle: Bundle, console: Console, start: ConsoleState) -> ReplayResult:
    return replay(bundle.log, bundle.log.header, _remade(console, start.vector), first_tick=1)


def _remade(console: Console, initial: Row) -> Remade:
    return Remade(
        columns=console.columns,
        no_inputs=input_vector(TickInputs(NO_SAMPLE, NO_COMMAND, NO_EVENTS)),
        initial=initial,
        advance=lambda tick, previous, inputs: advance_vector(previous, inputs, console),
    )


class _Messages:
    """The records of a drive, which remembers what else came with the tick that is made now."""

    def __init__(self, bundle: Bundle) -> None:
        self._log = bundle.log
        self._names = [stream.name for stream in bundle.log.header.streams]
        self._record: Record | None = None

    def __iter__(self) -> Iterator[Record]:
        for record in self._log:
            self._record = record
            yield record

    @property
    def of_this_tick(self) -> list[tuple[str, bytes]]:
        messages = () if self._record is None else self._record.messages
        return [(self._names[message.stream], message.content) for message in messages]


def _given(bundle: Bundle, values: Mapping[str, object]) -> Given:
    """Return what the new bundle says of itself; who drove is who drove."""
    known = bundle.manifest.provenance
    changes = ", ".join(f"{key}={value}" for key, value in values.items())
    notes = (f"counterfactual of {bundle.manifest.digest}: {changes}"[:NOTE_CHARS], OPEN_LOOP)
    return Given(participant=known.participant, trial=known.trial, notes=notes)
