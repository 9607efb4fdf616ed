"""What ten cars in one session cost, of what one does: processor time of the console, in alternation.

Run: python benchmarks/platforms.py [--pairs N] [--cars N] [--seconds S] [--free]

On the urban course, log included. In lockstep each car is driven by an autopilot of its own, in a process of its own,
which is not counted: only the console is. With --free nobody commands, and a script moves the pedals of each car: of
one alone 64 ticks are then made at once, of several those of a period, for they have to be told of each other.

Each pair is one car by the way of one (`lifecycle.drive`) and many by that of many (`fleet_drive.drive_fleet`), in
turns first, each in a new process. Printed are the drives alone, and the whole processes with their start. The interval
is that of the median's order statistics (benchmarks/two_trees.py).
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from two_trees import interval

from simconsole.session.fleet.fleet_drive import drive_fleet
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve

WORLD = "urban"
_HANDED_OVER = """schema: 1
points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 1.0, press: [autonomous]}
"""
_IN_FIRST_GEAR = """schema: 1
points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 0.5, clutch: 1}
  - {time_s: 0.7, gear: 1}
  - {time_s: 1.0, throttle: 0.1, clutch: 1}
  - {time_s: 4.0, clutch: 0, throttle: 0.05}
"""


def main() -> None:
    """Print the median ratio and its interval."""
    words = argparse.ArgumentParser()
    words.add_argument("--pairs", type=int, default=10)
    words.add_argument("--cars", type=int, default=10)
    words.add_argument("--seconds", type=float, default=30.0, help="simulated seconds a drive")
    words.add_argument("--free", action="store_true", help="without controllers")
    words.add_argument("--drive", action="store_true", help="drive once with --cars and print both processor times")
    given = words.parse_args()
    if given.drive:
        drive_s = cpu_s(given.cars, given.seconds, given.free)
        print(json.dumps([drive_s, time.process_time()]))
        return
    for cars in (1, given.cars):  # compiles
        in_new_process(cars, 3.0, given.free)
    ones: list[list[float]] = []
    manys: list[list[float]] = []
    for pair in range(given.pairs):
        order = (ones, 1), (manys, given.cars)
        for times, cars in order if pair % 2 else reversed(order):
            times.append(in_new_process(cars, given.seconds, given.free))
    how = "without controllers" if given.free else "in lockstep with autopilots"
    print(f"{given.seconds:g} s on {WORLD}, {how}, the console's processor time, medians of {given.pairs} pairs:")
    for place, what in enumerate(("drive", "whole process")):
        one, many = ([times[place] for times in all_times] for all_times in (ones, manys))
        ratios = sorted(of_many / of_one for of_many, of_one in zip(many, one, strict=True))
        low, high = interval(len(ratios))
        print(f"  {what}: 1 car {statistics.median(one):.2f} s, {given.cars} cars {statistics.median(many):.2f} s")
        print(f"    ratio {statistics.median(ratios):.2f} (95 % interval {ratios[low]:.2f} to {ratios[high]:.2f})")


def in_new_process(cars: int, seconds: float, free: bool) -> list[float]:
    """Return the processor time (s) of a drive of so many cars, and that of the process that has driven it."""
    words = [sys.executable, __file__, "--drive", "--cars", str(cars), "--seconds", str(seconds)]
    done = subprocess.run([*words, *(["--free"] if free else [])], stdout=subprocess.PIPE, check=True)
    drive_s, process_s = json.loads(done.stdout)
    return [float(drive_s), float(process_s)]


def cpu_s(cars: int, seconds: float, free: bool) -> float:
    """Return the processor time (s) that a drive of so many cars takes this process."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "session.yaml"
        (Path(folder) / "script.yaml").write_text(_IN_FIRST_GEAR if free else _HANDED_OVER)
        named = "".join(f"    - {{name: car_{n}, driver: 'script:script.yaml'}}\n" for n in range(cars))
        platforms = f"  platforms:\n{named}" if cars > 1 else ""
        path.write_text(
            f"schema: 1\nenvironment: {{world: {WORLD}}}\n"
            f"scenario:\n  vehicle: hatchback\n  duration_s: {seconds}\n{platforms}"
            f"features: {{autopilot: {'null' if free else WORLD}}}\n"
            "devices: {driver: 'script:script.yaml'}\n"
            f"outputs: {{hud: null, scene: null, report: false, bridge: {'null' if free else '{port: 0}'}}}\n"
            f"mode: {{pacing: {'free' if free else 'lockstep'}, answer_timeout_s: 60}}\n"
        )
        resolved = resolve(load_session(str(path)))
        began = os.times()
        driven = (drive_fleet if cars > 1 else drive)(resolved, Path(folder) / "bundle")
        ended = os.times()
        if driven.summary.get("unanswered"):
            raise SystemExit("an autopilot did not answer: no drive to compare")
        return ended.user + ended.system - began.user - began.system


if __name__ == "__main__":
    main()
