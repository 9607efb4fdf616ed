"""What a sweep costs beyond its drives: `python benchmarks/sweep.py [--drives N] [--rounds N]`.

The same drives of 20 s in turns: by `simconsole sweep` in two processes of its own, and one after the other in a single
process that does nothing else. Told is the processor time of whole process trees over one another, starts included.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

import yaml

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
from simconsole.evaluation.sweep.task import drive_task
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


def main() -> None:
    """Run the rounds and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--drives", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=5)
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
        words = ("-m", "simconsole", "sweep", str(folder / "plan.yaml"), "--jobs", "2", "--out")
        for number in range(options.rounds):
            swept = cpu_s(*words, str(folder / str(number)))
            bare = cpu_s("-c", BARE, str(folder / "plan.yaml"))
            ratios.append(swept / bare)
            print(f"{swept:.1f} s over {bare:.1f} s: {ratios[-1]:.3f}")
    print(f"{options.drives} drives: median {median(ratios):.3f}, {min(ratios):.3f} to {max(ratios):.3f}")


if __name__ == "__main__":
    main()
