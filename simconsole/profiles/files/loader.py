"""Find and read the YAML of profiles. The only way from a profile's name to a typed profile.

A bare name (`t500rs`) means the file of that kind which simconsole ships. A path (with a separator, or ending in
.yaml, .yml or .json) is a file that the user named on the command line. A reference from inside a profile gives
`referrer`: it must be a bare name or stay inside the referring file's folder, whatever symbolic links say.
"""

import re
from functools import cache
from pathlib import Path
from typing import Final, TypeVar

from simconsole.profiles import strict_yaml as profile_text
from simconsole.profiles import validation as profile_errors
from simconsole.profiles.strict_yaml import Plain, to_text
from simconsole.values.errors import ProfileError, near

__all__ = [
    "MAX_BYTES",
    "MAX_DATA_BYTES",
    "find",
    "inside",
    "load",
    "names",
    "parse",
    "profiles_folder",
    "read_beside",
    "read_bytes",
    "read_text",
    "read_text_of",
    "to_text",
]

T = TypeVar("T")

MAX_BYTES: Final = 256 * 1024
MAX_DATA_BYTES: Final = 16 * 1024 * 1024
"""Cap for world data (road maps), which are not typed by hand."""

_MAX_NAME: Final = 100
_MAX_REFERENCE: Final = 255
_SUFFIXES: Final = (".yaml", ".yml", ".json")
_NAME: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*")


@cache
def profiles_folder() -> Path:
    """Return the folder of the shipped profiles: inside the package when installed, else the checkout's `profiles/`.

    Raises:
        ProfileError: neither is there, so the installation is damaged.
    """
    package = Path(__file__).resolve().parents[2]
    for folder in (package / "_profiles", package.parent / "profiles"):
        if folder.is_dir():
            return folder
    raise ProfileError(f"{package / '_profiles'}: profiles: value missing: install simconsole again")


def names(kind: str) -> list[str]:
    """Return the bare names of the shipped profiles of this kind, sorted."""
    return sorted(path.stem for path in (profiles_folder() / kind).glob("*.yaml"))


def find(kind: str, name_or_path: str, *, referrer: Path | None = None) -> Path:
    """Return the file of a profile.

    Args:
        kind: the folder in `profiles/`: devices, vehicles, worlds, sessions or scenarios.
        name_or_path: a bare name, or a path.
        referrer: the profile that holds this reference; None when the user typed it.

    Raises:
        ProfileError: the name is refused or the file is not there. Nothing was opened.
    """
    shown = _shown(name_or_path)
    if "\0" in name_or_path or not name_or_path.isprintable() or not name_or_path:
        raise _refused(kind, shown, "printable text", referrer)
    if "/" not in name_or_path and "\\" not in name_or_path and not name_or_path.endswith(_SUFFIXES):
        return _shipped(kind, name_or_path, shown, referrer)
    if not name_or_path.endswith(_SUFFIXES):
        raise _refused(kind, shown, f"a name without / or a path that ends in {', '.join(_SUFFIXES)}", referrer)
    path = _inside(kind, name_or_path, shown, referrer) if referrer else Path(name_or_path).expanduser()
    if not _is_file(path):
        raise _refused(kind, shown, "a file that exists", referrer)
    return path


def load(
    kind: str, name_or_path: str, struct: type[T], *, referrer: Path | None = None, max_bytes: int = MAX_BYTES
) -> T:
    """Return the profile as `struct`, every value inside its bounds.

    Raises:
        ProfileError: one line, `FILE: KEY: value VALUE: what is allowed`.
    """
    path = find(kind, name_or_path, referrer=referrer)
    return parse(read_text_of(path, max_bytes), struct, str(path))


def parse(text: str, struct: type[T], origin: str) -> T:
    """Return a profile from its text, as `load` does; `origin` (a file name) opens every message.

    Raises:
        ProfileError: one line, as of `load`.
    """
    values: Plain = profile_text.parse(text, origin)
    return profile_errors.convert(values, struct, origin)


def read_text(kind: str, file_name: str, *, max_bytes: int = MAX_DATA_BYTES) -> str:
    """Return the text of a shipped file of this kind by its full name with suffix, `course.csv`.

    Raises:
        ProfileError: the name is refused, the file is not there, too big or not UTF-8.
    """
    if "." not in file_name:
        file_name += ".yaml"
    folder = profiles_folder() / kind
    path = folder / file_name
    allowed = len(file_name) <= _MAX_NAME and _NAME.fullmatch(file_name) is not None
    if not allowed or not _is_file(path) or not _stays_in(path, folder):
        raise _refused(kind, _shown(file_name), "a file that simconsole ships", None)
    return read_text_of(path, max_bytes)


def read_beside(kind: str, reference: str, referrer: Path, *, max_bytes: int = MAX_BYTES) -> str:
    """Return the text of a file that a profile names, which must lie in the profile's folder or below.

    Raises:
        ProfileError: the reference is refused, the file is not there, too big or not UTF-8.
    """
    return read_text_of(inside(kind, reference, referrer), max_bytes)


def inside(kind: str, reference: str, referrer: Path) -> Path:
    """Return the path of a file that a profile names, which must lie in the profile's folder or below.

    Raises:
        ProfileError: the reference is refused, or the file is not there.
    """
    shown = _shown(reference)
    if not reference or not reference.isprintable():
        raise _refused(kind, shown, "printable text", referrer)
    path = _inside(kind, reference, shown, referrer)
    if not _is_file(path):
        raise _refused(kind, shown, "a file that exists", referrer)
    return path


def _shipped(kind: str, name: str, shown: str, referrer: Path | None) -> Path:
    folder = profiles_folder() / kind
    path = folder / f"{name}.yaml"
    allowed = len(name) <= _MAX_NAME and _NAME.fullmatch(name) is not None
    if not allowed or not _is_file(path) or not _stays_in(path, folder):
        guess = near(name, names(kind))
        meant = f"did you mean {guess}? " if guess else ""
        known = ", ".join(names(kind)) or "none"
        raise _refused(kind, shown, f"{meant}one of {known}, or a path to a .yaml file", referrer)
    return path


def _inside(kind: str, reference: str, shown: str, referrer: Path) -> Path:
    folder = referrer.parent
    path = folder / reference
    if len(reference) > _MAX_REFERENCE or Path(reference).is_absolute() or not _stays_in(path, folder):
        raise _refused(kind, shown, f"a bare name or a file inside {folder}", referrer)
    return path


def _stays_in(path: Path, folder: Path) -> bool:
    try:
        return path.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError):  # a name too long for the file system; a loop of symbolic links
        return False


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:
        return False


def read_bytes(path: Path, max_bytes: int) -> bytes:
    """Return the content of a file that `find` or `inside` has found.

    Raises:
        ProfileError: it cannot be read, or is too big.
    """
    try:
        with path.open("rb") as file:
            content = file.read(max_bytes + 1)
    except OSError as error:
        raise ProfileError(f"{path}: file: {error.strerror}: a readable file") from error
    if len(content) > max_bytes:
        raise ProfileError(f"{path}: file: value larger than {max_bytes} bytes: at most {max_bytes} bytes")
    return content


def read_text_of(path: Path, max_bytes: int) -> str:
    """Return the text of a file that `find` or `inside` has found.

    Raises:
        ProfileError: it cannot be read, is too big or not UTF-8.
    """
    content = read_bytes(path, max_bytes)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ProfileError(f"{path}: file: value not UTF-8 at byte {error.start}: UTF-8 text") from error


def _refused(kind: str, shown: str, allowed: str, referrer: Path | None) -> ProfileError:
    origin = str(referrer) if referrer else "command line"
    return ProfileError(f"{origin}: {kind} profile: value {shown}: {allowed}")


def _shown(name: str) -> str:
    text = ascii(name)
    return text if len(text) <= 80 else f"{text[:77]}..."
