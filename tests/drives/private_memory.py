"""Runs a command and looks at the memory that it and its children have for themselves."""

import subprocess
from pathlib import Path
from typing import NamedTuple

from tests.drives.console import Running
from tests.patience import pause

LOOK_S = 0.005


class Watched(NamedTuple):
    """A command that has ended, and the most that any process of it had for itself, in bytes."""

    done: "subprocess.CompletedProcess[str]"
    own: int
    children: int  # the largest of them; 0 without


def private_bytes(pid: int) -> int:
    """Return what belongs to a process alone (Private_Clean and Private_Dirty), 0 of one that has ended."""
    try:
        lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0
    return sum(1024 * int(line.split()[1]) for line in lines if line.startswith(("Private_Clean", "Private_Dirty")))


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
    own = largest = 0
    with Running(folder, *arguments) as running:
        while running.process.poll() is None:
            own = max(own, private_bytes(running.process.pid))
            largest = max([largest, *map(private_bytes, children(running.process.pid))])
            pause(LOOK_S)
        return Watched(running.end(), own, largest)
