"""P07 to P09: garbage, a soak, and a viewer that is frozen; in memory, counts and processor time."""

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.recording.bundles.verification import verify
from simconsole.session.worker_programs import SNAPSHOT_CAPACITY
from tests.drives.console import Running, results
from tests.faults.test_whole_drives import PERSON
from tests.patience import PATIENCE_S, wait_until
from tests.ports import free_port
from tests.samples import Measured, Sample
from tests.session.test_paced import TICK_HZ, drive

MIB = 1 << 20
GARBAGE_TICKS = 4000

# A person at the wheel for some ticks, and beside the loop somebody who makes garbage in circles: as much as is asked
# for, a share of it in each tick. Before the drives there is a heap that is costly to look through.
LITTERED = """
import gc, json, sys, time
from pathlib import Path
from simconsole.session.pacing import realtime_hints
from tests.faults.course import BY_HAND, circuit

track = circuit()
state = track.state_at(150.0)
heap = [[number, [number]] for number in range(500_000)]
EACH = [0] * 128

def resident():
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096

def cpu_of_a_full_collection():
    began_ns = time.process_time_ns()
    gc.collect()
    return time.process_time_ns() - began_ns

class Litter:
    def __init__(self, share):
        self.share, self.took_ns, self.collections, self.began_ns, self.last_ns = share, [], [], 0, 0

    def publish(self, snapshot):
        for _ in range(self.share):
            circle = list(EACH)
            circle[0] = circle
        now_ns = time.process_time_ns()
        self.took_ns.append(now_ns - self.last_ns)
        self.last_ns = now_ns

    def collected(self, phase, about):
        if phase == "start":
            self.began_ns = time.process_time_ns()
        else:
            self.collections.append((about["generation"], time.process_time_ns() - self.began_ns))

gc.collect()
whole_ns = min(cpu_of_a_full_collection() for _ in range(3))
for words in sys.argv[1:]:
    ticks, garbage_bytes = map(int, words.split(","))
    litter = Litter(garbage_bytes // ticks // sys.getsizeof(EACH))
    with realtime_hints():
        before = resident()
        frozen = gc.get_freeze_count()
        gc.callbacks.append(litter.collected)
        litter.last_ns = time.process_time_ns()
        driven = track.drive(state, ticks / 250, crew=BY_HAND, outputs=(litter,))
        gc.callbacks.remove(litter.collected)
    print(json.dumps({
        "frozen": frozen, "heap": 2 * len(heap), "whole_ns": whole_ns, "took_ns": litter.took_ns,
        "collections": litter.collections, "made": litter.share * ticks * sys.getsizeof(EACH),
        "grown": resident() - before, "modes": [int(mode) for mode in driven.modes],
    }))
"""


def littered(*drives: tuple[int, int]) -> list[dict[str, Any]]:
    """Drives of so many ticks with so many bytes of garbage, one after the other in one process."""
    words = [f"{ticks},{garbage_bytes}" for ticks, garbage_bytes in drives]
    done = subprocess.run([sys.executable, "-c", LITTERED, *words], capture_output=True, text=True, timeout=PATIENCE_S)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


@pytest.fixture(scope="module")
def beside_garbage() -> list[dict[str, Any]]:
    """A drive without garbage, then one with two gibibytes of it."""
    return littered((30 * TICK_HZ, 0), (GARBAGE_TICKS, 2 << 30))


@pytest.mark.fault("P07")
def test_p07_a_loop_that_makes_no_circles_is_never_stopped_by_a_full_collection(
    beside_garbage: list[dict[str, Any]], measured: Measured
) -> None:
    found = beside_garbage[0]
    full = [generation for generation, _ in found["collections"] if generation == 2]
    seen = f"{len(full)} full, {len(found['collections'])} in all"
    measured("P07", "collections in 7,500 ticks without garbage", seen, "no full one")
    assert not full
    assert len(found["modes"]) == 1


@pytest.mark.fault("P07")
def test_p07_two_gibibytes_of_garbage_do_not_hold_up_the_ticks(
    beside_garbage: list[dict[str, Any]], sample: Sample, measured: Measured
) -> None:
    """What was there before the drive is never looked at again: a collection costs what the garbage of it costs."""
    for number in range(sample.of(1, 10)):
        found = littered((GARBAGE_TICKS, 2 << 30))[0] if number else beside_garbage[1]
        assert found["made"] > 1.9 * (1 << 30)
        assert found["frozen"] > found["heap"]
        assert found["collections"], "the garbage was collected meanwhile"
        assert found["grown"] < 64 * MIB
        longest_ns = max(took_ns for _, took_ns in found["collections"])
        took_ms = np.array(found["took_ns"]) / 1e6
        p999_ms = float(np.percentile(took_ms, 99.9))
        seen = f"p99.9 {p999_ms:.2f} ms of CPU time, median {np.median(took_ms):.2f} ms"
        made_kib = found["made"] / GARBAGE_TICKS / 1024
        measured("P07", f"a tick that also makes {made_kib:.0f} KiB of garbage", seen, "5 ms")
        seen = f"{longest_ns / 1e6:.2f} ms; of the whole heap, not frozen, {found['whole_ns'] / 1e6:.0f} ms"
        measured("P07", "longest collection in the drive", seen, "a fifth of the latter")
        assert 5 * longest_ns < found["whole_ns"]
        assert p999_ms <= 5.0


SOAK = """\
schema: 1
environment: {world: urban}
scenario: {vehicle: hatchback}
features: {autopilot: urban}
outputs: {bridge: {port: PORT}, hud: null, scene: null, report: false}
devices: {driver: "script:person.yaml"}
mode: {pacing: lockstep}
"""


def resident_bytes(pid: int) -> int:
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def open_files(pid: int) -> int:
    return len(list(Path(f"/proc/{pid}/fd").iterdir()))


def children(pid: int) -> list[int]:
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


@contextmanager
def listening(url: str, parts: int, part_s: int) -> Iterator[Iterator[int]]:
    """Three who listen to odometry; yield each part of the simulated time that /clock has reached, up to the last."""
    with ExitStack() as stack:
        listeners = [stack.enter_context(BridgeClient(url)) for _ in range(4)]
        for listener in listeners[:3]:
            listener.subscribe("/odom", "nav_msgs/Odometry")
        clock = listeners[3]
        clock.subscribe("/clock", "rosgraph_msgs/Clock")
        ended = False

        def listen(listener: BridgeClient) -> None:
            while not ended:
                listener.receive(0.2)

        threads = [Thread(target=listen, args=(listener,)) for listener in listeners[:3]]
        for thread in threads:
            thread.start()

        def each_part() -> Iterator[int]:
            reached = 0
            while reached < parts:
                received = clock.receive(PATIENCE_S)
                assert received is not None, "the drive stands"
                part = received.message.clock.sec // part_s
                if part > reached:
                    reached = part
                    yield part

        try:
            yield each_part()
        finally:
            ended = True
            for thread in threads:
                thread.join()


@pytest.mark.fault("P08")
@pytest.mark.timeout(4 * 3600)
def test_p08_a_drive_of_eight_hours_takes_no_more_memory_than_its_first_minutes(
    tmp_path: Path, sample: Sample, measured: Measured
) -> None:
    """The program in lockstep with its autopilot and four clients, as fast as it goes; its log is cut meanwhile.

    Looked at each minute, after ten; the sample looks each ten seconds, in its second minute.
    """
    part_s, warm, parts = sample.of(10, 60), sample.of(6, 10), sample.of(12, 8 * 60)
    port, bundle = free_port(), tmp_path / "bundle"
    (tmp_path / "person.yaml").write_text(PERSON)
    (tmp_path / "session.yaml").write_text(SOAK.replace("PORT", str(port)))
    with Running(tmp_path, "drive", tmp_path / "session.yaml", "--out", bundle) as running:
        core = running.process.pid
        wait_until(lambda: running.process.poll() is not None or (bundle / "drive.log").exists(), "a log")
        held: list[tuple[list[int], list[int]]] = []
        with listening(f"ws://127.0.0.1:{port}", parts, part_s) as reached:
            for part in reached:
                os.truncate(bundle / "drive.log", 0)  # or it would fill the disk: 1.7 GB an hour
                if part >= warm:
                    family = [core, *children(core)]
                    held.append(([resident_bytes(pid) for pid in family], [open_files(pid) for pid in family]))
        for pid in children(core):
            os.kill(pid, signal.SIGKILL)
    shutil.rmtree(bundle)
    assert all(files == held[0][1] for _, files in held), "files stay open"
    resident = np.array([sizes for sizes, _ in held])
    assert resident.shape[1] >= 2, "console and autopilot"
    grown, hours = resident[-1] - resident[0], (parts - warm) * part_s / 3600.0
    seen = ", ".join(f"{size / MIB:+.2f} MiB" for size in grown.tolist()) + f" in {hours:.2f} simulated h"
    measured("P08", "resident memory of console and autopilot", seen, "at most 1 MiB an hour")
    assert (grown <= max(1.0, hours) * MIB).all(), resident.tolist()


FROZEN = """\
schema: 1
scenario: {vehicle: hatchback}
outputs: {bridge: null, hud: null, scene: {rate_hz: 50, flush_s: 0.2}, report: false}
devices:
  driver: virtual
  person: {title: sits, autonomy: {time_s: 3000}}
mode: {pacing: realtime, tick_hz: 250}
"""


FROZEN_TICKS = round(1.1 * SNAPSHOT_CAPACITY)


def core_ns(pid: int) -> int:
    """Processor time of the thread that ticks."""
    return int(Path(f"/proc/{pid}/task/{pid}/schedstat").read_text().split()[0])


@pytest.mark.fault("P09")
def test_p09_a_scene_that_is_frozen_costs_the_core_nothing_and_then_goes_on(tmp_path: Path, measured: Measured) -> None:
    """Stopped for longer than the ring holds. rerun's viewers read the file; they reach no process of ours."""
    with drive(tmp_path, FROZEN, "--no-pack") as driven:
        wait_until(lambda: driven.workers().keys() == {"scene"}, "the scene")
        live = driven.bundle / "scene.live.rrd"
        wait_until(lambda: live.exists() and driven.tick() > TICK_HZ, "a scene that records")
        scene = driven.workers()["scene"].process_id
        cost = {}
        for frozen in (False, True):
            if frozen:
                before = resident_bytes(scene)
                os.kill(scene, signal.SIGSTOP)
                size = live.stat().st_size
            tick, used_ns = driven.tick(), core_ns(driven.core)
            wait_until(lambda tick=tick: driven.tick() >= tick + FROZEN_TICKS, "the drive going on")  # type: ignore[misc]
            cost[frozen] = (core_ns(driven.core) - used_ns) / (driven.tick() - tick)
        assert live.stat().st_size == size, "frozen indeed"
        os.kill(scene, signal.SIGCONT)
        wait_until(lambda: live.stat().st_size > size, "the scene going on")
        grown = resident_bytes(scene) - before
        assert driven.workers()["scene"].process_id == scene, "the same one"
        os.kill(scene, signal.SIGSTOP)
        driven.running.interrupt_group()
        done = driven.running.end()
    assert done.returncode == 130, done.stderr
    assert results(done)["interrupted"] is True
    assert verify(driven.bundle) == []
    seen = f"{cost[True] / 1e3:.0f} us of CPU time, {cost[False] / 1e3:.0f} us beside a scene that runs"
    measured("P09", "a tick beside a frozen scene", seen, "at most twice the latter")
    measured("P09", "memory of a scene that was frozen", f"{grown / MIB:+.1f} MiB", "at most 16 MiB")
    assert cost[True] <= 2.0 * cost[False]
    assert grown <= 16 * MIB
