"""What a drive from Python costs beside the same drive from the command line, in processor time of whole processes.

Run: python benchmarks/python_api.py [--pairs N] [--seconds S]

Both drive the same session headless into a bundle that stays unpacked, without a report: one as `simconsole drive`, one
as `Session.run`. In the first comparison a script drives. In the second the command line plays the commands of an own
controller from a bag (`--commands`), tick for tick what the function answers in the run from Python. Counted is user
and system time of the process, in alternating pairs; the interval is that of the median's order statistics. The exit
code is 1 where the median is above the bar.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from two_trees import interval

BAR = 1.10
SCRIPT = """\
points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 0.3, clutch: 1, gear: 1}
  - {time_s: 0.6, clutch: 1, throttle: 0.3}
  - {time_s: 1.8, clutch: 0, throttle: 0.1, hand_wheel_deg: 0}
  - {time_s: 2.2, hand_wheel_deg: 10, throttle: 0.1, brake: 0}
"""
SESSION = "schema: 1\ndevices: {driver: 'script:script.yaml'}\noutputs: {hud: null, scene: null, report: false}\n"
SCRIPTED = "import sys, simconsole\nsimconsole.load(sys.argv[1]).run(duration_s=float(sys.argv[2]), out=sys.argv[3])\n"
OWN = """\
import sys, simconsole
def controller(seen):
    return simconsole.hold_speed(8.0, 0.02)
simconsole.load("bridge").run(controller, duration_s=float(sys.argv[2]), out=sys.argv[3])
"""


def cpu_s(*words: str) -> float:
    """Run a program to its end and return its user and system time in s."""
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{' '.join(words)}: exit code {process.returncode}")
    return usage.ru_utime + usage.ru_stime


def main() -> None:
    words = argparse.ArgumentParser()
    words.add_argument("--pairs", type=int, default=15)
    words.add_argument("--seconds", type=float, default=600.0, help="simulated, of each drive")
    given = words.parse_args()
    seconds = str(given.seconds)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "script.yaml").write_text(SCRIPT)
        session = folder / "session.yaml"
        session.write_text(SESSION)
        command = (sys.executable, "-m", "simconsole", "drive")
        by_hand = (*command, str(session), "--headless", "--no-pack", "--for", seconds, "--out")
        from_python = (sys.executable, "-c", SCRIPTED, str(session), seconds)
        ratios = [compare("script", folder, by_hand, from_python, given.pairs)]
        bag = own_bag(folder, seconds)
        by_bag = (*command, "bridge", "--headless", "--no-pack", "--commands", f"bag:{bag}", "--for", seconds, "--out")
        from_python = (sys.executable, "-c", OWN, "", seconds)
        ratios.append(compare("own controller", folder, by_bag, from_python, given.pairs))
    if max(ratios) > BAR:
        raise SystemExit(f"above the bar of {BAR:g}")


def own_bag(folder: Path, seconds: str) -> Path:
    """Return a bag with what the own controller commands."""
    bundle, bag = folder / "own", folder / "own.mcap"
    cpu_s(sys.executable, "-c", OWN, "", seconds, str(bundle))
    cpu_s(sys.executable, "-m", "simconsole", "export", str(bundle), "--to", "mcap", "--out", str(bag))
    return bag


def compare(title: str, folder: Path, cli: tuple[str, ...], api: tuple[str, ...], pairs: int) -> float:
    """Print and return the median ratio of the run from Python to that of the command line."""
    of_cli: list[float] = []
    of_api: list[float] = []
    for pair in range(pairs + 1):
        order = [(of_cli, cli), (of_api, api)]
        for times, program in order if pair % 2 else reversed(order):
            with tempfile.TemporaryDirectory(dir=folder) as out:
                times.append(cpu_s(*program, f"{out}/bundle"))
        if pair == 0:
            of_cli.clear()  # the first pair compiles, and fills the caches of the disk
            of_api.clear()
    ratios = sorted(new / old for new, old in zip(of_api, of_cli, strict=True))
    low, high = interval(len(ratios))
    print(f"{title}: command line {statistics.median(of_cli):.2f} s, Python {statistics.median(of_api):.2f} s of CPU")
    print(
        f"  Python over command line: median {statistics.median(ratios):.3f}, "
        f"95 % interval {ratios[low]:.3f} to {ratios[high]:.3f}"
    )
    return statistics.median(ratios)


if __name__ == "__main__":
    main()
