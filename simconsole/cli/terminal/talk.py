"""How much a command says beside its results (`--quiet`, `-v`), and in which colours."""

import os
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from enum import IntEnum
from typing import Final, TextIO

RED: Final = "31"
GREEN: Final = "32"
_VERDICTS: Final = (
    (re.compile(r"^(pass)\b|(every hash equal)", re.MULTILINE), GREEN),
    (re.compile(r"^(FAIL)\b|(RECORDING FAILED|\d+ fields differ)", re.MULTILINE), RED),
)


class Talk(IntEnum):
    """How much is said on standard error while a command works."""

    QUIET = 0
    """Nothing but errors."""
    USUAL = 1
    """What somebody has to know; progress, where there is a terminal."""
    VERBOSE = 2
    """Each step of the work and how long it took, without a terminal too; errors with their traceback."""


_level: Talk = Talk.USUAL


def level() -> Talk:
    """Return how much the command that runs may say."""
    return _level


@contextmanager
def talking(wanted: Talk) -> Iterator[None]:
    """Let the command in the block say so much."""
    global _level
    before, _level = _level, wanted
    try:
        yield
    finally:
        _level = before


def say(line: str) -> None:
    """Say a line on standard error, unless the command shall be quiet."""
    if _level is not Talk.QUIET:
        with suppress(OSError):  # the terminal was closed
            print(f"simconsole: {line}", file=sys.stderr, flush=True)


def coloured(text: str, stream: TextIO) -> str:
    """Return text with its verdicts in colour, where `stream` is a terminal that shows colours."""
    if shows_colours(stream):
        for verdict, colour in _VERDICTS:
            text = verdict.sub(painted(r"\g<0>", colour), text)
    return text


def shows_colours(stream: TextIO) -> bool:
    """Return whether a stream is a terminal with colours, whose user has not asked for none (no-color.org)."""
    return stream.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def painted(text: str, colour: str) -> str:
    """Return text in a colour of ECMA-48."""
    return f"\x1b[{colour}m{text}\x1b[0m"
