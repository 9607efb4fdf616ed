import numpy as np
import pytest
from msgspec.structs import replace

from simconsole.profiles.files.loader import load
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.values.host.jit import plain
from simconsole.values.layout import read
from simconsole.values.platform import Ground, Pose
from simconsole.vehicle.platforms import build
from simconsole.vehicle.turtlebot.robot_state import ROBOT, RobotState
from simconsole.world.arena.arena_world import arena_of
from simconsole.world.arena.laser_scan import LaserScanner
from simconsole.world.arena.raycast import ray_grid
from simconsole.world.kinds.worlds import open_world

BURGER = load("vehicles", "turtlebot3_burger", TurtlebotProfile)


def scanner(seed: int = 1) -> LaserScanner:
    world = arena_of(open_world(load_world("arena")))
    assert world is not None
    return LaserScanner(BURGER.lidar, ray_grid(world.outlines), seed, plain)


def state(scans: float = 3.0, scan_ms: float = 0.0) -> RobotState:
    robot = build(BURGER, Pose(0.8, 0.8, 0.0), Ground(1.0, 0.0, 0.0))
    found: RobotState = read(np.concatenate((np.zeros(ROBOT.start), robot.initial_state)), ROBOT)
    return found._replace(gauges=found.gauges._replace(scans=scans, scan_ms=scan_ms))


def test_there_is_no_scan_before_the_first_turn() -> None:
    assert scanner().scan(state(scans=0.0)) is None


def test_a_scan_is_of_the_last_whole_turn_and_as_old_as_its_first_ray() -> None:
    scan = scanner().scan(state(scan_ms=15.0))
    assert scan is not None
    assert (scan.number, scan.age_ns) == (3, 215_000_000)
    assert scan.ranges_m[180] == pytest.approx(0.8 - 0.032, abs=0.06), "the wall behind it, seen from its mast"


def test_errors_hang_on_seed_and_turn_alone() -> None:
    first, again = scanner().scan(state()), scanner().scan(state(scan_ms=5.0))
    assert first is not None
    assert again is not None
    assert (first.ranges_m == again.ranges_m).all()
    for other in (scanner(seed=2).scan(state()), scanner().scan(state(scans=4.0))):
        assert other is not None
        apart = (other.ranges_m - first.ranges_m)[(other.ranges_m > 0.0) & (first.ranges_m > 0.0)]
        assert apart.std() == pytest.approx(0.01 * 2.0**0.5, rel=0.2)


def test_without_errors_every_turn_on_the_spot_is_the_same() -> None:
    world = arena_of(open_world(load_world("arena")))
    assert world is not None
    exact = LaserScanner(replace(BURGER.lidar, noise_m=0.0), ray_grid(world.outlines), 1, plain)
    first, later = exact.scan(state()), exact.scan(state(scans=4.0))
    assert first is not None
    assert later is not None
    assert (first.ranges_m == later.ranges_m).all()
    assert first.ranges_m[180] == pytest.approx(0.8 - 0.032, abs=1e-3)


def test_other_robots_are_seen() -> None:
    alone = scanner().scan(state())
    beside = scanner().scan(state(), np.array([(1.8, 0.8, 0.105)]))
    assert alone is not None
    assert beside is not None
    assert beside.ranges_m[0] == pytest.approx(1.0 + 0.032 - 0.105, abs=0.06)
    assert (beside.ranges_m != alone.ranges_m).sum() > 5
