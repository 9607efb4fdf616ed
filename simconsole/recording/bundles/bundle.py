"""A bundle: the folder that holds one drive, with a manifest of what belongs to it.

`drive.log` and the resolved profiles are the drive itself; in a packed bundle `drive.parquet` stands for the log.
report.html, scene.rrd and other exports are made from them and may be missing. The manifest is written at the start,
with all that is known of where the drive comes from, again when the devices are open, and at the end with sizes and
checksums: a killed drive is a bundle too.
"""

import contextlib
from collections.abc import Iterable, Mapping
from functools import partial
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Any, Final

import msgspec

from simconsole.processes.lifetimes import unbroken, undone
from simconsole.recording.bundles.log import LAST_TICKS, LogReader, LogWriter
from simconsole.recording.bundles.manifest import (
    MANIFEST,
    ROOM_BYTES,
    SIGNATURE,
    FileEntry,
    Manifest,
    file_entry,
    plain_name,
    read_manifest,
    size_problem,
    write_manifest,
)
from simconsole.recording.bundles.packed_log import PackedLog
from simconsole.recording.bundles.provenance import UNKNOWN, Provenance
from simconsole.recording.framing import frame_size
from simconsole.recording.log_header import LogHeader
from simconsole.recording.scan import Break
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import DRAFT, draft_of, give_back, reserve, write_atomically
from simconsole.values.signals import Event

LOG: Final = "drive.log"
PACKED_LOG: Final = "drive.parquet"
"""What stands for the log in a bundle that was packed; the manifest of a finished drive lists one of the two."""

SESSION_FILE: Final = "session.json"
_EVENTS: Final = "events.events"
BLOCK_BYTES: Final = 1 << 12
"""Allocation unit of a file system: the last ticks may begin and end inside a block."""
MESSAGE_BYTES: Final = 1 << 13
"""Room for the messages of each of the last ticks: more than any act of an operator is long."""


Log = LogReader | PackedLog


class Bundle:
    """A bundle opened for reading.

    Attributes:
        folder: where it is.
        manifest: what it says of itself.
        log: the recorded state vectors, in the form in which the bundle has them.
    """

    def __init__(self, folder: Path, manifest: Manifest) -> None:
        self.folder = folder
        self.manifest = manifest
        self.log = open_log(folder, manifest)

    def problems(self) -> list[str]:
        """Return why this is not the whole drive, one line each: the recording failed, the log is damaged.

        The log counts as found by the latest complete pass. A torn last tick of a drive that was not finished is what
        a kill leaves, and no problem; see `remarks`.
        """
        failure = self.manifest.recording_failure or alarm(self.log)
        failed = [] if failure is None else [failure]
        return failed + [f"{self.log.path}: {part}" for part in self.log.breaks if not self._expected(part)]

    def remarks(self) -> list[str]:
        """Return what is worth knowing about the bundle but is no problem, one line each."""
        left = [] if self.manifest.finished else [unfinished(self.folder)]
        return left + [
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
    So does a signal that ends the process at once. At no moment the manifest vouches for what is not there.

    Attributes:
        folder: where it is.
        log: append one state vector per tick here; `log.failure` says why the disk took no more.
    """

    def __init__(
        self,
        folder: Path,
        header: LogHeader,
        contents: Mapping[str, str | bytes],
        versions: Mapping[str, str] | None = None,
        provenance: Provenance = UNKNOWN,
    ) -> None:
        """Make the folder, write the resolved profiles and the first manifest, and open the log.

        Args:
            folder: new, or empty.
            header: of the log.
            contents: resolved profiles and what they need of a map, file name to content.
            versions: of the packages that make the result.
            provenance: what is known now of where the drive comes from; see `extend_provenance`.

        Raises:
            RecordingError: the folder exists and is not empty, or cannot be written.
        """
        self.folder = folder
        self._contents = dict(contents)
        self._made = [path for path in (folder, *folder.parents) if not path.exists()]  # innermost first
        self._undo = contextlib.ExitStack()
        try:
            filled = folder.is_dir() and any(folder.iterdir())
        except OSError as error:
            raise RecordingError(f"{folder}: cannot be recorded to: {error.strerror}") from None
        if filled:
            raise RecordingError(f"{folder}: cannot be recorded to: the folder is not empty")
        with unbroken(), undone(self._discard):
            try:
                self._make(header, Manifest(versions=dict(versions or {}), provenance=provenance))
            except OSError as error:
                self._discard()
                raise RecordingError(f"{folder}: cannot be recorded to: {error.strerror}") from None
            except RecordingError:
                self._discard()
                raise
            self._undo.enter_context(undone(partial(self._leave, failed=True)))

    def _make(self, header: LogHeader, manifest: Manifest) -> None:
        """Make folder, profiles, log, and then the manifest that vouches for them. Raises OSError, RecordingError."""
        self.folder.mkdir(parents=True, exist_ok=True)
        for name, content in self._contents.items():
            write_atomically(self.folder / plain_name(name, self.folder), content)
        files = {name: file_entry(self.folder / name) for name in self._contents}
        self.manifest = msgspec.structs.replace(manifest, files=files)
        last_ticks_bytes = LAST_TICKS * (frame_size(len(header.columns)) + MESSAGE_BYTES) + 2 * BLOCK_BYTES
        self._room_bytes = ROOM_BYTES + last_ticks_bytes
        free_room = partial(give_back, self.folder / MANIFEST, ROOM_BYTES)
        self.log = LogWriter(self.folder / LOG, header, free_room=free_room)
        try:
            self._write_first()  # which syncs the folder: a power cut may lose ticks, but no files
        except OSError:
            self.log.close()
            raise

    def announce(self, platforms: Iterable[str]) -> None:
        """Name the folders in which the session's other platforms will have their bundles, before the first tick.

        Raises:
            RecordingError: it cannot be written.
        """
        self._extend(platforms=dict.fromkeys(platforms, ""))

    def extend_provenance(self, provenance: Provenance) -> None:
        """Keep what has become known since the start, at once and before the first tick, so that no kill can lose it.

        Raises:
            RecordingError: it cannot be written.
        """
        self._extend(provenance=provenance)

    def _extend(self, **fields: Any) -> None:
        self.manifest = msgspec.structs.replace(self.manifest, **fields)
        try:
            with unbroken():
                self._write_first()
        except OSError as error:
            raise RecordingError(f"{self.folder}: cannot be recorded to: {error.strerror}") from None

    def _write_first(self) -> None:
        """Write an unfinished manifest, and reserve space for the next one. Raises OSError."""
        write_manifest(self.folder, self.manifest)
        reserve(self.folder / MANIFEST, self._room_bytes)

    def finish(self, summary: Mapping[str, Any], platforms: Mapping[str, str] | None = None) -> Manifest:
        """Close the log and write the manifest with its checksums; `summary` holds JSON values.

        `platforms` has the last hash of each of the session's other platforms, whose bundles are finished.

        Where the manifest cannot be written, the unfinished one stays, and the returned manifest says so. A folder that
        was removed during the drive is made again, with all that was recorded.
        """
        with contextlib.suppress(OSError):
            self._put_back()
        self.log.close()
        self.manifest = msgspec.structs.replace(
            self.manifest,
            ticks=self.log.ticks,
            digest=self.log.digest.hex(),
            recording_failure=self.log.failure,
            platforms=dict(platforms or self.manifest.platforms),
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
        for name, content in self._contents.items():
            if not (self.folder / name).exists():
                write_atomically(self.folder / name, content)

    def _log_entry(self) -> FileEntry:
        if self.log.sha256 is None or (self.folder / LOG).stat().st_size != self.log.size_bytes:
            return file_entry(self.folder / LOG)
        return FileEntry(size_bytes=self.log.size_bytes, sha256=self.log.sha256)

    def __enter__(self) -> "BundleWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with unbroken():
            self._leave(failed=error is not None)
        self._undo.close()

    def _leave(self, failed: bool) -> None:
        """Close the log, and remove everything if it has `failed` before the first tick. Twice is harmless."""
        self.log.close()
        if failed and self.log.ticks == 0:
            self._discard()
        with contextlib.suppress(OSError):
            draft_of(self.folder / MANIFEST).unlink(missing_ok=True)  # the space reserved for the final manifest

    def _discard(self) -> None:
        """Remove what was made. The folder was empty before, so that all in it belongs to this drive."""
        with contextlib.suppress(OSError):
            (self.folder / MANIFEST).unlink(missing_ok=True)  # first: it vouches for the others
            for path in self.folder.iterdir():
                path.unlink(missing_ok=True)
        for path in self._made:
            with contextlib.suppress(OSError):
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


def open_log(folder: Path, manifest: Manifest) -> Log:
    """Open the log in the form that the manifest lists; an unfinished drive has it unpacked.

    Raises:
        RecordingError: it is missing, or cannot be read.
    """
    return PackedLog(folder / PACKED_LOG) if PACKED_LOG in manifest.files else LogReader(folder / LOG)


def add_export(folder: Path, *names: str, instead_of: str | None = None) -> None:
    """List files made from the drive (report.html, scene.rrd), already in the folder, in its manifest.

    Args:
        folder: of the bundle.
        names: of the files.
        instead_of: the file whose place they take; it is removed, listed or not.

    Raises:
        RecordingError: no bundle, a signed one, or a file is not there.
    """
    manifest = read_manifest(folder)
    files = {name: entry for name, entry in manifest.files.items() if name != instead_of}
    name = MANIFEST
    try:
        for name in names:
            files[name] = msgspec.structs.replace(file_entry(folder / plain_name(name, folder)), export=True)
        if instead_of is not None:
            (folder / plain_name(instead_of, folder)).unlink(missing_ok=True)
        if files != manifest.files:
            write_manifest(folder, msgspec.structs.replace(manifest, files=files))
    except OSError as error:
        raise RecordingError(f"{folder / name}: cannot be added to {MANIFEST}: {error.strerror}") from None


def unlisted(folder: Path, manifest: Manifest) -> list[str]:
    """Return what lies in the folder and is not in the manifest, the manifest's own files apart.

    Of an unfinished drive that is neither its log nor a draft: these are there from the start.
    """
    found = sorted(path.name for path in folder.iterdir())
    if not manifest.finished:
        found = [name for name in found if name != LOG and not name.endswith(DRAFT)]
    known = {*manifest.files, *manifest.platforms, MANIFEST, SIGNATURE}
    return [name for name in found if name not in known]


def leftovers(manifest: Manifest) -> set[str]:
    """Return the names of files that a killed pack or unpack may have left: the other form of the log, drafts."""
    both = {LOG, PACKED_LOG, MANIFEST + DRAFT} if manifest.finished else set()
    return {name for name in (*both, LOG + DRAFT, PACKED_LOG + DRAFT) if name not in manifest.files}


def unfinished(folder: Path) -> str:
    """Return the line that says so of a bundle whose drive did not come to its end."""
    return f"{folder / MANIFEST}: the drive was not finished"


def alarm(log: Log) -> str | None:
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
