"""A paced drive with every output in a process of its own: what happens when one of them, or the core, is killed."""

import json
import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np
import pytest

from simconsole.processes.shared_memory import Ring
from simconsole.processes.supervisor import STATUS, WorkerStatus
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.recording.reading import LogTable
from simconsole.recording.recorded_plans import recorded_plans
from simconsole.session.paced import bridge_address, wait_for_can
from simconsole.session.worker_programs import ADDRESS, KEY_CODES, SNAPSHOTS, snapshot_of
from simconsole.values.errors import CanError
from simconsole.values.key_codes import Key
from simconsole.values.signals import Event, Mode, Reason
from simconsole.values.state_vector import Snapshot
from tests.drives.console import Running, results
from tests.faults.lives import holders, standard_input
from tests.patience import Stopwatch, wait_until
from tests.samples import Measured
from tests.scene.viewer.test_export import contents

TICK_HZ = 250
WORKERS = {"bridge", "hud", "scene", "sound"}
SESSION = """\
schema: 1
title: Every worker
environment: {world: urban}
scenario: {vehicle: hatchback}
features: {autopilot: urban}
outputs:
  bridge: {port: 0}
  hud: {width_px: 320, height_px: 240, rate_hz: 10}
  scene: {rate_hz: 5, flush_s: 0.2}
devices:
  driver: DRIVER
  person:
    {title: hands over early, sit_s: 0.3, cruise_kmh: 15, autonomy: {distance_m: 2},
     take_back: {distance_m: 2000}, stop: {distance_m: 2100}}
mode: {pacing: realtime, tick_hz: 250}
"""
PERSON = SESSION.replace("DRIVER", "virtual")
# Asks for autonomy again and again until a controller is there, and never takes back.
PASSENGER = SESSION.replace("DRIVER", "script:passenger.yaml")
ASKS = "points:\n  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}\n" + "".join(
    f"  - {{time_s: {time_s}, press: [autonomous]}}\n" for time_s in range(2, 120, 2)
)
PLAIN = """\
schema: 1
title: One worker
scenario: {vehicle: hatchback}
outputs: {bridge: {port: 0}, hud: null, scene: null, report: false}
devices:
  driver: virtual
  person: {title: sits, autonomy: {time_s: 3000}}
mode: {pacing: realtime, tick_hz: 250}
"""


class Drive:
    """A running drive, seen through its run folder, as any worker sees it."""

    def __init__(self, running: Running, bundle: Path) -> None:
        self.running = running
        self.bundle = bundle
        self.core = running.process.pid
        wait_until(lambda: self.ended() or self._folders(), "run folder")
        self.folder = self._folders()[0]
        wait_until(lambda: self.ended() or (self.folder / SNAPSHOTS).exists(), "ring")
        wait_until(lambda: self.ended() or self._ring() is not None, "ring's header")

    def ended(self) -> bool:
        code = self.running.process.poll()
        assert code is None, self.running.err.read_text()
        return False

    def _folders(self) -> list[Path]:
        return list(Path("/dev/shm").glob(f"simconsole-{self.core}-*"))

    def _ring(self) -> Ring | None:
        try:
            return Ring.open(self.folder / SNAPSHOTS)
        except Exception:  # noqa: BLE001  # its header is not written yet
            return None

    def now(self) -> Snapshot | None:
        record = Ring.open(self.folder / SNAPSHOTS).latest()
        return None if record is None else snapshot_of(record, TICK_HZ)

    def tick(self) -> int:
        self.ended()
        snapshot = self.now()
        return 0 if snapshot is None else snapshot.tick

    def mode(self) -> float:
        self.ended()
        snapshot = self.now()
        return -1.0 if snapshot is None else snapshot.arbitration.mode

    def speed_mps(self) -> float:
        snapshot = self.now()
        return 0.0 if snapshot is None else snapshot.vehicle.vx_mps

    def workers(self) -> dict[str, WorkerStatus]:
        self.ended()
        try:
            return msgspec.json.decode((self.folder / STATUS).read_bytes(), type=dict[str, WorkerStatus])
        except OSError:
            return {}

    def family(self) -> set[int]:
        """Every process of this drive but the core: supervisor, workers, autopilot."""
        found, parents = set[int](), {self.core}
        while parents:
            parents = {pid for pid, parent in processes().items() if parent in parents} - found
            found |= parents
        return found

    def kill_worker(self, name: str) -> None:
        """Kill one and wait until another runs in its place, while the drive goes on."""
        before, tick = self.workers()[name], self.tick()
        os.kill(before.process_id, signal.SIGKILL)

        def restarted() -> bool:
            now = self.workers()[name]
            return now.restarts > before.restarts and now.process_id not in (0, before.process_id)

        wait_until(restarted, f"{name} again")
        wait_until(lambda: self.tick() > tick + TICK_HZ // 5, "the drive going on")


def processes() -> dict[int, int]:
    """Every living process with its parent. One that has ended but was not waited for does not live."""
    found = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, parent = path.read_text().rpartition(")")[2].split()[:2]
        except OSError:
            continue  # ended meanwhile
        if state not in "ZX":
            found[int(path.parent.name)] = int(parent)
    return found


@contextmanager
def drive(folder: Path, text: str, *more: str) -> Iterator[Drive]:
    (folder / "passenger.yaml").write_text(ASKS)
    session, bundle = folder / "session.yaml", folder / "bundle"
    session.write_text(text)
    with Running(folder, "drive", session, "--out", bundle, "--json", *more) as running:
        try:
            yield Drive(running, bundle)
        except AssertionError as error:
            error.add_note(f"the drive said: {running.err.read_text('utf-8') or 'nothing'}")
            raise


class Disturbed(NamedTuple):
    """One drive in which every worker was killed once, ended by Ctrl-C."""

    family: set[int]
    folder: Path
    code: int
    bundle: Path
    results: dict[str, Any]
    errors: str
    table: LogTable


@pytest.fixture(scope="module")
def disturbed(tmp_path_factory: pytest.TempPathFactory) -> Disturbed:
    folder = tmp_path_factory.mktemp("disturbed")
    with drive(folder, PASSENGER, "--no-pack") as driven:
        wait_until(lambda: set(driven.workers()) == WORKERS, "all workers")
        wait_until(lambda: driven.mode() == Mode.AUTONOMOUS and driven.speed_mps() > 2.0, "autonomy at speed")
        family = driven.family()
        driven.kill_worker("bridge")
        driven.kill_worker("hud")
        driven.kill_worker("scene")
        driven.kill_worker("sound")
        wait_until(lambda: driven.mode() == Mode.STOPPED, "the safe stop")
        family |= driven.family()
        driven.running.interrupt_group()
        done = driven.running.end()
    table = open_bundle(driven.bundle).log.table()
    return Disturbed(family, driven.folder, done.returncode, driven.bundle, results(done), done.stderr, table)


@pytest.mark.fault("P10")
def test_each_killed_worker_is_restarted_and_the_drive_goes_on(disturbed: Disturbed) -> None:
    assert set(disturbed.results["worker_restarts"]) == WORKERS
    assert all(count >= 1 for count in disturbed.results["worker_restarts"].values())
    ticks = disturbed.table.ticks
    assert ticks.tolist() == list(range(1, len(ticks) + 1)), "no tick was lost"


def test_a_bridge_killed_in_autonomy_ends_in_a_recorded_safe_stop(disturbed: Disturbed) -> None:
    mode, reason = disturbed.table.column("arbitration.mode"), disturbed.table.column("arbitration.reason")
    stale = (mode == float(Mode.MINIMAL_RISK)) & (reason == float(Reason.COMMAND_STALE))
    # On a busy machine a command may have come late before the bridge was killed: the passenger asked again then.
    at = int((np.flatnonzero(np.diff(stale.astype(int)) > 0) + 1)[-1])
    received = disturbed.table.column("ros.sequence")
    assert received[at] == received[-2] > 0.0, "no command has come since"
    assert mode[at - 1] == Mode.AUTONOMOUS
    assert mode[-1] == Mode.STOPPED
    assert tuple(change["mode"] for change in disturbed.results["mode_changes"][-2:]) == ("SAFE STOP", "STOPPED")
    age = disturbed.table.column("ros.age_ticks")
    assert age[at] >= 0.2 * TICK_HZ > age[at - 1], "200 ms after the last command, not sooner and not later"
    assert disturbed.table.column("vehicle.vx_mps")[at] > 1.0
    assert abs(disturbed.table.column("vehicle.vx_mps")[-1]) < 0.1


@pytest.mark.fault("P11")
def test_ctrl_c_leaves_a_whole_bundle_and_code_130(disturbed: Disturbed) -> None:
    assert disturbed.code == 130
    assert disturbed.results["interrupted"] is True
    assert "Traceback" not in disturbed.errors
    assert verify(disturbed.bundle) == []
    assert {"report.html", "scene.rrd"} <= {path.name for path in disturbed.bundle.iterdir()}
    found = replay_bundle(disturbed.bundle)
    assert found.hashes_equal, found.differences
    ended = np.flatnonzero(disturbed.table.column("events.events").astype(int) & int(Event.END))
    assert ended.tolist() == [len(disturbed.table.ticks) - 1], "the vehicle stood already"


def test_what_the_autopilot_planned_is_recorded_and_shown(disturbed: Disturbed) -> None:
    plans = list(recorded_plans(open_bundle(disturbed.bundle).log))
    assert len(plans) > 5
    told_s = np.array([plan.t_ns for plan in plans]) / 1e9
    assert (np.diff(told_s) > 0.0).all()
    assert len(plans) <= 5.0 * (told_s[-1] - told_s[0]) + 2, "five in a second; each may be late by itself"
    ticks = disturbed.table.ticks
    x_m, y_m = (disturbed.table.column(f"vehicle.{axis}_m") for axis in "xy")
    for at_s, plan in zip(told_s, plans, strict=True):
        row = int(np.searchsorted(ticks, at_s * TICK_HZ))
        assert np.hypot(plan.places[0, 1] - x_m[row], plan.places[0, 2] - y_m[row]) < 5.0, "it begins where the car is"
    shown = contents(disturbed.bundle / "scene.rrd")
    assert shown["/world/path/plan"] >= 1 + len(plans)


def test_the_bundle_tells_the_latency_of_each_hop_in_all_processes(disturbed: Disturbed) -> None:
    hops = open_bundle(disturbed.bundle).manifest.summary["latency_us"]
    chain = ["device", "read", "take", "decide", "step", "force feedback", "record", "publish", "others"]
    assert list(hops)[: len(chain)] == chain
    assert {"receive, bridge", "receive, hud", "draw, hud"} <= set(hops)
    assert all(hop["count"] > 0 and hop["p50"] <= hop["p99"] <= hop["max"] for hop in hops.values())


def test_nothing_outlives_a_drive_that_was_interrupted(disturbed: Disturbed) -> None:
    assert len(disturbed.family) >= 6, "supervisor, four workers, autopilot"
    wait_until(lambda: not disturbed.family & set(processes()), "the end of every process")
    assert not disturbed.folder.exists()


@pytest.mark.fault("P02")
def test_nothing_outlives_a_core_that_was_killed(tmp_path: Path, measured: Measured) -> None:
    with drive(tmp_path, PERSON, "--no-pack") as driven:
        wait_until(lambda: set(driven.workers()) == WORKERS, "all workers")
        wait_until(lambda: len(driven.family()) >= 5 and driven.tick() > TICK_HZ, "a second of driving")
        family, tick, parents = driven.family(), driven.tick(), processes()
        # Why all of them end within ORPHAN_S of each other: the pipe that each one reads has no other end but this.
        assert [holders(standard_input(process)) for process in family] == [{parents[process]} for process in family]
        os.kill(driven.core, signal.SIGKILL)
        driven.running.process.wait()
        gone = Stopwatch()
        wait_until(lambda: not family & set(processes()), "the end of every process")
        gone.lap()
        measured("P02", "processes of a killed drive", f"gone within {gone.longest}", "1 s")
        wait_until(lambda: not driven.folder.exists(), "the end of the run folder")
        bundle = open_bundle(driven.bundle)
        assert not bundle.manifest.finished
        assert replay_bundle(driven.bundle).ticks >= tick, "every tick that was published had been recorded"


@pytest.mark.fault("P11")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])  # by SIGINT the one above ends
def test_a_signal_ends_the_drive_in_order(tmp_path: Path, number: signal.Signals) -> None:
    with drive(tmp_path, PLAIN, "--no-pack") as driven:
        wait_until(lambda: set(driven.workers()) == {"bridge"} and driven.tick() > 10, "driving")
        family = driven.family()
        os.kill(driven.core, number)
        done = driven.running.end()
        assert done.returncode == 130
        assert results(done)["interrupted"] is True
        assert verify(driven.bundle) == []
        assert not family & set(processes())
        assert not driven.folder.exists()
        assert json.loads((driven.bundle / "manifest.json").read_text())["finished"] is True


def test_closing_the_window_ends_the_drive_in_order(tmp_path: Path) -> None:
    with drive(tmp_path, PLAIN, "--no-pack") as driven:
        wait_until(lambda: set(driven.workers()) == {"bridge"} and driven.tick() > 10, "driving")
        keys = Ring.open(driven.folder / KEY_CODES, writable=True)  # this drive has no window that writes there
        keys.write(np.array([float(Key.END)]), 0)
        done = driven.running.end()
        assert done.returncode == 0, done.stderr
        assert results(done)["interrupted"] is False
        assert verify(driven.bundle) == []
        events = open_bundle(driven.bundle).log.table().column("events.events")
        assert int(events[-1]) & Event.END, "at rest, and the log says that somebody has ended it"


def test_a_worker_that_is_slow_is_not_taken_for_one_that_has_failed(tmp_path: Path) -> None:
    looks = iter(range(3))

    def alive() -> bool:
        if next(looks) == 2:
            (tmp_path / ADDRESS).write_text("ws://127.0.0.1:9090")
        return True

    assert bridge_address(tmp_path, alive) == "ws://127.0.0.1:9090"
    with pytest.raises(CanError, match=r"the CAN bus is not open within 0\.1 s"):
        wait_for_can(tmp_path, lambda: True, patience_s=0.1)
    with pytest.raises(CanError, match="the worker's own message stands above"):
        wait_for_can(tmp_path, lambda: False)
