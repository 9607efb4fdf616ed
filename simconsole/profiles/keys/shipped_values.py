"""What shipped profiles have at a key."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from simconsole.profiles import strict_yaml
from simconsole.profiles.files.loader import MAX_DATA_BYTES, profiles_folder, read_text_of
from simconsole.profiles.keys.catalogue import Key, catalogue
from simconsole.profiles.keys.kinds import KINDS


class Example(NamedTuple):
    """A shipped profile that sets a key."""

    file: str  # below profiles/
    value: Any


def shipped_files(kind: str) -> list[Path]:
    """Return the shipped files of a kind, small ones first."""
    pattern = KINDS[kind].shipped
    found = profiles_folder().glob(pattern) if pattern else ()
    return sorted((path for path in found if _is_of(kind, path)), key=lambda path: (path.stat().st_size, path))


def example_of(key: Key) -> Example | None:
    """Return the smallest shipped profile that sets a key, at whatever place the key stands; None: none does."""
    for one in (key, *(one for one in catalogue() if one[2:5] == key[2:5] and one.name == key.name)):
        steps = one.path.split(".")[1:]
        for path in shipped_files(one.kind):
            text = read_text_of(path, MAX_DATA_BYTES)
            if f"{key.name}:" not in text:
                continue
            for value in _values(strict_yaml.parse(text, path.name), steps, key.where):
                return Example(path.relative_to(profiles_folder()).as_posix(), value)
    return None


def _is_of(kind: str, path: Path) -> bool:
    return path.name.endswith(".plan.yaml") == (kind == "plan")


def _values(values: Any, steps: list[str], tags: tuple[str, ...]) -> Iterator[Any]:
    """Yield what stands where the steps lead; the section of the last one is of one of the tags, if there are some."""
    if not steps:
        yield values
        return
    name, end = _step(steps[0])
    if not isinstance(values, dict) or name not in values:
        return
    if len(steps) == 1 and tags and not _is_one_of(values, tags):
        return
    inner = values[name]
    if end == "[]":
        inner = inner if isinstance(inner, list) else []
    elif end == "{}":
        inner = list(inner.values()) if isinstance(inner, dict) else []
    else:
        inner = [inner]
    for one in inner:
        yield from _values(one, steps[1:], tags)


def _is_one_of(section: dict[str, Any], tags: tuple[str, ...]) -> bool:
    """Return whether a section is of one of these kinds; a world that names none is a course."""
    named = {value for value in section.values() if isinstance(value, str)}
    return bool(set(tags) & named) or ("course" in tags and "kind" not in section)


def _step(step: str) -> tuple[str, str]:
    return (step[:-2], step[-2:]) if step.endswith(("[]", "{}")) else (step, "")
