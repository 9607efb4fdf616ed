"""What a sweep costs beyond its drives: `python benchmarks/sweep.py [--drives N] [--rounds N] [--dask]`.

The same drives of 20 s in turns: by `simconsole sweep` in two processes of its own, and one after the other in a single
process that does nothing else, each once with a tenth of the drives and once with all. Told is the processor time of
whole process trees, starts included: what each further drive costs (the bar), what begins and ends once, and the whole.
With `--dask` the sweep is driven by two workers of a scheduler that is started for it, their time included. The exit
code is 1 where a further drive of a sweep costs more than the bar allows.
"""

import argparse
import os
import signal
import socket
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from typing import NamedTuple

import yaml

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
BARE = """\
import sys
from pathlib import Path
from simconsole.evaluation.sweep.plan import load_plan
from simconsole.evaluation.sweep.driving import drive_task
for task in load_plan(Path(sys.argv[1])).tasks:
    assert drive_task(task).outcome == "driven"
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


def cpu_s(*words: str) -> float:
    """Run a program of Python; return the processor time of it and all its children in s."""
    process = subprocess.Popen([sys.executable, *words], stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"{words}: code {os.waitstatus_to_exitcode(status)}")
    return used.ru_utime + used.ru_stime


def free_port() -> int:
    """Return a port that nobody listens at."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port: int = one.getsockname()[1]
    return port


def on_dask(folder: Path, *words: str) -> float:
    """Sweep on a scheduler and two workers, all of them started for it; return the processor time of all in s."""
    url = f"tcp://127.0.0.1:{free_port()}"
    workers = [["dask_worker", url, "--nthreads", "1", "--no-nanny", "--local-directory", str(folder)]] * 2
    begun = []
    for one in (["dask_scheduler", "--host", url], *workers):
        program = [sys.executable, "-m", f"distributed.cli.{one[0]}", *one[1:], "--no-dashboard"]
        begun.append(subprocess.Popen(program, stderr=subprocess.DEVNULL))
    try:
        spent = cpu_s(*words, "--engine", "dask", "--scheduler", url)
    finally:
        for process in begun:
            process.send_signal(signal.SIGINT)
        used = [os.wait4(process.pid, 0)[2] for process in begun]
    return spent + sum(each.ru_utime + each.ru_stime for each in used)


def main() -> None:
    """Run the rounds and print; code 1 above the bar."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--drives", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--dask", action="store_true")
    options = parser.parse_args()
    few, many = max(2, options.drives // 10), options.drives
    swept, bare = [], []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        plans = {count: write_plan(folder / str(count), count) for count in (few, many)}
        for number in range(options.rounds):
            times = {count: turn(plan, plan.parent / f"out-{number}", options.dask) for count, plan in plans.items()}
            swept.append(cost(few, times[few][0], many, times[many][0]))
            bare.append(cost(few, times[few][1], many, times[many][1]))
            print(told(swept[-1], bare[-1]), flush=True)
    ratios = [one.drive_s / other.drive_s for one, other in zip(swept, bare, strict=True)]
    wholes = [one.whole_s / other.whole_s for one, other in zip(swept, bare, strict=True)]
    print(f"each further drive: median {median(ratios):.3f}, {min(ratios):.3f} to {max(ratios):.3f}")
    print(f"{many} drives with their starts: median {median(wholes):.3f}, {min(wholes):.3f} to {max(wholes):.3f}")
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


def turn(plan: Path, out: Path, dask: bool) -> tuple[float, float]:
    """Drive a plan as a sweep and in a single process; return the processor time of both in s."""
    words = ("-m", "simconsole", "sweep", str(plan), *(() if dask else ("--jobs", "2")), "--out", str(out))
    return on_dask(out.parent, *words) if dask else cpu_s(*words), cpu_s("-c", BARE, str(plan))


def told(swept: Cost, bare: Cost) -> str:
    """Return one round as a line."""
    return (
        f"once {swept.once_s:.1f} s and {bare.once_s:.1f} s; a drive {1e3 * swept.drive_s:.0f} ms over "
        f"{1e3 * bare.drive_s:.0f} ms: {swept.drive_s / bare.drive_s:.3f}; whole {swept.whole_s:.1f} s over "
        f"{bare.whole_s:.1f} s: {swept.whole_s / bare.whole_s:.3f}"
    )


if __name__ == "__main__":
    main()
