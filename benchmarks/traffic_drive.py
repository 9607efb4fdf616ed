"""How much slower a headless urban drive is among 30 vehicles than alone; both in one run, alternating.

Run: python benchmarks/traffic_drive.py [--seconds S] [--rounds N] [--vehicles N]

The same scripted drive on the urban course with signals, log included, on one core. Process CPU time: other programs
on the machine do not count.
"""

import argparse
import os
import statistics
import tempfile
import time
from pathlib import Path

import msgspec
from headless_drive import header

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.drivers.scripted_controller import ScriptedCommands
from simconsole.recording.bundles.log import LogWriter
from simconsole.recording.log_header import ROAD_USERS, message_stream
from simconsole.session.lifecycle import warm_up
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.recorder import LogRecorder
from simconsole.session.resolution import load_scenario, override, resolve
from simconsole.session.traffic_source import open_traffic
from simconsole.tick.assembly import assemble
from simconsole.tick.loop import Components, run
from simconsole.values.host.jit import compiled


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated seconds a round")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--vehicles", type=int, default=30)
    given = parser.parse_args()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    scenario, _ = load_scenario("hand_over")
    assert scenario.script is not None
    world: dict[str, object] = {"world": "urban_signals", "traffic": {"vehicles": given.vehicles}}
    resolved = resolve(override(scenario.session, environment=world, scenario={"start": None}))
    console, start = assemble(resolved, compiled)
    warm_up(console, start)
    ticks = round(given.seconds * console.tick_hz)
    cockpit = cockpit_settings(resolved.cockpit, console.tick_hz)
    streams = header(console.columns, console.tick_hz)
    streams = msgspec.structs.replace(streams, streams=(*streams.streams, message_stream(ROAD_USERS)))
    factors: dict[bool, list[float]] = {False: [], True: []}
    for number in range(2 * given.rounds):
        busy = bool(number % 2)
        traffic = open_traffic(resolved, console) if busy else None
        devices = ScriptSource(scenario.script, cockpit, tick_hz=console.tick_hz)
        commands = ScriptedCommands(scenario.remote, scenario.events, console.tick_hz)
        with tempfile.TemporaryDirectory() as folder, LogWriter(Path(folder) / "drive.log", streams) as log:
            outputs = () if traffic is None else (traffic,)
            components = Components(devices, commands, LogRecorder(log, list, traffic), outputs, UnpacedPacer())
            began = time.process_time()
            run(console, start, components, ticks)
            factors[busy].append(given.seconds / (time.process_time() - began))
    alone, among = (statistics.median(factors[busy]) for busy in (False, True))
    shares = [slow / fast for fast, slow in zip(factors[False], factors[True], strict=True)]
    print(f"{given.rounds} pairs of {given.seconds:g} s at {console.tick_hz} Hz, {given.vehicles} vehicles, one core:")
    print(f"  alone             {alone:7.1f} x real time")
    print(f"  among traffic     {among:7.1f} x real time   ({statistics.median(shares):.2f} of it alone)")


if __name__ == "__main__":
    main()
