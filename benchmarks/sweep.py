"""What a sweep costs beyond its drives: `python benchmarks/sweep.py [--drives N] [--rounds N] [--workers N] [--dask]`.

The same drives of 20 s at the same time: by `simconsole sweep` in so many workers, and in as many processes of which
each drives its share, one after the other, and nothing else. So what else the machine does slows both down alike. Once
with a tenth of the drives and once with all. Told is the processor time of whole process trees, starts included: what
each further drive costs (the bar), what begins and ends once, and the whole over that of a single process. With --dask
the sweep is driven by the workers of a scheduler that is started for it as docs/sweeps.md says, all their time
included; what the environment sets for Dask counts before that. The exit code is 1 where a further drive of a sweep
costs more than the bar allows.
"""

import argparse
import os
import re
import socket
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import NamedTuple

import yaml

from simconsole.processes.lifetimes import end_with_parent_thread

BAR = 1.10
SESSION = {
    "schema": 1,
    "environment": {"world": "urban"},
    "scenario": {"vehicle": "hatchback"},
    "outputs": {"bridge": None, "hud": None, "scene": None, "sound": None, "report": False},
    "devices": {"driver": "script:script.yaml"},
    "mode": {"pacing": "free"},
}
SCRIPT = {
    "points": [
        {"time_s": 0.0, "throttle": 0.0, "brake": 0.0, "clutch": 0.0, "hand_wheel_deg": 0.0, "gear": 0},
        {"time_s": 0.5, "clutch": 1.0},
        {"time_s": 1.0, "gear": 1, "throttle": 0.4, "clutch": 1.0},
        {"time_s": 3.0, "clutch": 0.0, "hand_wheel_deg": 0.0},
        {"time_s": 60.0, "hand_wheel_deg": 90.0, "throttle": 0.4},
    ],
}
ALONE = """\
import sys
from pathlib import Path
from simconsole.evaluation.sweep.plan import load_plan
from simconsole.evaluation.sweep.driving import drive_task
for task in load_plan(Path(sys.argv[1])).tasks[int(sys.argv[2])::int(sys.argv[3])]:
    assert drive_task(task).outcome == "driven"
"""

PAGE = Path(__file__).parents[1] / "docs" / "sweeps.md"
DASK = dict(re.findall(r"(DASK_\w+)=(\w+)", PAGE.read_text("utf-8")))
"""What it says to export for scheduler and workers."""
WAIT = """\
import sys
from distributed import Client
with Client(sys.argv[1]) as client:
    client.wait_for_workers(int(sys.argv[2]))
"""


class Cost(NamedTuple):
    """Processor time in s."""

    once_s: float
    drive_s: float  # of each further drive
    whole_s: float


def cost(few: int, few_s: float, many: int, many_s: float) -> Cost:
    """Return what drives cost, from the time of a few and of many."""
    drive_s = (many_s - few_s) / (many - few)
    return Cost(few_s - few * drive_s, drive_s, many_s)


def begun(*words: str) -> "subprocess.Popen[bytes]":
    """Start a program of Python, which ends with this one."""
    return subprocess.Popen(
        [sys.executable, *words],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**DASK, **os.environ},
        preexec_fn=end_with_parent_thread if sys.platform == "linux" else None,
    )


def cpu_s(process: "subprocess.Popen[bytes]", codes: Sequence[int] = (0,)) -> float:
    """Wait for a program; return the processor time of it and all its children in s."""
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in codes:
        raise SystemExit(f"{process.args!r}: code {process.returncode}")
    return used.ru_utime + used.ru_stime


def free_port() -> int:
    """Return a port that nobody listens at."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port: int = one.getsockname()[1]
    return port


def sweep_s(plan: Path, out: Path, workers: int) -> float:
    """Sweep in so many processes; return the processor time of all in s."""
    return cpu_s(begun("-m", "simconsole", "sweep", str(plan), "--jobs", str(workers), "--out", str(out)))


def dask_s(plan: Path, out: Path, workers: int) -> float:
    """Sweep on a scheduler and so many workers, all of them started for it; return the processor time of all in s."""
    url, dask = f"tcp://127.0.0.1:{free_port()}", ("-m", "distributed.cli.dask_worker")
    options = ("--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(out.parent))
    cluster = [begun("-m", "distributed.cli.dask_scheduler", "--host", url, "--no-dashboard")]
    cluster += [begun(*dask, url, *options) for _ in range(workers)]
    try:
        cpu_s(begun("-c", WAIT, url, str(workers)))  # not counted: nobody else needs it
        words = ("--engine", "dask", "--scheduler", url, "--out", str(out))
        spent_s = cpu_s(begun("-m", "simconsole", "sweep", str(plan), *words))
    finally:
        for process in cluster:  # what drove has ended with the sweep; a worker in order may wait for ever
            process.kill()
        spent = [cpu_s(process, range(-64, 256)) for process in cluster]
    return spent_s + sum(spent)


def turn(plan: Path, out: Path, workers: int, dask: bool) -> tuple[float, float]:
    """Drive a plan as a sweep, and at the same time in processes that only drive; return both times in s."""
    alone = [begun("-c", ALONE, str(plan), str(start), str(workers)) for start in range(workers)]
    swept_s = (dask_s if dask else sweep_s)(plan, out, workers)
    return swept_s, sum(map(cpu_s, alone))


def main() -> None:
    """Run the rounds and print; code 1 above the bar."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--drives", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--dask", action="store_true")
    options = parser.parse_args()
    drives, workers = options.drives, options.workers
    few, ratios, wholes = max(2 * workers, drives // 10), [], []
    with tempfile.TemporaryDirectory() as name:
        plans = {count: write_plan(Path(name) / str(count), count) for count in (few, drives)}
        cpu_s(begun("-c", ALONE, str(plans[few]), "0", str(few)))  # one drive, which compiles what is not compiled yet
        for number in range(options.rounds):
            times = [turn(plan, plan.parent / f"out-{number}", workers, options.dask) for plan in plans.values()]
            swept, alone = (cost(few, few_s, drives, many_s) for few_s, many_s in zip(*times, strict=True))
            one_s = alone.once_s / workers + drives * alone.drive_s
            ratios.append(swept.drive_s / alone.drive_s)
            wholes.append(swept.whole_s / one_s)
            print(
                f"a drive {1e3 * swept.drive_s:.0f} ms over {1e3 * alone.drive_s:.0f} ms: {ratios[-1]:.3f}; once "
                f"{swept.once_s:.1f} s over {alone.once_s / workers:.1f} s of one process; whole {swept.whole_s:.1f} s "
                f"over {one_s:.1f} s: {wholes[-1]:.3f}",
                flush=True,
            )
    print(f"each further drive: median {median(ratios):.3f}, {min(ratios):.3f} to {max(ratios):.3f}")
    print(f"{drives} drives with their starts: median {median(wholes):.3f}, {min(wholes):.3f} to {max(wholes):.3f}")
    if median(ratios) > BAR:
        raise SystemExit(f"above the bar of {BAR:g}")


def write_plan(folder: Path, drives: int) -> Path:
    """Write a plan of so many drives, and return its file."""
    folder.mkdir()
    (folder / "session.yaml").write_text(yaml.safe_dump(SESSION))
    (folder / "script.yaml").write_text(yaml.safe_dump(SCRIPT))
    values = {"environment.friction": {"from": 0.3, "to": 1.0, "count": drives}}
    plan = {"schema": 1, "sessions": ["session.yaml"], "duration_s": 20, "values": values}
    (folder / "plan.yaml").write_text(yaml.safe_dump(plan))
    return folder / "plan.yaml"


if __name__ == "__main__":
    main()
