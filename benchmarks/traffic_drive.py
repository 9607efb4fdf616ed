"""How much slower a headless urban drive is among 30 vehicles than alone; both in one run, alternating.

Run: python benchmarks/traffic_drive.py [--driver person|autopilot|script] [--seconds S] [--rounds N] [--vehicles N]

On the urban course with signals, log included, on one core: a simulated person drives it by hand, or the autopilot in
lockstep, or nobody looks at all and a script moves the pedals, of which 64 ticks are made at once: the fastest drive
there is, and the one that others on the road slow down most. Processor time, of the autopilot's process too: other
programs on the machine do not count.
"""

import argparse
import os
import statistics
import tempfile
from pathlib import Path

import msgspec
from headless_drive import header

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.drivers.scripted_controller import ScriptedCommands
from simconsole.recording.bundles.log import LogWriter
from simconsole.recording.log_header import ROAD_USERS, message_stream
from simconsole.session.lifecycle import drive, warm_up
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.recorder import LogRecorder
from simconsole.session.resolution import load_scenario, load_session, override, resolve
from simconsole.session.traffic_source import open_traffic
from simconsole.tick.assembly import assemble
from simconsole.tick.loop import Components, run
from simconsole.values.host.jit import compiled

WORLD = "urban_signals"
_DRIVERS = {
    "person": "devices: {driver: virtual, person: {sit_s: 0.5, along: route, seed: 1}}\nmode: {pacing: free}\n",
    "autopilot": f"features: {{autopilot: {WORLD}}}\nmode: {{pacing: lockstep}}\ndevices: {{driver: virtual, person: "
    "{sit_s: 0.5, cruise_kmh: 15, top_gear: 2, autonomy: {distance_m: 5}}}\n",
}


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--driver", choices=["person", "autopilot", "script"], default="person")
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated seconds a round")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--vehicles", type=int, default=30)
    given = parser.parse_args()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    measured = _scripted if given.driver == "script" else _driven
    factors: dict[bool, list[float]] = {False: [], True: []}
    for number in range(-2, 2 * given.rounds):  # the first pair compiles
        vehicles = given.vehicles if number % 2 else 0
        seconds = given.seconds if number >= 0 else 5.0
        busy_s = measured(given.driver, vehicles, seconds)
        if number >= 0:
            factors[vehicles > 0].append(seconds / busy_s)
    alone, among = (statistics.median(factors[busy]) for busy in (False, True))
    shares = [slow / fast for fast, slow in zip(factors[False], factors[True], strict=True)]
    print(f"{given.rounds} pairs of {given.seconds:g} s, {given.driver}, {given.vehicles} vehicles, one core:")
    print(f"  alone             {alone:7.1f} x real time")
    print(f"  among traffic     {among:7.1f} x real time   ({statistics.median(shares):.2f} of it alone)")


def _driven(driver: str, vehicles: int, seconds: float) -> float:
    """Return the processor time of a whole drive, beyond that of one that ends at once."""
    return _session(driver, vehicles, seconds + 1.0) - _session(driver, vehicles, 1.0)


def _session(driver: str, vehicles: int, seconds: float) -> float:
    traffic = f", traffic: {{vehicles: {vehicles}}}" if vehicles else ""
    bridge = "{port: 0}" if driver == "autopilot" else "null"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "session.yaml"
        path.write_text(
            f"schema: 1\nenvironment: {{world: {WORLD}{traffic}}}\n"
            f"scenario: {{vehicle: hatchback, duration_s: {seconds}}}\n"
            f"outputs: {{hud: null, scene: null, report: false, bridge: {bridge}}}\n{_DRIVERS[driver]}"
        )
        began = _busy_s()
        drive(resolve(load_session(str(path))), Path(folder) / "bundle")
        return _busy_s() - began


def _busy_s() -> float:
    """Return the processor time of this process and of those that it started and that have ended."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def _scripted(_driver: str, vehicles: int, seconds: float) -> float:
    scenario, _ = load_scenario("hand_over")
    assert scenario.script is not None
    world: dict[str, object] = {"world": WORLD} | ({"traffic": {"vehicles": vehicles}} if vehicles else {})
    resolved = resolve(override(scenario.session, environment=world, scenario={"start": None}))
    console, start = assemble(resolved, compiled)
    warm_up(console, start)
    streams = header(console.columns, console.tick_hz)
    streams = msgspec.structs.replace(streams, streams=(*streams.streams, message_stream(ROAD_USERS)))
    traffic = open_traffic(resolved, console)
    devices = ScriptSource(
        scenario.script, cockpit_settings(resolved.cockpit, console.tick_hz), tick_hz=console.tick_hz
    )
    commands = ScriptedCommands(scenario.remote, scenario.events, console.tick_hz)
    with tempfile.TemporaryDirectory() as folder, LogWriter(Path(folder) / "drive.log", streams) as log:
        outputs = () if traffic is None else (traffic,)
        components = Components(devices, commands, LogRecorder(log, list, traffic), outputs, UnpacedPacer())
        began = _busy_s()
        run(console, start, components, round(seconds * console.tick_hz))
        return _busy_s() - began


if __name__ == "__main__":
    main()
