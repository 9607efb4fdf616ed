"""Planar path pieces of linear curvature: lines, arcs and clothoids in one formula."""

import math
from typing import Final, NamedTuple

import numpy as np

from simconsole.values.platform import Pose

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_GAUSS: Final = tuple(zip(_NODES.tolist(), _WEIGHTS.tolist(), strict=True))
_TURN_PER_PIECE_RAD: Final = 0.5


class Piece(NamedTuple):
    """A piece of path whose curvature runs linearly over its length (1/m, left positive)."""

    length_m: float
    curvature_start_1pm: float
    curvature_end_1pm: float

    @property
    def turn_rad(self) -> float:
        """Change of heading over the piece."""
        return 0.5 * (self.curvature_start_1pm + self.curvature_end_1pm) * self.length_m

    @property
    def mirrored(self) -> "Piece":
        """The same piece driven from its end: mirror image about the normal at its middle."""
        return Piece(self.length_m, self.curvature_end_1pm, self.curvature_start_1pm)


def travel(pose: Pose, piece: Piece, distance_m: float | None = None) -> Pose:
    """Return the pose after `distance_m` (default: all) of `piece` that starts at `pose`.

    Heading is exact; position is the integral of (cos, sin) of it by 12-point Gauss-Legendre quadrature over parts
    that turn at most 0.5 rad, where its remainder is below 1e-16 of the length.
    """
    length = piece.length_m if distance_m is None else distance_m
    rate = (piece.curvature_end_1pm - piece.curvature_start_1pm) / piece.length_m
    steepest = max(abs(piece.curvature_start_1pm), abs(piece.curvature_end_1pm))
    parts = 1 + int(steepest * abs(length) / _TURN_PER_PIECE_RAD)
    half = 0.5 * length / parts
    x = y = 0.0
    for part in range(parts):
        middle = (2 * part + 1) * half
        for node, weight in _GAUSS:
            u = middle + half * node
            heading = pose.yaw_rad + u * (piece.curvature_start_1pm + 0.5 * rate * u)
            x += weight * math.cos(heading)
            y += weight * math.sin(heading)
    yaw = pose.yaw_rad + length * (piece.curvature_start_1pm + 0.5 * rate * length)
    return Pose(pose.x_m + half * x, pose.y_m + half * y, yaw)


def travel_all(pose: Pose, pieces: tuple[Piece, ...]) -> Pose:
    """Return the pose after all `pieces`, one after the other."""
    for piece in pieces:
        pose = travel(pose, piece)
    return pose


def centre(pose: Pose, radius_m: float) -> tuple[float, float]:
    """Return the centre (m) of a left turn of `radius_m` from `pose`."""
    return pose.x_m - radius_m * math.sin(pose.yaw_rad), pose.y_m + radius_m * math.cos(pose.yaw_rad)
