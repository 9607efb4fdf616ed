"""Runs a command and looks at the memory that it and its children have for themselves."""

import subprocess
from pathlib import Path
from typing import NamedTuple

from tests.drives.console import Running
from tests.patience import pause

LOOK_S = 0.02
"""A look costs both processes time; what is kept stays to be seen."""


class Private(NamedTuple):
    """What processes have for themselves, in bytes."""

    all: int
    written: int
    """Without what is only read from files: that of a library counts while no other process has it loaded."""


class Watched(NamedTuple):
    """A command that has ended, and the most that it and the largest of its children had for themselves."""

    done: "subprocess.CompletedProcess[str]"
    own: Private
    child: Private


def private(pid: int) -> Private:
    """Return what belongs to a process alone; nothing of one that has ended."""
    try:
        lines = [line.split() for line in Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()[1:]]
    except OSError:
        return Private(0, 0)
    sizes = {line[0]: 1024 * int(line[1]) for line in lines}
    written = sizes.get("Private_Dirty:", 0)
    return Private(sizes.get("Private_Clean:", 0) + written, written)


def children(pid: int) -> list[int]:
    """Return the children that any thread of a process has started."""
    found: list[int] = []
    try:
        for thread in Path(f"/proc/{pid}/task").iterdir():
            found += map(int, (thread / "children").read_text().split())
    except OSError:  # it has ended
        pass
    return found


def watched(folder: Path, *arguments: object) -> Watched:
    """Run `simconsole` to its end, however long it takes."""
    own = child = Private(0, 0)
    with Running(folder, *arguments) as running:
        while running.process.poll() is None:
            own = _larger(own, private(running.process.pid))
            for pid in children(running.process.pid):
                child = _larger(child, private(pid))
            pause(LOOK_S)
        return Watched(running.end(), own, child)


def _larger(one: Private, other: Private) -> Private:
    return Private(max(one.all, other.all), max(one.written, other.written))
