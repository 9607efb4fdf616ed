"""The whole way without a console: an unknown arena is explored, mapped, and its targets are gone to."""

import math

import numpy as np
import pytest

from simconsole.drivers.robots.navigation.mission import Mission, Target, problem_by
from simconsole.drivers.robots.navigation.navigator import Navigator
from simconsole.drivers.robots.slam.mapper import Localiser, SharedMap
from simconsole.drivers.robots.slam.odometry_track import OdometryTrack
from simconsole.drivers.robots.slam.planar import ORIGIN, composed, seen_from
from simconsole.drivers.robots.slam.rays import rays_of
from simconsole.evaluation.metrics.map_errors import map_errors
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from simconsole.world.arena.occupancy import grid_of
from tests.drivers.robots.arena_robot import STEP_S, STOPPED, ArenaRobot, burger
from tests.samples import Sample
from tests.world.arena.shipped_arena import arena

START = Pose(0.8, 0.8, 0.0)
TARGETS = [Target(spot.name, spot.x_m, spot.y_m, math.radians(spot.yaw_deg)) for spot in arena().targets]
NOTHING = np.empty((0, 2))


@pytest.mark.parametrize("kind", ["burger", "waffle"])
def test_an_unknown_arena_is_explored_and_all_targets_are_reached_without_touching_anything(
    sample: Sample, kind: str
) -> None:
    for seed in range(sample.of(1, 20)):
        robot = ArenaRobot(np.random.default_rng((sample.seed, seed)), START, robot=kind)
        mount = Pose(robot.shape.lidar_x_m, 0.0, 0.0)
        track, shared = OdometryTrack(), SharedMap(compiled)
        localiser, navigator = Localiser(shared, START), Navigator(robot.shape, compiled)
        mission = Mission(navigator, TARGETS)
        track.add(0.0, ORIGIN)
        speeds, correction, echoes, explored_m = STOPPED, None, NOTHING, 0.0
        ends: list[tuple[str, float]] = []
        while not mission.is_done and robot.time_s < 600.0:
            turn = robot.advance(speeds)
            track.add(robot.time_s, robot.odometry)
            if turn is not None:
                rays = rays_of(turn, mount, track)
                fix = localiser.add(rays)
                correction, echoes = fix.correction, rays.points_m
                scanned = robot.odometry
                if round(robot.time_s / STEP_S) % 150 == 10 and shared.grid is not None:
                    navigator.see_map(shared.grid)
            if round(robot.time_s / STEP_S) % 5 or correction is None:
                continue
            pose = composed(correction, robot.odometry)
            back = seen_from(robot.odometry, scanned)
            cosine, sine = math.cos(back.yaw_rad), math.sin(back.yaw_rad)
            points = echoes @ np.array(((cosine, sine), (-sine, cosine))) + (back.x_m, back.y_m)
            mission.step(robot.time_s, pose, points)
            speeds = navigator.steer(robot.time_s, pose, points)
            if mission.explored_s is not None and not explored_m:
                explored_m = robot.driven_m
            if len(ends) < len(mission.visits):
                ends.append((mission.visits[-1].name, robot.driven_m))
                target = next(target for target in TARGETS if target.name == ends[-1][0])
                assert math.hypot(target.x_m - robot.pose.x_m, target.y_m - robot.pose.y_m) < 0.12
        grid = shared.grid
        assert grid is not None
        walls = map_errors(grid, robot.outlines)
        driven_m = robot.driven_m - explored_m
        print(
            f"{robot.time_s:.0f} s, explored {mission.explored_s} s {explored_m:.1f} m, planned"
            f" {mission.planned_m:.2f} m, driven {driven_m:.2f} m, room {robot.least_m:.3f} m, {walls}"
        )
        assert mission.is_done
        assert [visit.reached for visit in mission.visits] == [True] * 5
        assert robot.least_m >= 0.05
        assert walls.precision >= 0.85
        assert walls.recall >= 0.85
        assert driven_m <= 1.1 * mission.planned_m


def test_costs_are_the_lengths_of_plans() -> None:
    planner = Navigator(burger(), compiled).planner
    surface = planner.surface(grid_of(arena(), 0.05), NOTHING)
    places = [(target.x_m, target.y_m) for target in TARGETS]
    problem = problem_by(planner, surface, [(0.8, 0.8)], places)
    for a, one in enumerate(places):
        for b, other in enumerate(places):
            assert problem.between[a][b] >= math.dist(one, other) - 1e-9
            assert abs(problem.between[a][b] - problem.between[b][a]) < 0.1 * problem.between[a][b] + 1e-9
