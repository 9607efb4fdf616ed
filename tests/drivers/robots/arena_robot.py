"""A robot in the shipped arena without a console: exact motion, odometry that errs, scans with noise and skew."""

import math

import numpy as np

from simconsole.drivers.robots.navigation.path_following import Speeds
from simconsole.drivers.robots.navigation.robot_shape import RobotShape, shape_of
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.drivers.robots.slam.planar import ORIGIN, composed
from simconsole.drivers.robots.slam.rays import Turn
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.world import ArenaProfile
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from simconsole.world.arena.lidar import Beam, End, sweep
from simconsole.world.arena.outlines import Outlines, outlines_of
from simconsole.world.arena.raycast import ray_grid
from tests.world.arena.shipped_arena import arena

STEP_S = 0.02
SCAN_STEPS = 10
MOUNT = Pose(-0.032, 0.0, 0.0)
RAYS = 360
MAX_M = 3.5
NOISE_M = 0.01
START = Pose(0.8, 0.8, 0.0)


def shape(robot: str) -> RobotShape:
    profile = load_vehicle(f"turtlebot3_{robot}")
    assert isinstance(profile, TurtlebotProfile)
    return shape_of(profile)


def burger() -> RobotShape:
    return shape("burger")


class ArenaRobot:
    """Drives as told, at once; counts the way and the least distance of its body from everything."""

    def __init__(
        self,
        rng: np.random.Generator,
        start: Pose = START,
        scale: float = 1.02,
        turn: float = 1.03,
        outlines: Outlines | None = None,
        robot: str = "burger",
    ) -> None:
        self.pose, self.odometry, self.time_s = start, ORIGIN, 0.0
        self.shape = shape(robot)
        self.driven_m, self.least_m = 0.0, math.inf
        self.outlines = outlines_of(arena()) if outlines is None else outlines
        self._rng, self._scale, self._turn = rng, scale, turn
        self._grid = ray_grid(self.outlines)
        self._sweep = compiled(sweep)
        self._begin = self._end(STOPPED)
        self.others = np.empty((0, 3))  # other robots: x, y, radius in m

    def _end(self, speeds: Speeds) -> End:
        pose, speed = self.pose, speeds.speed_mps
        return End(
            x_m=pose.x_m,
            y_m=pose.y_m,
            yaw_rad=pose.yaw_rad,
            vx_map_mps=speed * math.cos(pose.yaw_rad),
            vy_map_mps=speed * math.sin(pose.yaw_rad),
            yaw_rate_radps=speeds.yaw_rate_radps,
        )

    def advance(self, speeds: Speeds) -> Turn | None:
        """Drive for a step; return a scan where one is complete."""
        way, turn = speeds.speed_mps * STEP_S, speeds.yaw_rate_radps * STEP_S
        self.pose = composed(self.pose, arc(way, turn))
        self.odometry = composed(self.odometry, arc(way * self._scale, turn * self._turn))
        self.driven_m += abs(way)
        self.time_s = round(self.time_s + STEP_S, 9)
        self.least_m = min(self.least_m, self.room_m())
        if round(self.time_s / STEP_S) % SCAN_STEPS:
            return None
        ranges, end = np.empty(RAYS), self._end(speeds)
        noise = self._rng.normal(0.0, NOISE_M, RAYS)
        turn_s = SCAN_STEPS * STEP_S
        beam = Beam(self.shape.lidar_x_m, 0.12, MAX_M, turn_s)
        self._sweep(self._begin, end, beam, self._grid, self.others, noise, ranges)
        self._begin = end
        return Turn(self.time_s - turn_s, ranges, 0.0, math.tau / RAYS, turn_s / RAYS, 0.12, MAX_M)

    def room_m(self) -> float:
        """The distance from the edge of the body to the nearest obstacle."""
        body = composed(self.pose, Pose(self.shape.body_x_m, 0.0, 0.0))
        place = np.array((body.x_m, body.y_m))
        segments, circles = self.outlines.segments, self.outlines.circles
        way = segments[:, 2:] - segments[:, :2]
        share = np.clip(((place - segments[:, :2]) * way).sum(axis=1) / (way * way).sum(axis=1), 0.0, 1.0)
        away = np.hypot(*(segments[:, :2] + share[:, None] * way - place).T).min()
        if len(circles):
            away = min(away, (np.hypot(*(circles[:, :2] - place).T) - circles[:, 2]).min())
        return float(away) - self.shape.radius_m


STOPPED = Speeds(0.0, 0.0)


def arc(way_m: float, turn_rad: float) -> Pose:
    return Pose(way_m * math.cos(0.5 * turn_rad), way_m * math.sin(0.5 * turn_rad), turn_rad)


def round_of(profile: ArenaProfile) -> Array:
    """The corners of the way round."""
    assert profile.round is not None
    return np.array([(point.x_m, point.y_m) for point in profile.round])


def speeds_along(places: Array, start: Pose) -> list[Speeds]:
    """The speeds that drive from place to place: on the spot, then straight ahead."""
    x, y, yaw = start
    told: list[Speeds] = []
    for to_x, to_y in places.tolist():
        away = math.remainder(math.atan2(to_y - y, to_x - x) - yaw, math.tau)
        steps = max(1, round(abs(away) / 1.2 / STEP_S))
        told += [Speeds(0.0, away / steps / STEP_S)] * steps
        length = math.hypot(to_x - x, to_y - y)
        steps = max(1, round(length / 0.2 / STEP_S))
        told += [Speeds(length / steps / STEP_S, 0.0)] * steps
        x, y, yaw = to_x, to_y, yaw + away
    return told
