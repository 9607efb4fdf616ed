"""Read a world's profile and the files of its map."""

import gzip
import hashlib
import zlib
from pathlib import Path
from typing import Any, Final

import msgspec

from simconsole.profiles.files.loader import MAX_DATA_BYTES, find, inside, read_bytes, read_text_of
from simconsole.profiles.strict_yaml import Plain, parse
from simconsole.profiles.validation import convert
from simconsole.profiles.world import KINDS, MapFile, RoadsProfile, WorldProfile
from simconsole.values.errors import ProfileError

MAX_MAP_BYTES: Final = 32 * 1024 * 1024
"""Of a map's text, uncompressed."""

_DIGITS: Final = 16  # of a hash in a name
_GZIP: Final = b"\x1f\x8b"


def load_world(name_or_path: str, *, referrer: Path | None = None) -> WorldProfile:
    """Return a world's profile, of whatever kind; of a road map with the whole names and the hashes of its files.

    Raises:
        ProfileError: the profile or a file that it names cannot be used; names file and key.
    """
    path = find("worlds", name_or_path, referrer=referrer)
    plain = with_kind(parse(read_text_of(path, MAX_DATA_BYTES), str(path)))
    profile: WorldProfile = convert(plain, WorldProfile, str(path))  # type: ignore[arg-type]  # a union
    if not isinstance(profile, RoadsProfile):
        return profile
    named = {key: _found(file, path) for key, file, _ in _files(profile)}
    return msgspec.structs.replace(profile, **named)


def with_kind(plain: Plain) -> Plain:
    """Return a world's plain values with its kind: files from before there were kinds describe a course."""
    return {"kind": KINDS[0], **plain} if isinstance(plain, dict) else plain


def read_map(file: MapFile) -> bytes:
    """Return the text of a file that `load_world` or a recorded drive has named, uncompressed.

    Raises:
        ProfileError: it cannot be read, is too large, or is another than was named.
    """
    path = Path(file.name)
    content = _uncompressed(read_bytes(path, MAX_MAP_BYTES), path)
    if file.sha256 is not None and hashlib.sha256(content).hexdigest() != file.sha256:
        raise ProfileError(f"{path}: file: value with another sha256: {file.sha256}")
    return content


def enclosed(profile: WorldProfile) -> tuple[WorldProfile, dict[str, bytes]]:
    """Return a world as a recorded drive has it, and the files to lie beside it: compressed, named by their hashes.

    Raises:
        ProfileError: as `read_map`.
    """
    if not isinstance(profile, RoadsProfile):
        return profile, {}
    files, named = {}, {}
    for key, file, ending in _files(profile):
        content = read_map(file)
        digest = hashlib.sha256(content).hexdigest()
        name = f"{key}.{digest[:_DIGITS]}.{ending}.xml.gz"
        files[name] = gzip.compress(content, mtime=0)
        named[key] = MapFile(name=name, sha256=digest)
    return msgspec.structs.replace(profile, **named), files


def located(profile: WorldProfile, folder: Path) -> WorldProfile:
    """Return a recorded drive's world with the whole names of its files, which lie in `folder`."""
    if not isinstance(profile, RoadsProfile):
        return profile
    named = {
        key: msgspec.structs.replace(file, name=str(folder.absolute() / Path(file.name).name))
        for key, file, _ in _files(profile)
    }
    return msgspec.structs.replace(profile, **named)


def _files(profile: RoadsProfile) -> list[tuple[str, MapFile, str]]:
    """Return the files of a map: key, file, and the ending of SUMO's name for it."""
    files = (("map", profile.map, "net"), ("polygons", profile.polygons, "poly"))
    return [(key, file, ending) for key, file, ending in files if file is not None]


def _found(file: MapFile, profile: Path) -> MapFile:
    path = inside("worlds", file.name, profile)
    content = _uncompressed(read_bytes(path, MAX_MAP_BYTES), path)
    return MapFile(name=str(path.absolute()), sha256=hashlib.sha256(content).hexdigest())


def _uncompressed(content: bytes, path: Path) -> bytes:
    if not content.startswith(_GZIP):
        return content
    stream: Any = zlib.decompressobj(wbits=31)
    try:
        text: bytes = stream.decompress(content, MAX_MAP_BYTES + 1)
    except zlib.error as error:
        raise ProfileError(f"{path}: file: value not gzip: {error}") from None
    if len(text) > MAX_MAP_BYTES:
        raise ProfileError(f"{path}: file: value larger than {MAX_MAP_BYTES} bytes: at most {MAX_MAP_BYTES} bytes")
    if not stream.eof:
        raise ProfileError(f"{path}: file: value cut off: a whole gzip file")
    return text
