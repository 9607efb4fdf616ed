"""A robot's depth camera in an arena: exact rays, by the lidar's caster, against upright walls, robots and the floor.

The rays of one column of pixels lie above each other in one upright plane, so one ray in the plane of the floor serves
them all: how far what it meets is says how high each of them meets it. Obstacles of several heights are met by level:
at each height by those that are at least so high, of which the nearest hides the others.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from simconsole.profiles.parts.depth_camera import DepthCameraProfile
from simconsole.profiles.world import ArenaProfile
from simconsole.values.kernels import Row
from simconsole.values.platform import Pose
from simconsole.world.arena.laser_scan import NOBODY, Execution
from simconsole.world.arena.outlines import outlines_of
from simconsole.world.arena.raycast import cast_all, ray_grid

Image = NDArray[np.float32]

TOO_FAR: Final = np.inf
TOO_NEAR: Final = -np.inf
"""Depths beyond what the camera measures, as ROS has them (REP 118)."""


class DepthCamera:
    """The depth camera of one robot in an arena."""

    def __init__(
        self, profile: DepthCameraProfile, arena: ArenaProfile, others_height_m: float, execution: Execution
    ) -> None:
        """Cast rays in an arena; other robots are taken to be `others_height_m` high."""
        self.profile = profile
        heights = [*(wall.height_m for wall in arena.walls), *(pillar.height_m for pillar in arena.pillars)]
        self._others_m = min(others_height_m, max(heights))
        levels = sorted({*heights, self._others_m})
        self._levels = [(height_m, ray_grid(outlines_of(arena, height_m))) for height_m in levels]
        self._cast = execution(cast_all)
        aside, down = _pixels(profile)
        self._aside, self._down = aside / profile.focal_px, down / profile.focal_px  # per m along the axis
        self._slant = np.hypot(1.0, self._aside)

    def image(self, robot: Pose, others: Row = NOBODY) -> Image:
        """Return how far along the camera's axis everything is, in m: float32 [rows, columns], top left first.

        Args:
            robot: pose of its base_footprint in map.
            others: other robots: float64 [N, 3], x, y, radius in m of map.
        """
        profile = self.profile
        rays, most_m = self._rays(robot), profile.max_m * float(self._slant.max())
        with np.errstate(divide="ignore"):
            floor = np.where(self._down > 0.0, profile.z_m / self._down, np.inf)
        depth = np.repeat(floor[:, None], profile.width_px, axis=1)
        for height_m, grid in self._levels:
            ranges = np.empty(profile.width_px)
            self._cast(rays, most_m, grid, others if self._others_m >= height_m else NOBODY, ranges)
            along = ranges / self._slant
            met_m = profile.z_m - self._down[:, None] * along
            meets = (met_m >= 0.0) & (met_m <= height_m)
            depth = np.where(meets, np.minimum(depth, along), depth)
        depth[depth > profile.max_m] = TOO_FAR
        depth[depth < profile.min_m] = TOO_NEAR
        return depth.astype(np.float32)

    def points(self, image: Image) -> Image:
        """Return the points that an image shows: float32 [rows, columns, 3], x to the right, y down, z ahead, in m.

        What is too near or too far is not a number.
        """
        depth = np.where(np.isfinite(image), image, np.nan)
        return np.stack((depth * self._aside, depth * self._down[:, None], depth), axis=-1).astype(np.float32)

    def _rays(self, robot: Pose) -> Row:
        """Return the ray of each column in the plane of the floor [columns, 4]: x, y, direction."""
        cosine, sine = np.cos(robot.yaw_rad), np.sin(robot.yaw_rad)
        rays = np.empty((self.profile.width_px, 4))
        rays[:, 0] = robot.x_m + self.profile.x_m * cosine
        rays[:, 1] = robot.y_m + self.profile.x_m * sine
        rays[:, 2] = (cosine + sine * self._aside) / self._slant
        rays[:, 3] = (sine - cosine * self._aside) / self._slant
        return rays


def _pixels(profile: DepthCameraProfile) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return how far each column lies to the right of the picture's middle, and each row below it, in pixels."""
    columns = np.arange(profile.width_px, dtype=np.float64) - 0.5 * (profile.width_px - 1)
    rows = np.arange(profile.height_px, dtype=np.float64) - 0.5 * (profile.height_px - 1)
    return columns, rows
