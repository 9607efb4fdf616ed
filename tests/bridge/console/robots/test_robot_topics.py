"""The topics of a robot: what stands in them, their frames, and which commands it takes."""

import json
import math
from typing import Any

import numpy as np
import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.published_tick import RobotTable
from simconsole.bridge.console.robots.robot_topics import robot_table
from simconsole.bridge.console.surroundings import Surroundings
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.values.host.jit import plain
from simconsole.values.kernels import put
from simconsole.values.layout import read, write
from simconsole.values.platform import Ground, Pose
from simconsole.values.signals import RemoteKind
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from simconsole.vehicle.platforms import build
from simconsole.vehicle.turtlebot.robot_state import ROBOT, RobotState
from simconsole.world.arena.arena_world import arena_of
from simconsole.world.kinds.worlds import open_world
from tests.bridge.fixtures import Peer

BURGER = load("vehicles", "turtlebot3_burger", TurtlebotProfile)
TICK_HZ = 200


def robot() -> RobotTable:
    found = robot_table(BURGER, arena_of(open_world(load_world("arena"))), plain)
    assert found is not None
    return found


def bridge(**keys: Any) -> ConsoleBridge:
    return ConsoleBridge(BridgeProfile(port=0, **keys), around=Surroundings(robot=robot()))


def snapshot(tick: int, **changes: Any) -> Snapshot:
    platform = build(BURGER, Pose(0.8, 0.8, 0.0), Ground(1.0, 0.0, 0.0))
    row = np.zeros(PLATFORM_AT + len(platform.initial_state))
    put(row, PLATFORM_AT, platform.initial_state)
    write(row, LAYOUT.vehicle, platform.initial_vehicle)
    state: RobotState = read(row, ROBOT)
    for part, fields in changes.items():
        state = state._replace(**{part: getattr(state, part)._replace(**fields)})
    write(row, ROBOT, state)
    return Snapshot(tick, TICK_HZ, row)


def heard(console: ConsoleBridge, shown: Snapshot, *topics: str) -> dict[str, Any]:
    peer = Peer(console)
    for topic in topics:
        peer.send(op="subscribe", topic=topic)
    console.publish(snapshot(0), 0)
    peer.heard()
    console.publish(shown, 10)
    return {one["topic"]: one["msg"] for one in peer.heard() if one["op"] == "publish"}


def test_a_robot_has_its_own_topics_in_place_of_the_cars() -> None:
    names = set(bridge().names)
    assert {"/scan", "/odom", "/imu", "/joint_states", "/battery_state", "/sensor_state", "/tf", "/cmd_vel"} <= names
    assert {"/clock", "/console/arbitration", "/console/mode"} <= names
    assert not {name for name in names if name.startswith(("/vehicle/", "/control/", "/ball/"))}
    assert "/imu/data" not in names
    assert robot_table(load_vehicle("hatchback"), None, plain) is None


def test_outside_of_an_arena_it_has_no_scan() -> None:
    blind = robot_table(BURGER, None, plain)
    assert "/scan" not in ConsoleBridge(BridgeProfile(port=0), around=Surroundings(robot=blind)).names


def test_odometry_joints_and_transforms_tell_the_same_state() -> None:
    shown = snapshot(
        200,
        odometry={"x_m": 1.0, "y_m": -0.5, "yaw_rad": math.pi / 2.0, "speed_mps": 0.2, "yaw_rate_radps": 0.1},
        gauges={"left_rad": 3.0, "right_rad": 4.0},
        motion={"left_radps": 1.5, "right_radps": 2.5, "bumper": 2.0},
    )
    found = heard(bridge(), shown, "/odom", "/joint_states", "/tf", "/sensor_state")
    odometry = found["/odom"]
    assert odometry["header"] == {"stamp": {"sec": 1, "nanosec": 0}, "frame_id": "odom"}
    assert odometry["pose"]["pose"]["position"] == {"x": 1.0, "y": -0.5, "z": 0.0}
    assert odometry["twist"]["twist"]["linear"]["x"] == 0.2
    assert found["/joint_states"]["position"] == [3.0, 4.0]
    assert found["/joint_states"]["velocity"] == [1.5, 2.5]
    base, left, right = found["/tf"]["transforms"]
    assert base["transform"]["rotation"] == odometry["pose"]["pose"]["orientation"]
    assert (left["child_frame_id"], right["child_frame_id"]) == ("wheel_left_link", "wheel_right_link")
    assert left["transform"]["translation"]["y"] == -right["transform"]["translation"]["y"] == 0.08
    assert sum(value**2 for value in left["transform"]["rotation"].values()) == pytest.approx(1.0)
    assert found["/sensor_state"]["bumper"] == 2
    assert found["/sensor_state"]["left_encoder"] == int(3.0 / math.tau * 4096)


def test_a_scan_bears_the_time_of_its_first_ray() -> None:
    found = heard(bridge(), snapshot(200, gauges={"scans": 5.0, "scan_ms": 50.0}), "/scan")["/scan"]
    assert found["header"] == {"stamp": {"sec": 0, "nanosec": 750_000_000}, "frame_id": "base_scan"}
    assert len(found["ranges"]) == 360
    assert found["angle_increment"] == pytest.approx(math.tau / 360)
    assert found["time_increment"] * 360 == pytest.approx(found["scan_time"]) == pytest.approx(0.2)
    assert found["intensities"] == []


def test_imu_measures_gravity_with_noise_that_hangs_on_seed_and_tick() -> None:
    accel, rate = [], []
    for tick in range(200, 260):
        found = heard(bridge(), snapshot(tick), "/imu")["/imu"]
        accel.append(found["linear_acceleration"]["z"])
        rate.append(found["angular_velocity"]["z"])
    assert np.mean(accel) == pytest.approx(9.80665, abs=0.01)
    assert np.std(accel) == pytest.approx(0.017, rel=0.4)
    assert np.std(rate) == pytest.approx(2e-4, rel=0.4)
    assert heard(bridge(), snapshot(200), "/imu")["/imu"]["linear_acceleration"]["z"] == accel[0]


def test_the_battery_falls_from_full_to_empty_and_no_further() -> None:
    full, half, over = (
        heard(bridge(), snapshot(200, gauges={"used_j": share * BURGER.battery.energy_j}), "/battery_state")[
            "/battery_state"
        ]
        for share in (0.0, 0.5, 2.0)
    )
    assert (full["voltage"], full["percentage"]) == pytest.approx((12.6, 1.0))
    assert (half["voltage"], half["charge"]) == pytest.approx((11.1, 0.9))
    assert (over["voltage"], over["percentage"]) == pytest.approx((9.6, 0.0))


def test_the_magnetic_field_points_north_along_y_of_map() -> None:
    field = heard(bridge(), snapshot(200), "/magnetic_field")["/magnetic_field"]["magnetic_field"]
    assert field["x"] == pytest.approx(0.0)
    assert field["y"] > 0.0 > field["z"]


def test_a_namespace_is_the_prefix_of_topics_and_frames() -> None:
    console = bridge(namespace="/tb3_0")
    found = heard(console, snapshot(200), "/tb3_0/odom", "/tf")
    assert found["/tb3_0/odom"]["child_frame_id"] == "tb3_0/base_footprint"
    assert found["/tf"]["transforms"][0]["header"]["frame_id"] == "tb3_0/odom"
    stamped = {"header": {"frame_id": "tb3_0/base_footprint"}, "twist": {"linear": {"x": 0.1}, "angular": {"z": 0.0}}}
    assert Peer(console).publish("/tb3_0/cmd_vel_stamped", stamped).kind == "command"


def test_it_takes_velocities_in_its_own_frames() -> None:
    peer = Peer(bridge())
    assert peer.publish("/cmd_vel", {"linear": {"x": 0.0}, "angular": {"z": 1.5}}).kind == "command"
    command = peer.bridge.inputs.command
    assert (command.kind, command.speed_mps, command.yaw_rate_radps) == (RemoteKind.TWIST, 0.0, 1.5)
    twist = {"linear": {"x": 0.1}, "angular": {"z": 0.0}}
    for frame in ("", "base_footprint", "base_link"):
        assert peer.publish("/cmd_vel_stamped", {"header": {"frame_id": frame}, "twist": twist}).kind == "command"
    assert "base_footprint" in peer.publish("/cmd_vel_stamped", {"header": {"frame_id": "map"}, "twist": twist}).text
    assert json.dumps(peer.bridge.inputs.command.speed_mps) == "0.1"
