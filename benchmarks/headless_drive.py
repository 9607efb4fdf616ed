"""How many times faster than real time a headless drive runs on one core, log included, network excluded.

Run: python benchmarks/headless_drive.py [--seconds S] [--rounds N]

Rounds are interleaved with a baseline in the same process: a loop that writes rows of the same width to the same kind
of log and computes nothing. What the console itself costs is the difference.
"""

import argparse
import os
import statistics
import tempfile
import time
from pathlib import Path

import numpy as np

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.drivers.scripted_controller import ScriptedCommands
from simconsole.recording.bundles.log import LogWriter
from simconsole.recording.log_header import ACTS, LogHeader, message_stream, vector_stream
from simconsole.session.lifecycle import warm_up
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.recorder import LogRecorder
from simconsole.session.resolution import load_scenario, resolve
from simconsole.tick.assembly import assemble
from simconsole.tick.loop import Components, run
from simconsole.values.host.jit import compiled
from simconsole.values.state_vector import INPUT_WIDTH


def header(columns: tuple[str, ...], tick_hz: int) -> LogHeader:
    return LogHeader(
        tick_hz=tick_hz,
        streams=(vector_stream(columns, INPUT_WIDTH), message_stream(ACTS)),
        console_version="benchmark",
        source_sha256="",
        session_sha256="",
    )


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated seconds a round")
    parser.add_argument("--rounds", type=int, default=5)
    given = parser.parse_args()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    scenario, _ = load_scenario("hand_over")
    resolved = resolve(scenario.session)
    console, start = assemble(resolved, compiled)
    warm_up(console, start)
    ticks = round(given.seconds * console.tick_hz)
    cockpit = cockpit_settings(resolved.cockpit, console.tick_hz)
    assert scenario.script is not None
    factors, baselines = [], []
    for number in range(given.rounds):
        with tempfile.TemporaryDirectory() as folder:
            devices = ScriptSource(scenario.script, cockpit, tick_hz=console.tick_hz)
            commands = ScriptedCommands(scenario.remote, scenario.events, console.tick_hz)
            with LogWriter(Path(folder) / "drive.log", header(console.columns, console.tick_hz)) as log:
                began = time.perf_counter()
                run(console, start, Components(devices, commands, LogRecorder(log), (), UnpacedPacer()), ticks)
                factors.append(given.seconds / (time.perf_counter() - began))
            with LogWriter(Path(folder) / "base.log", header(console.columns, console.tick_hz)) as log:
                row = np.zeros(console.width)
                began = time.perf_counter()
                for tick in range(ticks):
                    log.append(tick, row)
                baselines.append(given.seconds / (time.perf_counter() - began))
        print(f"round {number + 1}: drive {factors[-1]:7.1f} x real time   log alone {baselines[-1]:8.1f} x")
    factor, baseline = statistics.median(factors), statistics.median(baselines)
    size = f"{console.tick_hz} Hz, {console.width} columns, one core"
    print(f"median of {given.rounds} rounds of {given.seconds:g} s at {size}:")
    print(f"  drive, log included  {factor:8.1f} x real time   ({1e6 / (factor * console.tick_hz):.1f} us a tick)")
    print(f"  log alone (baseline) {baseline:8.1f} x real time   ({1e6 / (baseline * console.tick_hz):.1f} us a tick)")


if __name__ == "__main__":
    main()
