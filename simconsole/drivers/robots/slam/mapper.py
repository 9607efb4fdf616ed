"""Localisation and mapping at once: each scan is matched with the map of those before it, then entered into it.

Between two scans a robot is where odometry says; what matching finds beside that is the correction from map to odom.
Several robots may share one map: each has a `Localiser` of its own.
"""

import math
from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.drivers.robots.slam.hit_map import HitMap, draw, empty_map, grown, occupancy
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.drivers.robots.slam.planar import composed, inverse, seen_from, wrapped
from simconsole.drivers.robots.slam.rays import Rays
from simconsole.drivers.robots.slam.scan_matching import Fit, Prior, fitted, searched
from simconsole.values.platform import Pose
from simconsole.world.arena.occupancy import Grid

Execution = Callable[[Callable[..., Any]], Callable[..., Any]]
"""How kernels run: `jit.compiled` or `jit.plain`; both give equal bits."""


class MapperSettings(NamedTuple):
    """How a map is made."""

    cell_m: float = 0.05
    still_m: float = 0.003  # deviation of odometry between two scans: of a robot that stands
    still_rad: float = 0.003
    per_m: float = 0.05  # and of one that moves: a share of its way and its turn
    per_rad: float = 0.05
    every_m: float = 0.08  # a scan is entered after so much way
    every_rad: float = 0.1  # or turn
    every_scans: int = 10  # or as many scans
    first_scans: int = 4  # these in any case: one scan alone has gaps
    least_share: float = 0.6  # of echoes that fit; below, the robot is looked for
    search_m: float = 0.3
    search_rad: float = 0.3


DEFAULTS: Final = MapperSettings()


class SharedMap:
    """The map, and how kernels run on it."""

    def __init__(self, execution: Execution, settings: MapperSettings = DEFAULTS) -> None:
        """Start with nothing known."""
        self.settings = settings
        self.scans = 0
        self._field: HitMap | None = None
        self._draw, self._fitted, self._searched = execution(draw), execution(fitted), execution(searched)

    @property
    def grid(self) -> Grid | None:
        """What is known, as an occupancy grid; None before the first scan."""
        return None if self._field is None else occupancy(self._field)

    def warm_up(self) -> None:
        """Have the kernels compiled now, so that no scan waits for it."""
        field, points, prior = (
            empty_map(0.0, 0.0, self.settings.cell_m),
            np.zeros((1, 2)),
            Prior(0.0, 0.0, 0.0, 1.0, 1.0),
        )
        self._draw(field, np.zeros((1, 4)), np.zeros(1), 1)
        self._fitted(field, points, prior)
        self._searched(field, points, prior, 0.0, 0.0)

    def enter(self, rays: Rays, pose: Pose) -> None:
        """Enter a scan that was taken at `pose`."""
        lines = np.column_stack((_placed(pose, rays.lines_m[:, :2]), _placed(pose, rays.lines_m[:, 2:])))
        if not len(lines):
            return
        if self._field is None:
            self._field = empty_map(pose.x_m, pose.y_m, self.settings.cell_m)
        self._field = grown(self._field, lines.reshape(-1, 2))
        self.scans += 1
        self._draw(self._field, lines, rays.echo, self.scans)

    def match(self, points_m: Array, prior: Prior) -> Fit | None:
        """Return where a scan's echoes [N, 2] fit, looked for about the prior if they don't; None without a map."""
        if self._field is None or not len(points_m):
            return None
        near: Fit = self._fitted(self._field, points_m, prior)
        settings = self.settings
        if near.near >= settings.least_share * (near.near + near.off):
            return near
        found = self._searched(self._field, points_m, prior, settings.search_m, settings.search_rad)
        far: Fit = self._fitted(self._field, points_m, found)
        return far if far.near > near.near else near


class Fix(NamedTuple):
    """Where a robot is."""

    pose: Pose  # of its base, in map
    correction: Pose  # of odom, in map
    covariance: Array  # [3, 3] of x, y, yaw; without that of the map
    share: float  # of the echoes at known places that fit


class Localiser:
    """One robot on a map."""

    def __init__(self, shared: SharedMap, start: Pose) -> None:
        """Begin at `start`, the pose of the robot's base in map when its first scan ends."""
        self._map = shared
        self._start = start
        self._pose: Pose | None = None
        self._odometry = start  # at the last scan
        self._entered: tuple[Pose, int] | None = None  # where the last scan was entered, and how many came since
        self._count = 0

    def add(self, rays: Rays) -> Fix:
        """Take a scan, and enter it into the map where it tells something new."""
        prior = self._prior(rays.odometry)
        fit = self._map.match(rays.points_m, prior)
        pose, share = Pose(prior.x_m, prior.y_m, prior.yaw_rad), 1.0
        covariance = np.diag((1.0 / prior.per_m2, 1.0 / prior.per_m2, 1.0 / prior.per_rad2))
        if fit is not None:
            pose, share = Pose(fit.x_m, fit.y_m, wrapped(fit.yaw_rad)), fit.near / max(1.0, fit.near + fit.off)
            covariance = np.linalg.inv(((fit.xx, fit.xy, fit.xa), (fit.xy, fit.yy, fit.ya), (fit.xa, fit.ya, fit.aa)))
        self._pose, self._odometry = pose, rays.odometry
        self._count += 1
        if self._is_new(pose):
            self._map.enter(rays, pose)
            self._entered = (pose, 0)
        return Fix(pose, composed(pose, inverse(rays.odometry)), covariance, share)

    def _prior(self, odometry: Pose) -> Prior:
        settings = self._map.settings
        way = Pose(0.0, 0.0, 0.0) if self._pose is None else seen_from(self._odometry, odometry)
        expected = composed(self._pose or self._start, way)
        deviation_m = settings.still_m + settings.per_m * math.hypot(way.x_m, way.y_m)
        deviation_rad = settings.still_rad + settings.per_rad * abs(way.yaw_rad)
        return Prior(expected.x_m, expected.y_m, expected.yaw_rad, 1.0 / deviation_m**2, 1.0 / deviation_rad**2)

    def _is_new(self, pose: Pose) -> bool:
        settings = self._map.settings
        if self._entered is None or self._count <= settings.first_scans:
            return True
        last, count = self._entered
        self._entered = (last, count + 1)
        way = seen_from(last, pose)
        return (
            math.hypot(way.x_m, way.y_m) >= settings.every_m
            or abs(way.yaw_rad) >= settings.every_rad
            or count + 1 >= settings.every_scans
        )


def _placed(pose: Pose, points_m: Array) -> Array:
    """Return points [N, 2] of a frame in the one that its pose is given in."""
    cosine, sine = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
    turned = np.empty_like(points_m)
    turned[:, 0] = pose.x_m + cosine * points_m[:, 0] - sine * points_m[:, 1]
    turned[:, 1] = pose.y_m + sine * points_m[:, 0] + cosine * points_m[:, 1]
    return turned
