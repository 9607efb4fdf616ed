"""Which scenarios are meant: by name, by file, all of a folder, and of these those that an expression selects."""

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from simconsole.values.errors import ProfileError

_WORD: Final = re.compile(r"\s*(\(|\)|[^\s()]+)")
_KEYS: Final = (re.compile(rb'^\s*"?session"?:', re.M), re.compile(rb'^\s*"?duration_s"?:', re.M))
"""What every scenario has, and no other profile."""
Selects = Callable[[str], bool]


def is_scenario(path: Path) -> bool:
    """Return whether a file looks like a scenario: by the keys that each must have, without reading it as one."""
    try:
        content = path.read_bytes()
    except OSError:
        return False
    return all(key.search(content) for key in _KEYS)


def selected(names: Sequence[str], expression: str | None = None) -> list[str]:
    """Return the scenarios of these names, files and folders, in order, each once.

    Args:
        names: a folder stands for the scenarios in it and below it.
        expression: words with `and`, `or`, `not` and brackets, as pytest's -k; a word is a part of the path.

    Raises:
        ProfileError: a folder without scenarios, an expression that cannot be read, or nothing is left.
    """
    found: dict[str, None] = {}
    for name in names:
        folder = Path(name)
        inside = (
            [str(path) for path in sorted(folder.rglob("*.yaml")) if is_scenario(path)] if folder.is_dir() else [name]
        )
        if not inside:
            raise ProfileError(f"{name}: no scenario in it: a folder with files that have session: and duration_s:")
        found.update(dict.fromkeys(inside))
    if expression is None:
        return list(found)
    selects = parsed(expression)
    left = [name for name in found if selects(name)]
    if not left:
        raise ProfileError(f"command line: -k: value {expression}: it selects none of {len(found)} scenarios")
    return left


def parsed(expression: str) -> Selects:
    """Return whether a name is selected by an expression.

    Raises:
        ProfileError: it cannot be read.
    """
    words = _WORD.findall(expression.lower())
    selects, rest = _either(words, expression)
    if rest:
        raise _unreadable(expression, rest[0])
    return selects


def _either(words: list[str], origin: str) -> tuple[Selects, list[str]]:
    one, rest = _both(words, origin)
    while rest and rest[0] == "or":
        other, rest = _both(rest[1:], origin)
        one = _joined(any, one, other)
    return one, rest


def _both(words: list[str], origin: str) -> tuple[Selects, list[str]]:
    one, rest = _single(words, origin)
    while rest and rest[0] == "and":
        other, rest = _single(rest[1:], origin)
        one = _joined(all, one, other)
    return one, rest


def _single(words: list[str], origin: str) -> tuple[Selects, list[str]]:
    if not words or words[0] in (")", "and", "or"):
        raise _unreadable(origin, words[0] if words else "its end")
    word, rest = words[0], words[1:]
    if word == "not":
        inner, rest = _single(rest, origin)
        return (lambda name: not inner(name)), rest
    if word == "(":
        inner, rest = _either(rest, origin)
        if not rest or rest[0] != ")":
            raise _unreadable(origin, rest[0] if rest else "its end")
        return inner, rest[1:]
    return (lambda name: word in name.lower()), rest


def _joined(how: Callable[[list[bool]], bool], one: Selects, other: Selects) -> Selects:
    return lambda name: how([one(name), other(name)])


def _unreadable(expression: str, word: str) -> ProfileError:
    return ProfileError(f"command line: -k: value {expression}: words with and, or, not and brackets; not {word} there")
