"""Cameras: from a point in `map` to a pixel. ISO 8855 axes in (x forward, y left, z up), OpenGL's clip space out."""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NEAR_M: Final = 0.15
FAR_M: Final = 2500.0
TO_GL: Final[Array] = np.array(((0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)))
"""Axes of a camera in OpenGL (x right, y up, z back) from those of a vehicle."""


class Viewport(NamedTuple):
    """A part of the window, in shares of its width and height from its lower left corner."""

    left: float = 0.0
    bottom: float = 0.0
    width: float = 1.0
    height: float = 1.0

    def pixels(self, width_px: int, height_px: int) -> tuple[int, int, int, int]:
        """Return (left, bottom, width, height) in pixels of a window of this size."""
        left, bottom = round(self.left * width_px), round(self.bottom * height_px)
        right, top = round((self.left + self.width) * width_px), round((self.bottom + self.height) * height_px)
        return left, bottom, max(1, right - left), max(1, top - bottom)


class Lens(NamedTuple):
    """What a camera looks with: a pinhole, `horizon` of the picture's height above its lower edge when level."""

    horizontal_fov_rad: float
    aspect: float  # width to height
    horizon: float = 0.5
    is_mirror: bool = False  # left and right change sides, as in a mirror

    def projection(self) -> Array:
        """Return the projection [4, 4] onto clip space for column vectors."""
        half_width = math.tan(0.5 * self.horizontal_fov_rad)
        half_height = half_width / self.aspect
        matrix = np.zeros((4, 4))
        matrix[0, 0] = (-1.0 if self.is_mirror else 1.0) / half_width
        matrix[1, 1] = 1.0 / half_height
        matrix[1, 2] = 1.0 - 2.0 * self.horizon  # moves the horizon without tilting the camera: uprights stay upright
        matrix[2, 2] = -(FAR_M + NEAR_M) / (FAR_M - NEAR_M)
        matrix[2, 3] = -2.0 * FAR_M * NEAR_M / (FAR_M - NEAR_M)
        matrix[3, 2] = -1.0
        return matrix


class Camera(NamedTuple):
    """Where a camera is, in `map`: `axes` [3, 3] has its forward, left and up axes as columns."""

    eye: Array
    axes: Array

    def view(self, origin: Array) -> Array:
        """Return the matrix [4, 4] from points relative to `origin` [3] to the camera's OpenGL axes."""
        matrix = np.eye(4)
        matrix[:3, :3] = TO_GL @ self.axes.T
        matrix[:3, 3] = matrix[:3, :3] @ (origin - self.eye)
        return matrix


def rotation(yaw_rad: float, pitch_rad: float = 0.0, roll_rad: float = 0.0) -> Array:
    """Return the axes [3, 3] of a body turned by yaw, then pitch, then roll (ISO 8855: pitch nose down is positive)."""
    cy, sy = math.cos(yaw_rad), math.sin(yaw_rad)
    cp, sp = math.cos(pitch_rad), math.sin(pitch_rad)
    cr, sr = math.cos(roll_rad), math.sin(roll_rad)
    return np.array(
        (
            (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
            (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
            (-sp, cp * sr, cp * cr),
        )
    )


def to_pixels(points: Array, camera: Camera, lens: Lens, width_px: int, height_px: int) -> Array:
    """Return where points [N, 3] of `map` land, [N, 2] in pixels from the upper left corner; NaN behind the camera."""
    view = camera.view(np.zeros(3))
    clip = np.column_stack((points, np.ones(len(points)))) @ (lens.projection() @ view).T
    w = np.where(clip[:, 3] > NEAR_M, clip[:, 3], np.nan)
    x, y = clip[:, 0] / w, clip[:, 1] / w
    return np.column_stack((0.5 * (1.0 + x) * width_px, 0.5 * (1.0 - y) * height_px))
