"""The manifest of a bundle: which files belong to it, how large they are, and what they hash to."""

from hashlib import sha256
from pathlib import Path
from typing import Any, Final

import msgspec

from simconsole.values.errors import RecordingError
from simconsole.values.host.files import write_atomically

SCHEMA: Final = 1
MANIFEST: Final = "manifest.json"
MAX_MANIFEST_BYTES: Final = 1 << 20
ROOM_BYTES: Final = 1 << 16
"""Reserved on the disk from the start of a drive, so that its end can be written even if the disk fills meanwhile."""


class FileEntry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One file of a bundle. An export is made from the rest and may be missing."""

    size_bytes: int
    sha256: str
    export: bool = False


class Manifest(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """manifest.json. Before the drive is finished it lists the profiles but not the log."""

    schema: int = SCHEMA
    finished: bool = False
    files: dict[str, FileEntry] = {}
    versions: dict[str, str] = {}
    labels: dict[str, str] = {}  # for people: wall time, machine; nothing that a replay needs
    ticks: int = 0
    digest: str = ""  # chained hash after the last tick, hexadecimal
    recording_failure: str | None = None
    summary: dict[str, Any] = {}  # figures of the session: lateness percentiles, counters


def read_manifest(folder: Path) -> Manifest:
    """Read manifest.json.

    Raises:
        RecordingError: missing, too large, not JSON, unknown keys, newer schema, a name that leaves the folder.
    """
    path = folder / MANIFEST
    try:
        if path.stat().st_size > MAX_MANIFEST_BYTES:
            raise RecordingError(f"{path}: {path.stat().st_size} bytes, allowed up to {MAX_MANIFEST_BYTES}")
        raw = msgspec.json.decode(path.read_bytes(), type=dict[str, Any])
        schema = raw.get("schema")
        if not isinstance(schema, int) or not 1 <= schema <= SCHEMA:
            raise RecordingError(f"{path}: schema: {schema!r} cannot be read, this simconsole reads 1 to {SCHEMA}")
        manifest = msgspec.convert(raw, Manifest)
    except OSError as error:
        raise RecordingError(f"{path}: not a bundle: {error.strerror}") from None
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise RecordingError(f"{path}: {error}") from None
    for name in manifest.files:
        plain_name(name, folder)
    return manifest


def plain_name(name: str, folder: Path) -> str:
    """Return `name` if it names a file right in a bundle.

    Raises:
        RecordingError: it could leave the folder, or is the manifest itself.
    """
    if not name or name in {".", "..", MANIFEST} or any(character in name for character in "/\\\0:"):
        raise RecordingError(f"{folder / MANIFEST}: files: {name!r} is not a plain file name")
    return name


def file_entry(path: Path) -> FileEntry:
    """Return size and checksum of a file as it is now. Raises OSError if it cannot be read."""
    digest, size = sha256(), 0
    with path.open("rb") as file:
        while part := file.read(1 << 20):
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
    """Replace manifest.json at once: a crash leaves the old one or the new one. Raises OSError."""
    text = _text(manifest)
    if manifest.recording_failure is not None and len(text) > ROOM_BYTES:
        text = _text(msgspec.structs.replace(manifest, summary={}))  # the reason matters more; its space is reserved
    write_atomically(folder / MANIFEST, text)


def _text(manifest: Manifest) -> bytes:
    return msgspec.json.format(msgspec.json.encode(manifest), indent=2) + b"\n"
