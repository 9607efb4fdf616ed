"""What viewers cost the tick loop: `python benchmarks/scene_beside_viewers.py`.

One seated drive with its scene, seen through its ring: when each tick was published, against its time. Without a
viewer, with two, with one that is frozen, and after one was killed, in turns within one run; told is the median
lateness of each, from the earliest tick of the whole run, and its ratio to that without. The server is fed as
`simconsole view` does.
"""

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from simconsole.processes.running_scene import scene_of
from simconsole.processes.shared_memory import Ring
from simconsole.scene.viewer.scene_server import SceneServer, quiet_environment, rerun_program
from simconsole.session.worker_programs import SNAPSHOTS

HZ = 250
PERIOD_NS = 1_000_000_000 // HZ
SESSION = """\
schema: 1
environment: {world: urban_signals, traffic: {vehicles: 30, parked: 0}}
scenario: {vehicle: hatchback}
outputs: {bridge: null, hud: null, scene: {rate_hz: 100}, report: false}
devices:
  driver: virtual
  person: {title: drives, sit_s: 1, cruise_kmh: 30, stop: {distance_m: 100000}}
mode: {pacing: realtime, tick_hz: 250}
"""
SETTLED_S = 3.0
BACKLOG_BYTES = 100_000
"""More at once is history, not what the drive has just added."""
PHASES = ("no viewer", "two viewers", "one frozen, one reads", "killed")


class Watch:
    """Reads when ticks were published."""

    def __init__(self, ring: Ring) -> None:
        self._ring, self._seen = ring, ring.newest
        self._first_ns: int | None = None

    def lateness_ns(self) -> list[int]:
        """Return how much later each new tick was published than its time says, up to a constant.

        After a stall ticks are left out for good: what comes then is later by whole periods, which are taken off.
        """
        records = self._ring.since(self._seen)
        if records:
            self._seen = records[-1].number
        late = [record.second_stamp - record.stamp * PERIOD_NS for record in records]
        if late and self._first_ns is None:
            self._first_ns = min(late)
        left_out = round((min(late) - self._first_ns) / PERIOD_NS) if late and self._first_ns is not None else 0
        return [each - left_out * PERIOD_NS for each in late]


def viewer(address: str) -> "subprocess.Popen[bytes]":
    """Join as a viewer does."""
    words = [str(rerun_program()), "--bind", "127.0.0.1", "--port", "auto", "--save", os.devnull, address]
    return subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=quiet_environment())


def main() -> None:
    """Print a line for each phase."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--phase", type=float, default=10.0, metavar="S")
    given = parser.parse_args()
    found: dict[str, list[float]] = {phase: [] for phase in PHASES}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "session.yaml").write_text(SESSION)
        words = [
            "-m",
            "simconsole",
            "drive",
            str(folder / "session.yaml"),
            "--out",
            str(folder / "bundle"),
            "--no-pack",
        ]
        core = subprocess.Popen([sys.executable, *words], stdout=subprocess.DEVNULL)
        try:
            while (scene := scene_of(folder / "bundle")) is None or not scene.path.exists():
                time.sleep(0.1)
            watch = Watch(Ring.open(scene.folder / SNAPSHOTS))
            for turn in range(given.rounds):
                for phase in (*PHASES[turn % len(PHASES) :], *PHASES[: turn % len(PHASES)]):
                    found[phase] += measured(phase, scene.path, watch, given.phase)
        finally:
            core.send_signal(signal.SIGINT)
            core.wait()
    earliest_ns = min(map(min, found.values()))
    without = np.median(found[PHASES[0]]) - earliest_ns
    for phase in PHASES:
        middle = np.median(found[phase]) - earliest_ns
        print(f"{phase}: median {middle / 1e3:.0f} us late, {middle / without:.2f} times (at most 1.1)")
    print(f"of {sum(map(len, found.values()))} ticks")


def settle(server: SceneServer | None) -> None:
    """Feed a server until all that there was has been fed, and SETTLED_S longer."""
    settled_s = time.monotonic()
    while time.monotonic() - settled_s < SETTLED_S:
        if server is not None and server.pump() > BACKLOG_BYTES:
            settled_s = time.monotonic()
        time.sleep(0.05)


def measured(phase: str, path: Path, watch: Watch, length_s: float) -> list[float]:
    """Return the lateness of the ticks of one phase, in ns, up to a constant that is one for the whole run."""
    server = None if phase == PHASES[0] else SceneServer(path)
    viewers = [] if server is None else [viewer(server.addresses.native) for _ in range(2)]
    try:
        settle(server)  # viewers join, and are served what was before
        if phase == PHASES[2]:
            viewers[0].send_signal(signal.SIGSTOP)
        if phase == PHASES[3]:
            for one in viewers:
                one.kill()
            settle(server)
        watch.lateness_ns()
        late: list[int] = []
        began_s = time.monotonic()
        while time.monotonic() - began_s < length_s:
            if server is not None:
                server.pump()
            late += watch.lateness_ns()
            time.sleep(0.05)
        return [float(each) for each in late]
    finally:
        for one in viewers:
            one.kill()
            one.wait()
        if server is not None:
            server.close()


if __name__ == "__main__":
    main()
