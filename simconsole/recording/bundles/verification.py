"""What can be said of a bundle without driving it again: is every byte of every file as the drive has left it?"""

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from simconsole.recording.bundles.bundle import (
    LOG,
    SESSION_FILE,
    Log,
    alarm,
    leftovers,
    open_log,
    session_problem,
    unfinished,
    unlisted,
)
from simconsole.recording.bundles.manifest import (
    MANIFEST,
    SIGNATURE,
    Manifest,
    checksum_problem,
    entry_of,
    parse_manifest,
    read_bounded,
    read_manifest,
    size_problem,
)
from simconsole.recording.bundles.packed_log import PackedLog
from simconsole.recording.bundles.signing import signature_problem, signed_by
from simconsole.recording.chains import Chains
from simconsole.values.errors import RecordingError


class Examination(NamedTuple):
    """What was found, one line each: what is wrong, and what is worth knowing."""

    problems: list[str]
    remarks: list[str]


class Coverage(NamedTuple):
    """Names of a bundle's files: those whose every byte a good replay vouches for, and the others."""

    replayed: list[str]
    others: list[str]


def verify(folder: Path) -> list[str]:
    """Check every byte of every file; return one line for each problem, none if all is well.

    Raises:
        RecordingError: the folder has no manifest that can be read, or one that was changed.
    """
    return examine(folder).problems


def examine(folder: Path, signer: Path | None = None) -> Examination:
    """Check every byte of every file: sizes, checksums, records, chained hashes, the manifest, its signature.

    Args:
        folder: of the bundle.
        signer: file of the public key that must have signed it; None: a signature is checked if there is one, with
            the key that it names itself.

    Raises:
        RecordingError: the folder has no manifest that can be read, or one that was changed; no such key.
    """
    content = read_bounded(folder / MANIFEST)
    manifest = parse_manifest(folder, content)
    problems = [] if manifest.finished else [unfinished(folder)]
    if manifest.recording_failure:
        problems.append(manifest.recording_failure)
    for name, entry in manifest.files.items():
        if problem := size_problem(folder / name, entry) or checksum_problem(folder / name, entry):
            problems.append(problem)
    try:
        problems += log_problems(open_log(folder, manifest), manifest)
    except RecordingError as error:
        problems.append(str(error))
    problems += platform_problems(folder, manifest)
    left = leftovers(manifest)
    names = unlisted(folder, manifest)
    strays = [f"{folder / name}: not in {MANIFEST}: nothing vouches for it" for name in names if name not in left]
    remarks = [] if manifest.finished else list(strays)  # as workers of a drive that was killed leave them
    remarks += [f"{folder / name}: left by a pack or unpack that was killed" for name in names if name in left]
    problems += strays if manifest.finished else []
    signed = (folder / SIGNATURE).exists()
    if signed or signer is not None:
        if problem := signature_problem(folder, content, signer):
            problems.append(problem)
        else:
            remarks.append(signed_by(folder, signer))
    elif not manifest.vouches_for_itself:
        remarks.append(
            f"{folder / MANIFEST}: schema 1, which does not vouch for itself: changes in its own figures go unnoticed"
        )
    return Examination(problems, [*remarks, *inexact(folder, manifest)])


def inexact(folder: Path, manifest: Manifest) -> list[str]:
    """Return that nobody can say whether a drive is the same to the bit elsewhere, one line where that is so."""
    if manifest.summary.get("bit_exact", True):
        return []
    return [f"{folder}: not bit-exact: its vehicle is foreign machine code; on another machine hashes may differ"]


def platform_problems(folder: Path, manifest: Manifest) -> Iterator[str]:
    """Yield what is wrong with the bundles of the session's other platforms."""
    for name, digest in manifest.platforms.items():
        try:
            problems = examine(folder / name).problems
            found = read_manifest(folder / name).digest
        except RecordingError as error:
            yield str(error)
            continue
        yield from problems
        if manifest.finished and found != digest:
            yield f"{folder / name}: hash {found}, {folder / MANIFEST} says {digest}"


def coverage(folder: Path) -> Coverage:
    """Say which files a replay reads and compares whole, and for which files of the folder it says nothing.

    Raises:
        RecordingError: the folder has no manifest that can be read, or one that was changed.
    """
    manifest = read_manifest(folder)
    files = manifest.files if manifest.finished else {**manifest.files, LOG: None}
    replayed = sorted(name for name, entry in files.items() if entry is None or not entry.export)
    return Coverage(replayed, sorted(path.name for path in folder.iterdir() if path.name not in replayed))


def log_problems(log: Log, manifest: Manifest) -> Iterator[str]:
    """Yield one line for each way in which the log is not the one that `manifest` tells of, after a pass over it."""
    chains, ticks = Chains(log.header), 0
    for record in log:
        chains.follow(record)
        ticks += 1
    session = log.path.parent / SESSION_FILE
    if SESSION_FILE in manifest.files:
        with suppress(OSError, UnicodeDecodeError):  # named with the other files
            if problem := session_problem(session, session.read_text("utf-8"), log.header):
                yield problem
    if manifest.recording_failure is None and (said := alarm(log)):
        yield said
    yield from (f"{log.path}: {part}" for part in log.breaks)
    yield from (f"{log.path}: {problem}" for problem in chains.problems())
    found, stated = f"{ticks} ticks, hash {chains.digest.hex()}", f"{manifest.ticks} ticks, hash {manifest.digest}"
    if manifest.finished and found != stated:
        yield f"{log.path}: {found}, {MANIFEST} says {stated}"
    if isinstance(log, PackedLog) and not log.breaks and entry_of(log.log_bytes()) != manifest.packed_log:
        yield f"{log.path}: does not give back the {LOG} that {MANIFEST} tells of"
