"""What a sweep costs beyond its drives: `python benchmarks/sweep.py [--drives N] [--rounds N]`.

The same drives of 20 s in turns: by `simconsole sweep` in two processes of its own, and one after the other in a single
process that does nothing else. Told is the processor time of whole process trees over one another, starts included.
With `--dask` the sweep is driven by two workers of a scheduler that is started for it, their time included. The exit
code is 1 where the median is above the bar.
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
    ratios = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "session.yaml").write_text(yaml.safe_dump(SESSION))
        (folder / "script.yaml").write_text(yaml.safe_dump(SCRIPT))
        friction = {"from": 0.3, "to": 1.0, "count": options.drives}
        plan = {
            "schema": 1,
            "sessions": ["session.yaml"],
            "duration_s": 20,
            "values": {"environment.friction": friction},
        }
        (folder / "plan.yaml").write_text(yaml.safe_dump(plan))
        where = () if options.dask else ("--jobs", "2")
        words = ("-m", "simconsole", "sweep", str(folder / "plan.yaml"), *where, "--out")
        for number in range(options.rounds):
            there = (*words, str(folder / str(number)))
            swept = on_dask(folder, *there) if options.dask else cpu_s(*there)
            bare = cpu_s("-c", BARE, str(folder / "plan.yaml"))
            ratios.append(swept / bare)
            print(f"{swept:.1f} s over {bare:.1f} s: {ratios[-1]:.3f}")
    print(f"{options.drives} drives: median {median(ratios):.3f}, {min(ratios):.3f} to {max(ratios):.3f}")
    if median(ratios) > BAR:
        raise SystemExit(f"above the bar of {BAR:g}")


if __name__ == "__main__":
    main()
