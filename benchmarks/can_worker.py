"""How much of a core the CAN worker needs: ten messages out at 100 Hz each, one command in at 50 Hz, log included.

Run: python benchmarks/can_worker.py [--for S] [--interface udp_multicast|virtual]

The worker is the paced drive's own loop (`canbus.worker.serve`) in this process, fed with a recorded row at 250 Hz;
the ECU is `simconsole can send` in a process of its own (on udp_multicast). The core's share is this process's CPU
time over wall time, start-up excluded. Beside it: the same loop with nothing to send, which is what waiting costs.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from simconsole.canbus.bus.port import CanPort
from simconsole.canbus.bus.worker import OnBus, load_codec, log_paths, serve
from simconsole.canbus.codec import CONSOLE
from simconsole.canbus.messages import BUILDERS
from simconsole.canbus.node import CanNode
from simconsole.canbus.schedule import Schedule
from simconsole.profiles.can import CanProfile
from simconsole.values.state_vector import PLATFORM_AT, Snapshot

TICK_HZ = 250
MESSAGES = 10


class TenMessages(CanNode):
    """The console's node with its messages repeated until they are ten, each at 100 Hz (or none at all)."""

    def __init__(self, profile: CanProfile, count: int) -> None:
        codec = load_codec()
        super().__init__(codec, profile, TICK_HZ, wheels=(0, 1, 2, 3))
        infos = (codec.sent_by(CONSOLE) * 2)[:count]
        assert {info.name for info in infos} <= set(BUILDERS)
        self._messages = infos
        self._counters = [0] * count
        self._schedule = Schedule([10] * count, TICK_HZ)


class Ticks:
    """A new snapshot every 4 ms of wall time."""

    def __init__(self) -> None:
        self._row = np.zeros(PLATFORM_AT)
        self._start_ns = time.monotonic_ns()
        self._seen = 0

    def __call__(self) -> Snapshot | None:
        tick = (time.monotonic_ns() - self._start_ns) * TICK_HZ // 1_000_000_000
        if tick == self._seen:
            return None
        self._seen = tick
        return Snapshot(tick, TICK_HZ, self._row)


def measure(profile: CanProfile, count: int, duration_s: float, folder: Path) -> dict[str, float]:
    """Return the worker's share of a core and what it did."""
    node = TenMessages(profile, count)
    port = CanPort(profile, node.transmit_ids, node.receive_ids, logs=log_paths(profile, folder))
    end_s = time.monotonic() + duration_s
    cpu_s, wall_s = time.process_time(), time.monotonic()
    serve(
        OnBus(node, port),
        Ticks(),
        lambda command, receipt_ns: None,
        lambda events: None,
        lambda status: None,
        lambda: time.monotonic() >= end_s,
    )
    cpu_s, wall_s = time.process_time() - cpu_s, time.monotonic() - wall_s
    port.close()
    return {
        "core_percent": round(100.0 * cpu_s / wall_s, 2),
        "sent_per_s": round(node.counters().sent / wall_s, 1),
        "commands_per_s": round(node.counters().accepted / wall_s, 1),
    }


def main() -> None:
    """Print one line for each case and one JSON object."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--for", dest="duration_s", type=float, default=10.0)
    parser.add_argument("--interface", default="udp_multicast", choices=("udp_multicast", "virtual"))
    options = parser.parse_args()
    profile = CanProfile(interface=options.interface, port=43_999)
    ecu = [sys.executable, "-m", "simconsole", "can", "send", "--port", str(profile.port)]
    results = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, count in (("idle", 0), ("ten_messages", MESSAGES)):
            other = subprocess.Popen(ecu, stdout=subprocess.DEVNULL) if options.interface == "udp_multicast" else None
            time.sleep(1.0)  # the ECU's start-up is not ours
            try:
                results[name] = measure(profile, count, options.duration_s, Path(folder))
            finally:
                if other is not None:
                    other.terminate()
                    other.wait()
            print(name, results[name], flush=True)
    print(json.dumps({"interface": options.interface, **results}))


if __name__ == "__main__":
    main()
