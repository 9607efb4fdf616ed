"""Round trips of a headless drive in lockstep with our own autopilot, over a real WebSocket; both processes count.

Run: python benchmarks/autopilot_lockstep.py [--seconds S]

Odometry out, the autopilot's command back, five ticks driven, all of it recorded. Processor time is that of this
process and of the autopilot's together, from after the engagement to the end, but for the time in which both only wait.
"""

import argparse
import os
import tempfile
import time
from pathlib import Path

from simconsole.bridge.transport.lockstep_server import LockstepBridge
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.files.loader import parse
from simconsole.profiles.session import SessionProfile
from simconsole.recording.bundles.log import LogWriter
from simconsole.recording.log_header import ACTS, LogHeader, message_stream, vector_stream
from simconsole.session.autopilot_program import start_autopilot
from simconsole.session.lifecycle import warm_up
from simconsole.session.lockstep import LockstepLink
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.recorder import LogRecorder
from simconsole.session.resolution import resolve
from simconsole.tick.assembly import assemble
from simconsole.tick.loop import Components, run
from simconsole.values.host.jit import compiled
from simconsole.values.protocols import NobodySeated
from simconsole.values.signals import Event, Mode
from simconsole.values.state_vector import INPUT_WIDTH, Snapshot

SESSION = """
schema: 1
environment: {world: urban}
scenario: {vehicle: hatchback}
features: {autopilot: urban, control: {person_required: false}}
outputs: {bridge: {port: 0}}
devices: {driver: none}
mode: {tick_hz: 250, pacing: lockstep}
"""
PERIOD_TICKS = 5
BEFORE_S = 1.0
DRIVE = "benchmark"


def cpu_s(process: int) -> float:
    """Return the processor time (s) of this process and another."""
    ticks = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[11:13]
    return time.process_time() + sum(map(int, ticks)) / os.sysconf("SC_CLK_TCK")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=120.0, help="simulated")
    given = parser.parse_args()
    session = parse(SESSION, SessionProfile, "session")
    resolved = resolve(session)
    console, state = assemble(resolved, compiled)
    warm_up(console, state)
    header = LogHeader(
        tick_hz=console.tick_hz,
        streams=(vector_stream(console.columns, INPUT_WIDTH), message_stream(ACTS)),
        console_version="benchmark",
        source_sha256="",
        session_sha256="",
    )
    profile = BridgeProfile(port=0)
    with tempfile.TemporaryDirectory() as folder, LogWriter(Path(folder) / "drive.log", header) as log:
        bridge = LockstepBridge(profile, odometry_hz=console.tick_hz / PERIOD_TICKS, drive=DRIVE)
        autopilot = start_autopilot(bridge.url, session, profile, DRIVE, None)
        if not bridge.wait_for_client(60.0):
            raise SystemExit("the autopilot did not come")
        link = LockstepLink(bridge, PERIOD_TICKS, 2.0)
        components = Components(NobodySeated(), link, LogRecorder(log, link.take_acts), (link,), UnpacedPacer())
        state = run(console, state, components, round(BEFORE_S * console.tick_hz))
        bridge.console.inputs.raise_events(int(Event.REQUEST_AUTONOMOUS))
        state = run(console, state, components, PERIOD_TICKS)
        exchanges, began_s, began_cpu_s = link.exchanges, time.perf_counter(), cpu_s(autopilot.pid)
        state = run(console, state, components, round(given.seconds * console.tick_hz))
        wall_s, used_s = time.perf_counter() - began_s, cpu_s(autopilot.pid) - began_cpu_s
        bridge.close()
        autopilot.wait()
    last = Snapshot(state.tick, console.tick_hz, state.vector)
    if last.arbitration.mode != Mode.AUTONOMOUS or link.unanswered:
        raise SystemExit(f"mode {last.arbitration.mode:g}, {link.unanswered} unanswered")
    count = link.exchanges - exchanges
    print(f"{count} round trips, {last.vehicle.distance_m:.0f} m, {given.seconds / wall_s:.1f} x real time")
    print(f"  {1e6 * used_s / count:.0f} us of CPU time each: {count / used_s:.0f} round trips per CPU second")
    print(f"  digest {log.digest.hex()}")


if __name__ == "__main__":
    main()
