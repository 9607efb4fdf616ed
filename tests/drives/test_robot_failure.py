"""A Burger and a Waffle share out the targets of a room; the Burger fails on its way, and the Waffle does its task."""

import threading
from pathlib import Path

import numpy as np
import pytest

from simconsole.drivers.robots.allocation.problem import Objective
from simconsole.drivers.robots.navigation.planner import KEEP_M
from simconsole.drivers.robots.nodes.fleet_program import Robot
from simconsole.drivers.robots.nodes.program import targets_of
from simconsole.drivers.robots.nodes.team_program import MissionLog, drive_team
from simconsole.evaluation.robots.mission_result import mission_result
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.session.fleet.fleet_drive import drive_fleet
from simconsole.session.resolution import load_session, resolve
from simconsole.values.platform import Pose
from simconsole.values.signals import Mode
from simconsole.world.arena.arena_world import arena_of
from simconsole.world.kinds.worlds import open_world
from tests.patience import PATIENCE_S

ROOM = """schema: 1
kind: arena
title: Room
walls: [{closed: true, points: [{x_m: 0, y_m: 0}, {x_m: 3.2, y_m: 0}, {x_m: 3.2, y_m: 2.6}, {x_m: 0, y_m: 2.6}]}]
starts: [{name: burger, x_m: 0.6, y_m: 0.6, yaw_deg: 0}, {name: waffle, x_m: 0.7, y_m: 1.9, yaw_deg: 0}]
targets: [{name: A, x_m: 2.5, y_m: 0.6}, {name: B, x_m: 2.4, y_m: 1.9}]
"""
SESSION = """schema: 1
environment: {world: room.world.yaml}
scenario:
  vehicle: turtlebot3_burger
  duration_s: 120
  platforms: [{name: burger}, {name: waffle, vehicle: turtlebot3_waffle}]
  faults: [{kind: silent, at_s: 5}]
features: {control: {person_required: false, standstill_speed_mps: 0.01}}
outputs: {bridge: {port: 0}, hud: null, scene: null, report: false}
devices: {driver: none}
mode: {tick_hz: 200, pacing: lockstep, control_period_ms: 20, answer_timeout_s: 60}
"""
ROBOTS = [
    ("burger", "turtlebot3_burger", Robot("/burger", Pose(0.6, 0.6, 0.0))),
    ("waffle", "turtlebot3_waffle", Robot("/waffle", Pose(0.7, 1.9, 0.0))),
]


def test_what_a_robot_leaves_undone_another_one_does(tmp_path: Path) -> None:
    world = tmp_path / "room.world.yaml"
    world.write_text(ROOM)
    (tmp_path / "session.yaml").write_text(SESSION)
    resolved = resolve(load_session(str(tmp_path / "session.yaml")))
    threads: list[threading.Thread] = []
    logs: list[MissionLog] = []

    def program(url: str) -> None:
        logs.append(drive_team(url, ROBOTS, targets_of(str(world)), Objective.SUM, tmp_path, patience_s=PATIENCE_S))

    def start(url: str) -> None:
        threads.append(threading.Thread(target=program, args=(url,)))
        threads[0].start()

    bundle = drive_fleet(resolved, tmp_path / "bundle", until_left=True, on_bridge=start).folder
    threads[0].join()
    (log,) = logs
    assert resolved.world is not None
    arena = arena_of(open_world(resolved.world))
    assert arena is not None
    result = mission_result(tmp_path, bundle, arena)
    print(result.text())
    assert result.good
    burger, waffle = log.robots
    assert (burger.visits, [visit.target for visit in waffle.visits]) == ((), ["B", "A"])
    assert waffle.failed_s is None
    assert burger.failed_s == pytest.approx(10.2, abs=0.2), "five seconds after it last obeyed"
    assert log.explored_s is not None
    assert log.explored_s < 5.0, "the targets were shared out before"
    assert log.shared_s == pytest.approx(burger.failed_s, abs=0.2)
    table = open_bundle(bundle).log.table()
    x, mode = table.column("vehicle.x_m"), table.column("arbitration.mode")
    assert 0.7 < x[-1] < 2.4, "it stands on its way"
    assert np.ptp(x[round(6.5 * 200) :]) == 0.0
    assert mode[round(6.5 * 200)] == Mode.STOPPED
    assert min(robot.clear.wall_m for robot in result.robots) >= KEEP_M
    assert result.robots[0].clear.robot_m >= KEEP_M
