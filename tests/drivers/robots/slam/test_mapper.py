"""SLAM in the shipped arena: odometry errs by 2 % of the way and 3 % of the turn, scans have noise and skew."""

import math
from typing import NamedTuple

import numpy as np
import pytest

from simconsole.drivers.robots.slam.mapper import Localiser, SharedMap
from simconsole.drivers.robots.slam.odometry_track import Array, OdometryTrack
from simconsole.drivers.robots.slam.planar import ORIGIN, composed
from simconsole.drivers.robots.slam.rays import Rays, rays_of
from simconsole.evaluation.metrics.map_errors import map_errors
from simconsole.evaluation.metrics.trajectory_errors import trajectory_errors
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from tests.drivers.robots.arena_robot import MOUNT, STOPPED, ArenaRobot, round_of, speeds_along
from tests.samples import Sample
from tests.world.arena.shipped_arena import arena

START = Pose(0.8, 0.8, 0.0)


class Mapped(NamedTuple):
    found: Array  # [N, 3]
    raw: Array  # by odometry alone
    true: Array
    shared: SharedMap
    robot: ArenaRobot
    share: float  # the least


def walkers(robot: ArenaRobot) -> Array:
    """Two other robots that drive round with it: one ahead and one beside, now nearer, now further."""
    away = (0.9 + 0.4 * math.sin(0.3 * robot.time_s), 0.8 + 0.3 * math.cos(0.2 * robot.time_s))
    places = [composed(robot.pose, Pose(away[0], 0.1, 0.0)), composed(robot.pose, Pose(-0.2, away[1], 0.0))]
    return np.array([(place.x_m, place.y_m, 0.105) for place in places])


def mapped(rng: np.random.Generator, places: Array, skewed: bool = True, beside_others: bool = False) -> Mapped:
    robot, track, shared = ArenaRobot(rng, START), OdometryTrack(), SharedMap(compiled)
    localiser = Localiser(shared, START)
    rows: list[tuple[Pose, Pose, Pose]] = []
    share = 1.0
    track.add(0.0, ORIGIN)
    for speeds in [STOPPED] * 20 + speeds_along(places, START):
        if beside_others:
            robot.others = walkers(robot)
        turn = robot.advance(speeds)
        track.add(robot.time_s, robot.odometry)
        if turn is None:
            continue
        rays = rays_of(turn if skewed else turn._replace(time_s=turn.end_s, time_step_s=0.0), MOUNT, track)
        fix = localiser.add(rays)
        rows.append((fix.pose, composed(START, robot.odometry), robot.pose))
        share = min(share, fix.share)
    found, raw, true = (np.array([row[column] for row in rows]) for column in range(3))
    return Mapped(found, raw, true, shared, robot, share)


def test_the_way_round_is_mapped_within_five_centimetres(sample: Sample) -> None:
    for seed in range(sample.of(1, 10)):
        drive = mapped(np.random.default_rng((sample.seed, seed)), round_of(arena()))
        errors = trajectory_errors(drive.found, drive.true, 5)
        raw = trajectory_errors(drive.raw, drive.true, 5)
        grid = drive.shared.grid
        assert grid is not None
        walls = map_errors(grid, drive.robot.outlines)
        print(f"{errors} raw {raw.absolute_rms_m:.3f} {walls} share {drive.share:.2f}")
        assert raw.absolute_rms_m > 0.2, "there was something to correct"
        assert errors.absolute_rms_m <= 0.05
        assert errors.heading_rms_rad <= math.radians(1.0)
        assert errors.relative_rms_m <= 0.02
        assert walls.precision >= 0.85
        assert walls.recall >= 0.85
        assert walls.wall_m <= 0.05


def test_robots_that_drive_beside_it_are_not_taken_for_walls(sample: Sample) -> None:
    for seed in range(sample.of(1, 10)):
        rng = np.random.default_rng((sample.seed, seed))
        drive = mapped(rng, round_of(arena()), beside_others=True)
        errors = trajectory_errors(drive.found, drive.true, 5)
        grid = drive.shared.grid
        assert grid is not None
        walls = map_errors(grid, drive.robot.outlines)
        print(f"{errors} {walls} share {drive.share:.2f}")
        assert errors.absolute_rms_m <= 0.05
        assert walls.precision >= 0.85
        assert walls.recall >= 0.85


def test_without_the_times_of_its_rays_a_turning_robot_maps_worse(sample: Sample) -> None:
    places = round_of(arena())[:5]
    with_times, without = (mapped(np.random.default_rng(sample.seed), places, skewed) for skewed in (True, False))
    errors = [trajectory_errors(drive.found, drive.true, 5) for drive in (with_times, without)]
    assert errors[0].absolute_rms_m < 0.02
    assert errors[1].absolute_rms_m > 1.5 * errors[0].absolute_rms_m


def test_a_robot_that_slipped_is_found_again(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    robot, track, shared = ArenaRobot(rng, START, 1.0, 1.0), OdometryTrack(), SharedMap(compiled)
    localiser = Localiser(shared, START)
    track.add(0.0, ORIGIN)
    fixes = []
    for step in range(200):
        if step == 120:  # wheels turn, the robot does not, and it is pushed round
            robot.pose = composed(robot.pose, Pose(-0.15, 0.1, 0.15))
        turn = robot.advance(STOPPED)
        track.add(robot.time_s, robot.odometry)
        if turn is not None and step != 129:  # a scan during the push is neither here nor there
            fixes.append(localiser.add(rays_of(turn, MOUNT, track)))
    away = math.hypot(fixes[-1].pose.x_m - robot.pose.x_m, fixes[-1].pose.y_m - robot.pose.y_m)
    assert away < 0.02
    assert math.hypot(fixes[-1].correction.x_m - START.x_m, fixes[-1].correction.y_m - START.y_m) > 0.1


def test_robots_share_a_map(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    shared = SharedMap(compiled)
    starts = (START, Pose(0.8, 1.8, 0.0))
    for start in starts:
        robot, track, localiser = ArenaRobot(rng, start), OdometryTrack(), Localiser(shared, start)
        track.add(0.0, ORIGIN)
        for speeds in [STOPPED] * 50:
            turn = robot.advance(speeds)
            track.add(robot.time_s, robot.odometry)
            if turn is not None:
                fix = localiser.add(rays_of(turn, MOUNT, track))
        assert math.hypot(fix.pose.x_m - start.x_m, fix.pose.y_m - start.y_m) < 0.02
    assert fix.share > 0.8, "the second one found the walls of the first"


def test_without_an_echo_odometry_counts_and_is_less_and_less_certain() -> None:
    localiser = Localiser(SharedMap(compiled), START)
    nothing = Rays(np.empty((0, 4)), np.empty(0), Pose(1.0, 0.0, 0.5))
    fix = localiser.add(nothing)
    assert fix.pose == pytest.approx(START)
    further = localiser.add(nothing._replace(odometry=Pose(1.5, 0.0, 0.5)))
    assert further.pose.x_m == pytest.approx(0.8 + 0.5 * math.cos(0.5))
    assert further.covariance[0, 0] > fix.covariance[0, 0]
    assert composed(further.correction, Pose(1.5, 0.0, 0.5)) == pytest.approx(further.pose)
