"""Pack a finished drive: its log becomes drive.parquet; and the way back, byte for byte.

The other form is written beside the one there is, read back and compared; then the manifest is replaced, which lists
it, and only then the first form is removed. A kill at any moment leaves a bundle with one whole form that its manifest
lists, and maybe files that it does not list: the next call removes these.
"""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np

from simconsole.processes.lifetimes import undone
from simconsole.recording.bundles.bundle import LOG, PACKED_LOG, Bundle, leftovers, open_bundle
from simconsole.recording.bundles.log import LogReader
from simconsole.recording.bundles.manifest import (
    FileEntry,
    checksum_problem,
    entry_of,
    file_entry,
    refuse_signed,
    write_manifest,
)
from simconsole.recording.bundles.packed_log import PackedLog
from simconsole.recording.bundles.packed_writer import PackedLogWriter
from simconsole.recording.bundles.verification import log_problems
from simconsole.recording.framing import Record
from simconsole.recording.packing_rules import RuleFinder
from simconsole.recording.reading import BLOCK_TICKS
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import draft_of, replaced, sync_folder

Watch = Callable[[str, float], object]
"""`watch(what, share)`: what is being done, and how far it has come, 0 to 1."""


class Sizes(NamedTuple):
    """Bytes of the two forms of a drive."""

    log_bytes: int
    packed_bytes: int


def pack(folder: Path, watch: Watch = lambda what, share: None) -> Sizes:
    """Let drive.parquet stand for the log of the finished drive in `folder`. Does nothing to a packed one.

    Raises:
        RecordingError: not a bundle, or a signed one; the drive was not finished, its recording failed, its log is
            not whole; or drive.parquet cannot be written. The bundle is then as it was.
    """
    bundle = _finished(folder)
    log = bundle.log
    if not isinstance(log, LogReader):
        return _sizes(bundle)
    if problem := _problem(bundle):
        raise RecordingError(f"{folder}: not packed: {problem}")
    refuse_signed(folder)
    entry = bundle.manifest.files[LOG]
    finder = RuleFinder(log.header.columns)
    for records in _blocks(bundle, watch, "looking at the columns"):
        finder.add(np.array([record.vector for record in records]))
    with _form(folder, PACKED_LOG) as draft:
        with PackedLogWriter(draft, log.header, log.start, finder.rules()) as writer:
            for records in _blocks(bundle, watch, "packing"):
                writer.append(records)
        if entry_of(_log_bytes(PackedLog(draft), bundle, watch)) != entry:
            raise RecordingError(f"{draft}: does not give back the bytes of {LOG}, which stays")
    _switch(bundle, LOG, PACKED_LOG, packed_log=entry)
    return _sizes(open_bundle(folder))


def unpack(folder: Path, watch: Watch = lambda what, share: None) -> Sizes:
    """Make the log of the packed drive in `folder` again, byte for byte, in the place of drive.parquet.

    Does nothing to one that is not packed.

    Raises:
        RecordingError: not a bundle, or a signed one; drive.parquet is damaged, or the log cannot be written. The
            bundle is then as it was.
    """
    bundle = _finished(folder)
    log, entry = bundle.log, bundle.manifest.packed_log
    if not isinstance(log, PackedLog):
        return Sizes(bundle.manifest.files[LOG].size_bytes, 0)
    refuse_signed(folder)
    sizes = _sizes(bundle)
    with _form(folder, LOG) as draft:
        with draft.open("wb") as file:
            for part in _log_bytes(log, bundle, watch):
                file.write(part)
        if file_entry(draft) != entry:
            raise RecordingError(f"{log.path}: damaged: does not give back the {LOG} that was packed")
    _switch(bundle, PACKED_LOG, LOG, packed_log=None)
    return sizes


def _finished(folder: Path) -> Bundle:
    """Open the bundle and remove what a killed pack or unpack left. An unfinished drive's log is listed nowhere."""
    bundle = open_bundle(folder)
    if not bundle.manifest.finished:
        raise RecordingError(f"{folder}: not packed: the drive was not finished; it keeps its log")
    _remove(*(folder / name for name in leftovers(bundle.manifest)))
    return bundle


def _problem(bundle: Bundle) -> str | None:
    """Return why the log is not whole, or not of a good recording; None if it is."""
    failure = bundle.manifest.recording_failure
    altered = checksum_problem(bundle.log.path, bundle.manifest.files[LOG])
    return failure or next(log_problems(bundle.log, bundle.manifest), altered)


def _sizes(bundle: Bundle) -> Sizes:
    log, packed = bundle.manifest.packed_log, bundle.manifest.files[PACKED_LOG]
    return Sizes(0 if log is None else log.size_bytes, packed.size_bytes)


def _blocks(bundle: Bundle, watch: Watch, what: str) -> Iterator[list[Record]]:
    """Yield the records of the log in blocks."""
    records, ticks = iter(bundle.log), 0
    while part := list(islice(records, BLOCK_TICKS)):
        yield part
        ticks += len(part)
        watch(what, ticks / bundle.manifest.ticks)


def _log_bytes(log: PackedLog, bundle: Bundle, watch: Watch) -> Iterator[bytes]:
    """Yield the log that `log` gives back."""
    for number, part in enumerate(log.log_bytes()):
        watch("unpacking", min(number * BLOCK_TICKS / max(bundle.manifest.ticks, 1), 1.0))
        yield part


@contextmanager
def _form(folder: Path, name: str) -> Iterator[Path]:
    """Yield the draft of a form; on leaving it is on the disk under its own name, after an error it is gone."""
    path = folder / name
    try:
        with undone(partial(_remove, draft_of(path))), replaced(path) as draft:
            yield draft
            with draft.open("rb+") as file:
                os.fsync(file.fileno())
        sync_folder(folder)
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror or error}") from None


def _switch(bundle: Bundle, old: str, new: str, packed_log: FileEntry | None) -> None:
    """List `new` in the place of `old`, which is then removed."""
    folder, manifest = bundle.folder, bundle.manifest
    try:
        files = {name: entry for name, entry in manifest.files.items() if name != old}
        files[new] = file_entry(folder / new)
        write_manifest(folder, msgspec.structs.replace(manifest, files=files, packed_log=packed_log))
        _remove(folder / old)
    except OSError as error:
        raise RecordingError(f"{folder}: the manifest cannot be written: {error.strerror}") from None


def _remove(*paths: Path) -> None:
    for path in paths:
        path.unlink(missing_ok=True)
