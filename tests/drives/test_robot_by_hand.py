"""A person drives a robot from the wheel, as the shipped session has it; a program commands the robots beside it."""

import threading
from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.session.fleet.fleet_drive import drive_fleet
from simconsole.session.resolution import load_session, override, resolve
from simconsole.values.signals import Mode
from tests.ports import free_port
from tests.session.fleet.fleet_client import FleetClient


def test_a_person_drives_a_robot_from_the_wheel(tmp_path: Path) -> None:
    result = drive_fleet(resolve(load_session("turtlebot3_by_hand")), tmp_path / "bundle")
    table = open_bundle(result.folder).log.table()
    assert (table.column("arbitration.mode") == Mode.MANUAL).all()
    assert table.column("vehicle.vx_mps").max() == pytest.approx(0.8 * 0.26, abs=0.001), "the pedal is the speed"
    assert 0.8 < table.column("vehicle.yaw_rad")[-1] < 1.4, "the wheel has turned it"
    assert 2.0 < table.column("vehicle.distance_m")[-1] < 3.0
    assert abs(table.column("vehicle.vx_mps")[-1]) < 0.01
    assert table.column("platform.motion.collisions")[-1] == 0.0
    for name in result.platforms:
        assert np.ptp(open_bundle(result.folder / name).log.table().column("vehicle.x_m")) == 0.0, "nobody commands it"


def test_a_program_commands_the_others_and_nobody_waits_for_one_for_the_person(tmp_path: Path) -> None:
    port = free_port()
    session = override(
        load_session("turtlebot3_by_hand"),
        outputs={"bridge": {"port": port}},
        features={"control": {"person_required": False, "standstill_speed_mps": 0.01}},
        mode={"pacing": "lockstep", "answer_timeout_s": 60},
        scenario={"duration_s": 6.0},
    )
    client = FleetClient(f"ws://127.0.0.1:{port}", [(0.0, 1.0), (0.1, 0.0)], ["tb3_1", "tb3_2"])
    thread = threading.Thread(target=client.run)
    thread.start()
    result = drive_fleet(resolve(session), tmp_path / "bundle")
    thread.join()
    by_hand, first, second = (
        open_bundle(folder).log.table() for folder in (result.folder, *(result.folder / n for n in result.platforms))
    )
    assert result.summary["exchanges"] == 0
    assert by_hand.column("arbitration.mode")[-1] == Mode.MANUAL
    assert by_hand.column("vehicle.distance_m")[-1] > 0.1
    assert np.ptp(first.column("vehicle.yaw_rad")) > 3.0
    assert second.column("vehicle.distance_m")[-1] > 0.4
    told = by_hand.column("others.y_1_m")
    assert np.ptp(told) > 0.4, "of the robot that the program drives"
    assert verify(result.folder) == []
    assert replay_bundle(result.folder).hashes_equal
