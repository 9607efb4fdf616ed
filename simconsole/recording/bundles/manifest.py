"""The manifest of a bundle: which files belong to it, how large they are, what they hash to, and where it comes from.

It holds its own checksum (sealing.py), so that it vouches for itself too. Manifests of schema 1 had none.
"""

from collections.abc import Iterable
from hashlib import sha256
from pathlib import Path
from typing import Any, Final

import msgspec

from simconsole.recording.bundles.provenance import Provenance
from simconsole.recording.bundles.sealing import KEY, read_object, seal_problem, sealed
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import write_atomically

SCHEMA: Final = 2
MANIFEST: Final = "manifest.json"
SIGNATURE: Final = "signature.json"
MAX_MANIFEST_BYTES: Final = 1 << 20
ROOM_BYTES: Final = 1 << 16
"""Reserved on the disk from the start of a drive, so that its end can be written even if the disk fills meanwhile."""


class FileEntry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One file of a bundle. An export is made from the rest and may be missing."""

    size_bytes: int
    """Size of the file."""
    sha256: str
    """SHA-256 of the file's content, hexadecimal."""
    export: bool = False
    """The file is made from the others and may be missing."""


class Manifest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """manifest.json, to which sealing.py adds its own checksum.

    Before the drive is finished it lists the profiles but not the log.
    """

    schema: int = SCHEMA
    """Version of the manifest; 2 has a checksum of its own, 1 had none."""
    finished: bool = False
    """The drive has ended, and all of its files are listed."""
    files: dict[str, FileEntry] = {}
    """The bundle's files by name."""
    versions: dict[str, str] = {}
    """Versions of the packages that make the result."""
    provenance: Provenance = Provenance()
    """Where the drive comes from: who drove when, on what, with which code."""
    ticks: int = 0
    """How many ticks were driven."""
    digest: str = ""
    """Chained hash after the last tick, hexadecimal."""
    recording_failure: str | None = None
    """Why the recording broke off; `null` if it did not."""
    platforms: dict[str, str] = {}
    """Bundles of the session's other platforms: folder, and hash as of `digest`."""
    packed_log: FileEntry | None = None
    """The drive.log that drive.parquet stands for, and gives back; `null` if the log itself is there."""
    summary: dict[str, Any] = {}
    """Figures of the session: percentiles of lateness, counters."""

    @property
    def vouches_for_itself(self) -> bool:
        """Whether a change in the manifest itself would have been noticed; not so in schema 1."""
        return self.schema > 1


def read_manifest(folder: Path) -> Manifest:
    """Read manifest.json.

    Raises:
        RecordingError: missing, too large, not JSON, unknown keys, newer schema, changed since it was written, a name
            that leaves the folder.
    """
    return parse_manifest(folder, read_bounded(folder / MANIFEST))


def read_bounded(path: Path) -> bytes:
    """Return the content of manifest.json or signature.json.

    Raises:
        RecordingError: missing, or too large.
    """
    try:
        if path.stat().st_size > MAX_MANIFEST_BYTES:
            raise RecordingError(f"{path}: {path.stat().st_size} bytes, allowed up to {MAX_MANIFEST_BYTES}")
        return path.read_bytes()
    except OSError as error:
        raise RecordingError(f"{path}: not a bundle: {error.strerror}") from None


def parse_manifest(folder: Path, content: bytes) -> Manifest:
    """Return the manifest whose text is `content`.

    Raises:
        RecordingError: as `read_manifest`, but for the file itself.
    """
    path, raw = folder / MANIFEST, read_object(folder / MANIFEST, content)
    schema = raw.get("schema")
    if not isinstance(schema, int) or not 1 <= schema <= SCHEMA:
        raise RecordingError(f"{path}: schema: {schema!r} cannot be read, this simconsole reads 1 to {SCHEMA}")
    if schema == 1:
        raw.pop("labels", None)  # nothing was ever written there
    elif problem := seal_problem(path, content):
        raise RecordingError(problem)
    else:
        del raw[KEY]
    try:
        manifest = msgspec.convert(raw, Manifest)
    except (msgspec.MsgspecError, RecursionError) as error:
        raise RecordingError(f"{path}: {error}") from None
    for name in (*manifest.files, *manifest.platforms):
        plain_name(name, folder)
    return manifest


def plain_name(name: str, folder: Path) -> str:
    """Return `name` if it names a file right in a bundle.

    Raises:
        RecordingError: it could leave the folder, or is the manifest itself or its signature.
    """
    if not name or name in {".", "..", MANIFEST, SIGNATURE} or any(character in name for character in "/\\\0:"):
        raise RecordingError(f"{folder / MANIFEST}: files: {name!r} is not a plain file name")
    return name


def file_entry(path: Path) -> FileEntry:
    """Return size and checksum of a file as it is now. Raises OSError if it cannot be read."""
    with path.open("rb") as file:
        return entry_of(iter(lambda: file.read(1 << 20), b""))


def entry_of(parts: Iterable[bytes]) -> FileEntry:
    """Return size and checksum of a file that holds these parts in a row."""
    digest, size = sha256(), 0
    for part in parts:
        digest.update(part)
        size += len(part)
    return FileEntry(size_bytes=size, sha256=digest.hexdigest())


def size_problem(path: Path, entry: FileEntry) -> str | None:
    """Return one line if the file is missing or not of the listed size, else None."""
    try:
        size = path.stat().st_size
    except OSError as error:
        return f"{path}: listed in {MANIFEST}, cannot be read: {error.strerror}"
    if size < entry.size_bytes:
        return f"{path}: truncated, {size} of {entry.size_bytes} bytes"
    return f"{path}: {size} bytes, {MANIFEST} says {entry.size_bytes}" if size > entry.size_bytes else None


def checksum_problem(path: Path, entry: FileEntry) -> str | None:
    """Return one line if the file's content is not the listed one, else None."""
    try:
        found = file_entry(path).sha256
    except OSError as error:
        return f"{path}: cannot be read: {error.strerror}"
    return None if found == entry.sha256 else f"{path}: altered, sha256 {found}, {MANIFEST} says {entry.sha256}"


def write_manifest(folder: Path, manifest: Manifest) -> None:
    """Replace manifest.json at once: a crash leaves the old one or the new one. Raises OSError.

    Raises:
        RecordingError: the bundle is signed.
    """
    refuse_signed(folder)
    manifest = msgspec.structs.replace(manifest, schema=SCHEMA)
    text = sealed(manifest)
    if manifest.recording_failure is not None and len(text) > ROOM_BYTES:
        text = sealed(msgspec.structs.replace(manifest, summary={}))  # the reason matters more; its space is reserved
    write_atomically(folder / MANIFEST, text)


def refuse_signed(folder: Path) -> None:
    """Do nothing with a bundle that may still be changed.

    Raises:
        RecordingError: it is signed; any change would make its signature void.
    """
    if (folder / SIGNATURE).exists():
        raise RecordingError(
            f"{folder / SIGNATURE}: signed, so nothing of this bundle may change; take the signature away first: "
            f"simconsole sign {folder} --remove"
        )
