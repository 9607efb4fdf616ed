"""A run from Python whose controller is a program of somebody else's: what the command line drives, to the bit."""

import json
from pathlib import Path

import numpy as np
import pytest

import simconsole
from tests.drives.console import results
from tests.drives.console import within as command_line
from tests.drives.controllers import Controller, command
from tests.patience import PATIENCE_S
from tests.ports import free_port

OUTPUTS = {"bridge": {"port": 0}, "hud": None, "scene": None, "report": False}
SESSION = {
    "schema": 1,
    "scenario": {"vehicle": "hatchback", "duration_s": 4},
    "features": {"control": {"person_required": False}},
    "outputs": OUTPUTS,
    "devices": {"driver": "none"},
    "mode": {"pacing": "lockstep"},
}
HANDS_OVER = [
    {"time_s": 0.0, "throttle": 0, "brake": 0, "clutch": 0, "hand_wheel_deg": 0, "gear": 0},
    {"time_s": 3.0, "brake": 0, "press": ["autonomous"]},
]
ASK = json.dumps({"op": "publish", "topic": "/console/request", "msg": {"data": "autonomous"}})


def answer(count: int, stamp: dict[str, int]) -> list[str]:
    """Ask for the car at once and again until it is had, accelerate, and steer to and fro."""
    asks = [ASK] if count in (30, 60) else []
    return [*asks, json.dumps(command(stamp, 1.2, 0.02 * np.sin(count / 20.0)))]


@pytest.fixture
def listening(tmp_path: Path) -> tuple[Path, Controller]:
    """A session, and a client that will connect to it."""
    port = free_port()
    path = tmp_path / "session.yaml"
    path.write_text(json.dumps({**SESSION, "outputs": {**OUTPUTS, "bridge": {"port": port}}}))
    return path, Controller(port, answer)


def test_a_client_drives_a_run_from_python_as_it_drives_the_command_line(
    listening: tuple[Path, Controller], tmp_path: Path
) -> None:
    path, first = listening
    first.start()
    drive = simconsole.load(path).run(out=tmp_path / "python")
    first.join(PATIENCE_S)
    second = Controller(json.loads(path.read_text())["outputs"]["bridge"]["port"], answer)
    second.start()
    done = command_line("drive", path, "--headless", "--no-pack", "--out", tmp_path / "words", "--json")
    second.join(PATIENCE_S)
    assert done.returncode == 0, done.stderr
    assert results(done)["digest"] == drive.digest
    assert first.odometry == second.odometry == 200
    assert drive.column("vehicle.vx_mps")[-1] > 1.0
    assert abs(drive.column("vehicle.yaw_rad")).max() > 1e-4
    assert drive.replay().hashes_equal


def test_our_autopilot_drives_a_run_from_python_as_it_drives_the_command_line(tmp_path: Path) -> None:
    (tmp_path / "person.yaml").write_text(json.dumps({"points": HANDS_OVER}))
    session = {
        **SESSION,
        "environment": {"world": "urban"},
        "scenario": {"vehicle": "hatchback", "duration_s": 7},
        "features": {"autopilot": "urban"},
        "devices": {"driver": "script:person.yaml"},
    }
    path = tmp_path / "session.yaml"
    path.write_text(json.dumps(session))
    drive = simconsole.load(path).run(out=tmp_path / "python")
    done = command_line("drive", path, "--headless", "--no-pack", "--out", tmp_path / "words", "--json")
    assert done.returncode == 0, done.stderr
    assert results(done)["digest"] == drive.digest
    assert drive.metrics["autonomous"]["distance_m"] > 1.0
