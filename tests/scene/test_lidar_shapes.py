import numpy as np
import pytest
from msgspec.structs import replace

from simconsole.profiles.files.world_files import load_world
from simconsole.scene.lidar_shapes import LidarPoints
from simconsole.values.host.jit import plain
from simconsole.values.platform import Ground, Pose
from simconsole.values.state_vector import columns
from simconsole.vehicle.platforms import build
from simconsole.vehicle.turtlebot.robot_state import ROBOT, RobotState
from simconsole.world.arena.arena_world import arena_of
from simconsole.world.arena.laser_scan import LaserScanner
from simconsole.world.arena.raycast import ray_grid
from simconsole.world.kinds.worlds import open_world
from tests.world.arena.test_laser_scan import BURGER

COLUMNS = columns(RobotState)  # type: ignore[arg-type]  # records within a record
HZ = 100


def points_of() -> LidarPoints:
    world = arena_of(open_world(load_world("arena")))
    assert world is not None
    exact = LaserScanner(replace(BURGER.lidar, noise_m=0.0), ray_grid(world.outlines), 1, plain)
    return LidarPoints(exact, COLUMNS, HZ)


def vectors(scans: list[float], x_m: float = 0.8, yaw_rad: float = 0.0) -> np.ndarray:
    robot = build(BURGER, Pose(x_m, 0.8, yaw_rad), Ground(1.0, 0.0, 0.0))
    row = np.concatenate((np.zeros(ROBOT.start), robot.initial_state))
    table = np.tile(row, (len(scans), 1))
    table[:, COLUMNS.index("platform.gauges.scans")] = scans
    return table


def test_each_turn_is_shown_once_at_the_tick_that_ended_it() -> None:
    points = points_of()
    found = points.of(vectors([0.0, 0.0, 1.0, 1.0, 2.0]), np.arange(1, 6))
    assert found is not None
    assert found.times_ns.tolist() == [30_000_000, 50_000_000]
    assert sum(found.counts) == len(found.points)
    assert points.of(vectors([2.0, 2.0]), np.arange(6, 8)) is None


@pytest.mark.parametrize("yaw_rad", [0.0, 1.0, -2.5])
def test_echoes_lie_on_the_walls_wherever_the_robot_looks(yaw_rad: float) -> None:
    found = points_of().of(vectors([1.0], yaw_rad=yaw_rad), np.arange(1, 2))
    assert found is not None
    west = found.points[np.abs(found.points[:, 1] - 0.8) < 0.3]
    assert west[:, 0].min() == pytest.approx(0.0, abs=0.02), "the wall behind it"
