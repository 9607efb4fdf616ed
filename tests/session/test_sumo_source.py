"""SUMO as the traffic of a session: recorded as inputs, equal for equal seeds and back ends, replayed without SUMO."""

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.recording.log_header import SIGNALS
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.session.traffic_source import open_traffic
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.errors import ProfileError
from simconsole.values.host.jit import compiled
from simconsole.values.signals import Notice
from simconsole.values.state_vector import Snapshot
from simconsole.world.sumo_traffic import engines
from simconsole.world.sumo_traffic.engines import sumo_program
from tests.drives.console import results
from tests.ports import free_port
from tests.world.sumo_traffic.on_sumo import NET, configuration

Frames = tuple[list[bytes], list[bytes], list[Any]]


def session(seed: int = 1, duration_s: float = 6.0, **sumo: object) -> ResolvedSession:
    """The ball at the beginning of the urban course with signals, on SUMO."""
    world: dict[str, object] = {
        "world": "urban_signals",
        "traffic": {"seed": seed, "sumo": {"vehicles": 60, "pedestrians": 5, **sumo}},
    }
    return resolve(
        override(
            load_session("roll_a_ball"),
            environment=world,
            scenario={"duration_s": duration_s, "start": None},
            features={"autopilot": None},
            outputs={"bridge": None, "hud": None, "scene": None, "report": False},
            mode={"pacing": "free"},
        )
    )


def frames(folder: Path) -> Frames:
    log = open_bundle(folder).log
    return (
        [np.array(record.vector).tobytes() for record in log],
        [at.users.tobytes() for at in recorded_road_users(log)],
        list(log.messages(SIGNALS)),
    )


def test_equal_seeds_give_equal_drives_through_both_back_ends(tmp_path: Path) -> None:
    first = drive(session(), tmp_path / "first").folder
    again = drive(session(), tmp_path / "again").folder
    traci = drive(session(backend="traci"), tmp_path / "traci").folder
    other = drive(session(seed=2), tmp_path / "other").folder
    assert (first / "drive.log").read_bytes() == (again / "drive.log").read_bytes()
    assert frames(first) == frames(traci)
    assert open_bundle(first).manifest.digest == open_bundle(traci).manifest.digest
    assert frames(first)[1] != frames(other)[1]
    assert len(set(frames(first)[1])) > 100
    assert verify(first) == []


def test_replay_needs_no_sumo(tmp_path: Path) -> None:
    """In a process in which neither back end can be imported."""
    folder = drive(session(), tmp_path / "drive").folder
    program = (
        "import sys; sys.modules.update(libsumo=None, traci=None);"
        "from simconsole.cli.main import main; sys.exit(main(sys.argv[1:]))"
    )
    words = [sys.executable, "-c", program, "replay", str(folder), "--json"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert results(done)["hashes_equal"] is True


def test_own_configuration_beside_the_session_is_run(tmp_path: Path) -> None:
    routes = '<flow id="f" begin="0" end="60" period="2"><route edges="road0 road1 road2"/></flow>'
    configuration(tmp_path, routes)
    (tmp_path / "session.yaml").write_text(
        "schema: 1\nenvironment: {world: urban_signals, traffic: {sumo: {config: own.sumocfg}}}\n"
        "scenario: {vehicle: ball, duration_s: 2}\nfeatures: {autopilot: null}\n"
        "outputs: {hud: null, scene: null, report: false, bridge: null}\nmode: {pacing: free}\n"
        "devices: {driver: virtual}\n"
    )
    result = drive(resolve(load_session(str(tmp_path / "session.yaml"))), tmp_path / "bundle")
    assert result.summary["traffic"]["road_users"] >= 2
    assert result.summary["traffic"]["ego_error_m"] == 0.0
    assert "lost" not in result.summary["traffic"]


def test_sumo_that_waits_elsewhere_is_joined(tmp_path: Path) -> None:
    program = sumo_program()
    assert program is not None
    port = free_port()
    config = configuration(tmp_path, '<vehicle id="v" depart="0"><route edges="road0 road1"/></vehicle>')
    words = [program, "-c", config, "--step-length", "0.04", "--no-step-log", "true", "--remote-port", str(port)]
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as sumo:
        joined = session(duration_s=1.0, backend="traci", address=f"127.0.0.1:{port}", timeout_s=60.0)
        result = drive(joined, tmp_path / "bundle")
        assert result.summary["traffic"]["ego_error_m"] == 0.0
        sumo.wait()  # it ends with its last client
    assert NET.is_file()


@pytest.mark.parametrize("name", ["SIGKILL", "SIGSTOP"])
def test_drive_goes_on_and_says_so_when_sumo_fails(name: str) -> None:
    resolved = session(backend="traci", timeout_s=2.0, radius_m=1500.0)
    console, state = assemble(resolved, compiled)
    source = open_traffic(resolved, console)
    assert source is not None
    try:
        assert len(source.newest().users) > 10
        assert source.ahead().approach != 0.0, "SUMO's signals"
        process = source._traffic.process  # type: ignore[attr-defined]
        os.kill(process.pid, getattr(signal, name))
        for tick in range(1, 9):
            source.publish(Snapshot(tick, console.tick_hz, state.vector))
    finally:
        source.close()
    assert len(source.newest().users) == 0
    assert source.ahead().traffic_lost == 1.0
    assert source.ahead().approach == 0.0, "the map's own programs again"
    assert source.summary()["traffic"]["lost"]
    vector = state.vector.copy()
    vector[console.columns.index("ahead.traffic_lost")] = 1.0
    assert Snapshot(1, console.tick_hz, vector).notice == Notice.TRAFFIC_LOST


def test_what_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engines, "find_spec", lambda name: None)
    resolved = session()
    with pytest.raises(ProfileError, match=r"environment\.traffic\.sumo: value missing: libsumo, of the extra `sumo`"):
        open_traffic(resolved, assemble(resolved, compiled)[0])
