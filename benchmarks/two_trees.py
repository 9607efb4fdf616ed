"""The same command on two checkouts in alternation: processor time of whole processes, new over old.

Run: python benchmarks/two_trees.py OLD NEW [--pairs N] -- ARGUMENTS OF PYTHON
For example: python benchmarks/two_trees.py ../before . -- benchmarks/headless_drive.py --rounds 1 --seconds 600

Each command runs in its checkout, which is also what it imports. Counted is user and system time of the process and of
the children it waited for, so that neither a busy machine nor a changing clock of the processor decides. The interval
is that of the median's order statistics: 95 % of all samples of such pairs have their true median in it.
"""

import argparse
import math
import os
import statistics
import subprocess
import sys
from pathlib import Path


def main() -> None:
    """Print the median ratio and its interval."""
    words = argparse.ArgumentParser()
    words.add_argument("old", type=Path)
    words.add_argument("new", type=Path)
    words.add_argument("--pairs", type=int, default=30)
    words.add_argument("command", nargs="+")
    given = words.parse_args()
    for tree in (given.old, given.new):  # compiles, and fills the caches of the disk
        cpu_s(tree, given.command)
    olds, news = [], []
    for pair in range(given.pairs):
        order = (olds, given.old), (news, given.new)
        for times, tree in order if pair % 2 else reversed(order):
            times.append(cpu_s(tree, given.command))
    ratios = sorted(new / old for new, old in zip(news, olds, strict=True))
    low, high = interval(len(ratios))
    print(" ".join(given.command))
    print(f"  old {statistics.median(olds):.2f} s, new {statistics.median(news):.2f} s of CPU time, medians")
    print(
        f"  new over old, median of {len(ratios)} pairs: {statistics.median(ratios):.3f} "
        f"(95 % interval {ratios[low]:.3f} to {ratios[high]:.3f})"
    )


def cpu_s(tree: Path, command: list[str]) -> float:
    """Return the processor time (s) of one run.

    Raises:
        SystemExit: it failed.
    """
    environment = {**os.environ, "PYTHONPATH": str(tree.resolve())}
    process = subprocess.Popen([sys.executable, *command], cwd=tree, env=environment, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{tree}: {' '.join(command)} ended with {process.returncode}")
    return usage.ru_utime + usage.ru_stime


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
