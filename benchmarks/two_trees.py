"""The same command on two checkouts in alternation: processor time of whole processes, new over old.

Run: python benchmarks/two_trees.py OLD NEW [--pairs N] [--figure PATTERN] -- ARGUMENTS OF PYTHON
For example: python benchmarks/two_trees.py ../before . -- benchmarks/headless_drive.py --rounds 1 --seconds 600

With --figure the number that a command prints is compared in the place of its processor time: the first group of the
regular expression. That leaves out what a process needs to start.

Each command runs in its checkout, which is also what it imports. Counted is user and system time of the process and of
the children it waited for, so that neither a busy machine nor a changing clock of the processor decides. The interval
is that of the median's order statistics: 95 % of all samples of such pairs have their true median in it.
"""

import argparse
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path


def main() -> None:
    """Print the median ratio and its interval."""
    words = argparse.ArgumentParser()
    words.add_argument("old", type=Path)
    words.add_argument("new", type=Path)
    words.add_argument("--pairs", type=int, default=30)
    words.add_argument("--figure", help="regular expression; its first group is the number to compare")
    words.add_argument("command", nargs="+")
    given = words.parse_args()
    for tree in (given.old, given.new):  # compiles, and fills the caches of the disk
        measured(tree, given.command, given.figure)
    olds: list[float] = []
    news: list[float] = []
    for pair in range(given.pairs):
        order = (olds, given.old), (news, given.new)
        for times, tree in order if pair % 2 else reversed(order):
            times.append(measured(tree, given.command, given.figure))
    ratios = sorted(new / old for new, old in zip(news, olds, strict=True))
    low, high = interval(len(ratios))
    print(" ".join(given.command))
    what = "s of CPU time" if given.figure is None else given.figure
    print(f"  old {statistics.median(olds):.2f}, new {statistics.median(news):.2f} {what}, medians")
    print(
        f"  new over old, median of {len(ratios)} pairs: {statistics.median(ratios):.3f} "
        f"(95 % interval {ratios[low]:.3f} to {ratios[high]:.3f})"
    )


def measured(tree: Path, command: list[str], figure: str | None) -> float:
    """Return the processor time (s) of one run, or the figure that it prints.

    Raises:
        SystemExit: it failed, or prints no such figure.
    """
    environment = {**os.environ, "PYTHONPATH": str(tree.resolve())}
    with tempfile.TemporaryFile("w+") as printed:
        process = subprocess.Popen([sys.executable, *command], cwd=tree, env=environment, stdout=printed)
        _, status, usage = os.wait4(process.pid, 0)
        printed.seek(0)
        text = printed.read()
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{tree}: {' '.join(command)} ended with {process.returncode}")
    if figure is None:
        return usage.ru_utime + usage.ru_stime
    found = re.search(figure, text)
    if found is None:
        raise SystemExit(f"{tree}: {' '.join(command)} prints no {figure}")
    return float(found[1])


def interval(count: int) -> tuple[int, int]:
    """Return the places, in a sorted sample of this size, of a 95 % interval of the median (binomial, no normality)."""
    covered, low = 1.0, 0
    while low < count // 2:
        covered -= 2.0 * math.comb(count, low) / 2.0**count
        if covered < 0.95:
            break
        low += 1
    low = max(0, low - 1)
    return low, count - 1 - low


if __name__ == "__main__":
    main()
