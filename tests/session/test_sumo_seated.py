"""Paced drives on SUMO: a worker of its own, signals that everybody shows, and what happens when it is gone."""

import json
import os
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.cdr import deserialize
from simconsole.processes.supervisor import STATUS
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session, replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.recording.exports.drive_topics import DriveTopics
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.session.lifecycle import DriveResult, drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.signals import Notice
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import running_signals
from tests.drives.console import Running
from tests.interop.programs import client, wait_for_port
from tests.patience import PATIENCE_S
from tests.ports import free_port
from tests.world.sumo_traffic.on_sumo import configuration
from tests.world.sumo_traffic.test_sumo_traffic import ACTUATED

HZ = 100
FAILS_AT = 2 * HZ
SESSION = """\
schema: 1
environment: {world: urban_signals, traffic: {seed: 1, sumo: SUMO}}
scenario: {vehicle: ball, duration_s: DURATION, start: START}
features: {autopilot: null}
outputs: {hud: null, scene: null, report: false, bridge: BRIDGE}
devices: {driver: "none"}
mode: {pacing: realtime, tick_hz: 100}
"""
THIRTY = "{vehicles: 30, radius_m: 1500, timeout_s: 0.5, backend: BACKEND}"


def session(folder: Path, sumo: str, duration_s: float, bridge: str = "null", start: str = "{x_m: 0}") -> Path:
    path = folder / "session.yaml"
    text = SESSION.replace("SUMO", sumo).replace("DURATION", f"{duration_s:g}").replace("BRIDGE", bridge)
    path.write_text(text.replace("START", start))
    return path


def driven(folder: Path, sumo: str, duration_s: float, watch: Callable[[Snapshot], bool] | None = None) -> DriveResult:
    return drive(resolve(load_session(str(session(folder, sumo, duration_s)))), folder / "bundle", watch)


def worker() -> int:
    """The process of SUMO's worker in a drive of this process."""
    (status,) = Path("/dev/shm").glob(f"simconsole-{os.getpid()}-*/{STATUS}")
    found: int = json.loads(status.read_bytes())["sumo"]["process_id"]
    return found


def child(process: int) -> int:
    """The program SUMO, which this worker has started."""
    return int(Path(f"/proc/{process}/task/{process}/children").read_text().split()[0])


@pytest.mark.parametrize("backend", ["libsumo", "traci"])
def test_a_paced_drive_has_sumos_traffic_and_replays_without(tmp_path: Path, backend: str) -> None:
    result = driven(tmp_path, THIRTY.replace("BACKEND", backend), 6.0)
    bundle = open_bundle(result.folder)
    steps = list(recorded_road_users(bundle.log))
    assert len(steps) > 100
    assert min(len(at.users) for at in steps) > 10
    assert len({at.users.tobytes() for at in steps}) > 50, "they move"
    assert all(at.signals for at in steps)
    assert result.summary["traffic"]["ego_error_m"] == 0.0
    assert "lost" not in result.summary["traffic"]
    assert (bundle.log.table().column("ahead.approach") != 0.0).all()
    assert replay_bundle(result.folder).hashes_equal
    assert verify(result.folder) == []


@pytest.mark.parametrize(
    ("backend", "whom", "name"),
    [
        ("libsumo", "worker", "SIGKILL"),
        ("libsumo", "worker", "SIGSTOP"),
        ("traci", "sumo", "SIGKILL"),
        ("traci", "sumo", "SIGSTOP"),
    ],
)
def test_the_drive_goes_on_without_a_sumo_that_is_gone_or_hangs(
    tmp_path: Path, backend: str, whom: str, name: str
) -> None:
    def watch(snapshot: Snapshot) -> bool:
        if snapshot.tick == FAILS_AT:
            os.kill(worker() if whom == "worker" else child(worker()), getattr(signal, name))
        return False

    result = driven(tmp_path, THIRTY.replace("BACKEND", backend), 4.0, watch)
    assert result.ticks == 4 * HZ
    bundle = open_bundle(result.folder)
    lost = bundle.log.table().column("ahead.traffic_lost")
    first = int(np.flatnonzero(lost)[0])
    assert first >= FAILS_AT - 1
    assert first <= FAILS_AT + HZ, "timeout_s is half a second of steps"
    assert lost[first:].all()
    steps = list(recorded_road_users(bundle.log))
    assert len(steps[0].users) > 10
    assert len(steps[-1].users) == 0
    assert not steps[-1].signals
    assert (bundle.log.table().column("ahead.approach")[first:] == 0.0).all(), "the map's own programs"
    assert result.summary["traffic"]["lost"]
    assert Snapshot(1, HZ, bundle.log.table().vectors[-1]).notice == Notice.TRAFFIC_LOST
    assert replay_bundle(result.folder).hashes_equal


def changes_s(message: Any) -> list[float]:
    """When the links of the light of ACTUATED change."""
    told = msgspec.to_builtins(message)
    return [left_s for one in told["signals"] if one["id"] == "junction0" for left_s in one["time_to_change"]]


def test_own_configuration_runs_and_its_signals_are_on_topics_and_in_exports(tmp_path: Path) -> None:
    """Its program of 13 s in the place of the map's, whose phases last longer."""
    flow = '<flow id="f" begin="0" end="60" period="2"><route edges="road0 road1 road2"/></flow>'
    configuration(tmp_path, flow, ACTUATED)
    port = free_port()
    path = session(tmp_path, "{config: own.sumocfg, warm_up_s: 0}", 60.0, f"{{port: {port}}}", "{x_m: 300}")
    with Running(tmp_path / "run", "drive", path, "--out", tmp_path / "bundle", "--no-pack") as running:
        wait_for_port(port)
        with client(f"ws://127.0.0.1:{port}") as web:
            web.say(op="subscribe", topic="/traffic_signals", type="simconsole_msgs/TrafficSignals")
            live = [changes_s(web.message("/traffic_signals")) for _ in range(15)]
        running.process.send_signal(signal.SIGINT)
        assert running.process.wait(PATIENCE_S) == 130
    assert max(map(max, live)) <= 10.0 + 0.1
    bundle = open_bundle(tmp_path / "bundle")
    resolved = recorded_session(bundle)
    topics = DriveTopics(resolved.session, signals=running_signals(resolved.world, HZ))
    registry = standard_registry()
    exported = [
        changes_s(deserialize(registry, message.type, message.data))
        for message in topics.messages(bundle.log)
        if message.topic == "/traffic_signals"
    ]
    assert max(map(max, exported)) <= 10.0 + 0.1
    assert len({tuple(one) for one in exported}) > 10
