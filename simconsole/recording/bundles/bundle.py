"""A bundle: the folder that holds one drive, with a manifest of what belongs to it.

`drive.log` and the resolved profiles are the drive itself; report.html, scene.rrd and other exports are made from
them and may be missing. The manifest is written twice: at the start, so that a killed drive is still a bundle, and
at the end with sizes and checksums.
"""

import contextlib
from collections.abc import Iterator, Mapping
from functools import partial
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Any, Final

import msgspec

from simconsole.recording.bundles.log import LAST_TICKS, LogReader, LogWriter
from simconsole.recording.bundles.manifest import (
    MANIFEST,
    ROOM_BYTES,
    FileEntry,
    Manifest,
    checksum_problem,
    file_entry,
    plain_name,
    read_manifest,
    size_problem,
    write_manifest,
)
from simconsole.recording.framing import START_OF_CHAIN, chain, frame_size
from simconsole.recording.log_header import LogHeader
from simconsole.recording.scan import Break
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import draft_of, give_back, reserve, sync_folder, write_atomically
from simconsole.values.signals import Event

LOG: Final = "drive.log"
SESSION_FILE: Final = "session.json"
_EVENTS: Final = "events.events"
BLOCK_BYTES: Final = 1 << 12
"""Allocation unit of a file system: the last ticks may begin and end inside a block."""


class Bundle:
    """A bundle opened for reading.

    Attributes:
        folder: where it is.
        manifest: what it says of itself.
        log: the recorded state vectors.
    """

    def __init__(self, folder: Path, manifest: Manifest) -> None:
        self.folder = folder
        self.manifest = manifest
        self.log = LogReader(folder / LOG)

    def problems(self) -> list[str]:
        """Return why this is not the whole drive, one line each: the recording failed, the log is damaged.

        The log counts as found by the latest complete pass. A torn last tick of a drive that was not finished is what
        a kill leaves, and no problem; see `remarks`.
        """
        failure = self.manifest.recording_failure or _alarm(self.log)
        failed = [] if failure is None else [failure]
        return failed + [f"{self.log.path}: {part}" for part in self.log.breaks if not self._expected(part)]

    def remarks(self) -> list[str]:
        """Return what is worth knowing about the bundle but is no problem, one line each."""
        unfinished = [] if self.manifest.finished else [_unfinished(self.folder)]
        return unfinished + [
            f"{self.log.path}: {part}: the last tick, as a drive that was killed leaves it"
            for part in self.log.breaks
            if self._expected(part)
        ]

    def _expected(self, part: Break) -> bool:
        return part.torn and not self.manifest.finished

    def text(self, name: str) -> str:
        """Return one of the recorded profiles.

        Raises:
            RecordingError: the manifest does not list it, or it cannot be read.
        """
        if name not in self.manifest.files:
            raise RecordingError(f"{self.folder / name}: not in {MANIFEST}, which lists {sorted(self.manifest.files)}")
        try:
            return (self.folder / name).read_text("utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise RecordingError(f"{self.folder / name}: cannot be read: {error}") from None


class BundleWriter:
    """Records one drive. Leaving it without `finish` keeps an unfinished but readable bundle.

    Leaving it by an error before the first tick removes the folder: a device or port was not available, no drive began.

    Attributes:
        folder: where it is.
        log: append one state vector per tick here; `log.failure` says why the disk took no more.
    """

    def __init__(
        self,
        folder: Path,
        header: LogHeader,
        texts: Mapping[str, str],
        versions: Mapping[str, str] | None = None,
        labels: Mapping[str, str] | None = None,
    ) -> None:
        """Make the folder, write `texts` (resolved profiles, file name to content) and open the log.

        Raises:
            RecordingError: the folder exists and is not empty, or cannot be written.
        """
        self.folder = folder
        self._texts = dict(texts)
        self._made = [path for path in (folder, *folder.parents) if not path.exists()]  # innermost first
        try:
            folder.mkdir(parents=True, exist_ok=True)
            filled = any(folder.iterdir())
        except OSError as error:
            raise RecordingError(f"{folder}: cannot be recorded to: {error.strerror}") from None
        if filled:
            raise RecordingError(f"{folder}: cannot be recorded to: the folder is not empty")
        try:
            for name, text in texts.items():
                write_atomically(folder / plain_name(name, folder), text)
            self.manifest = Manifest(
                files={name: file_entry(folder / name) for name in texts},
                versions=dict(versions or {}),
                labels=dict(labels or {}),
            )
            write_manifest(folder, self.manifest)
            last_ticks_bytes = LAST_TICKS * frame_size(len(header.columns)) + 2 * BLOCK_BYTES
            reserve(folder / MANIFEST, ROOM_BYTES + last_ticks_bytes)
            free_room = partial(give_back, folder / MANIFEST, ROOM_BYTES)
            self.log = LogWriter(folder / LOG, header, free_room=free_room)
            sync_folder(folder)  # a power cut may lose ticks, but no files
        except OSError as error:
            self._discard()
            raise RecordingError(f"{folder}: cannot be recorded to: {error.strerror}") from None
        except RecordingError:
            self._discard()
            raise

    def finish(self, summary: Mapping[str, Any]) -> Manifest:
        """Close the log and write the manifest with its checksums; `summary` holds JSON values.

        Where the manifest cannot be written, the unfinished one stays, and the returned manifest says so. A folder that
        was removed during the drive is made again, with all that was recorded.
        """
        with contextlib.suppress(OSError):
            self._put_back()
        self.log.close()
        self.manifest = msgspec.structs.replace(
            self.manifest, ticks=self.log.ticks, digest=self.log.digest.hex(), recording_failure=self.log.failure
        )
        try:
            files = {**self.manifest.files, LOG: self._log_entry()}
            finished = msgspec.structs.replace(self.manifest, finished=True, files=files, summary=dict(summary))
            write_manifest(self.folder, finished)
            self.manifest = finished
        except OSError as error:
            problem = f"{self.folder}: {MANIFEST} cannot be written: {error.strerror}"
            if self.manifest.recording_failure is None:
                self.manifest = msgspec.structs.replace(self.manifest, recording_failure=problem)
        return self.manifest

    def _put_back(self) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        self.log.put_back()
        for name, text in self._texts.items():
            if not (self.folder / name).exists():
                write_atomically(self.folder / name, text)

    def _log_entry(self) -> FileEntry:
        if self.log.sha256 is None or (self.folder / LOG).stat().st_size != self.log.size_bytes:
            return file_entry(self.folder / LOG)
        return FileEntry(size_bytes=self.log.size_bytes, sha256=self.log.sha256)

    def __enter__(self) -> "BundleWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.log.close()
        if error is not None and self.log.ticks == 0:
            self._discard()
        with contextlib.suppress(OSError):
            draft_of(self.folder / MANIFEST).unlink(missing_ok=True)  # the space reserved for the final manifest

    def _discard(self) -> None:
        """Remove what was made. The folder was empty before, so that all in it belongs to this drive."""
        with contextlib.suppress(OSError):
            for path in self.folder.iterdir():
                path.unlink()
            for path in self._made:
                path.rmdir()


def open_bundle(folder: Path) -> Bundle:
    """Open a bundle after checking that every file of the drive is there in full size.

    Raises:
        RecordingError: no bundle, a file missing or truncated, a newer schema, another byte order.
    """
    manifest = read_manifest(folder)
    for name, entry in manifest.files.items():
        if not entry.export and (problem := size_problem(folder / name, entry)):
            raise RecordingError(problem)
    return Bundle(folder, manifest)


def add_export(folder: Path, name: str) -> None:
    """List a file made from the drive (report.html, scene.rrd), already in the folder, in its manifest.

    Raises:
        RecordingError: no bundle, or the file is not there.
    """
    manifest = read_manifest(folder)
    try:
        entry = msgspec.structs.replace(file_entry(folder / plain_name(name, folder)), export=True)
        write_manifest(folder, msgspec.structs.replace(manifest, files={**manifest.files, name: entry}))
    except OSError as error:
        raise RecordingError(f"{folder / name}: cannot be added to {MANIFEST}: {error.strerror}") from None


def verify(folder: Path) -> list[str]:
    """Check every file, checksum, record and hash; return one line for each problem, none if all is well.

    Raises:
        RecordingError: the folder has no manifest that can be read.
    """
    manifest = read_manifest(folder)
    problems = [] if manifest.finished else [_unfinished(folder)]
    if manifest.recording_failure:
        problems.append(manifest.recording_failure)
    for name, entry in manifest.files.items():
        if problem := size_problem(folder / name, entry) or checksum_problem(folder / name, entry):
            problems.append(problem)
    problems += _log_problems(folder / LOG, manifest)
    return problems


def _unfinished(folder: Path) -> str:
    return f"{folder / MANIFEST}: the drive was not finished"


def _alarm(log: LogReader) -> str | None:
    """Return one line if the last tick holds the alarm: a drive that was killed after its recording had failed."""
    if log.last is None or _EVENTS not in log.header.columns:
        return None
    if not int(log.last.vector[log.header.columns.index(_EVENTS)]) & Event.RECORDING_FAILED:
        return None
    return f"{log.path}: recording stopped at tick {log.last.tick - 1}"


def session_problem(path: Path, text: str, header: LogHeader) -> str | None:
    """Return one line if `text` is not the session that the log of `header` was recorded with, else None."""
    found = sha256(text.encode()).hexdigest()
    if found == header.session_sha256:
        return None
    return f"{path}: altered: sha256 {found}, {LOG} was recorded with {header.session_sha256}"


def _log_problems(path: Path, manifest: Manifest) -> Iterator[str]:
    try:
        log = LogReader(path)
    except RecordingError as error:
        yield str(error)
        return
    digest, ticks, broken = START_OF_CHAIN, 0, None
    for record in log:
        digest = chain(digest, record.tick, record.vector.tobytes())
        if broken is None and digest != record.digest:
            broken = record.tick
        digest = record.digest
        ticks += 1
    session = path.parent / SESSION_FILE
    if SESSION_FILE in manifest.files:
        with contextlib.suppress(OSError, UnicodeDecodeError):  # named with the other files
            if problem := session_problem(session, session.read_text("utf-8"), log.header):
                yield problem
    if manifest.recording_failure is None and (alarm := _alarm(log)):
        yield alarm
    yield from (f"{path}: {part}" for part in log.breaks)
    if broken is not None:
        yield f"{path}: the chained hash does not hold at tick {broken}"
    found, stated = f"{ticks} ticks, hash {digest.hex()}", f"{manifest.ticks} ticks, hash {manifest.digest}"
    if manifest.finished and found != stated:
        yield f"{path}: {found}, {MANIFEST} says {stated}"
