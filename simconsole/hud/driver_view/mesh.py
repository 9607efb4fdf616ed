"""Meshes for the driver's view: coloured triangles, built from simple shapes."""

import math
from collections.abc import Sequence
from enum import IntEnum
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Colour = tuple[int, int, int]

VERTEX: Final = np.dtype([("position", "<f4", 3), ("normal", "u1", 4), ("colour", "u1", 4)])
"""One vertex, 20 bytes: metres; a unit vector times 127 and 128 more (`encoded`); red, green, blue and `Material`."""
Vertices = NDArray[np.void]


class Material(IntEnum):
    """How a surface answers light."""

    PLAIN = 0
    WALL = 1  # windows in storeys
    GLOWING = 2  # shines by itself, by day as by night
    ROAD = 3  # grain of asphalt
    MEADOW = 4


class Box(NamedTuple):
    """An upright box: centre of its foot, half its length and width, its height, and where its length points."""

    x_m: float
    y_m: float
    z_m: float
    half_length_m: float
    half_width_m: float
    height_m: float
    yaw_rad: float = 0.0


def encoded(normals: Array) -> Array:
    """Return unit vectors as a vertex holds them."""
    return np.asarray(np.rint(127.0 * normals) + 128.0)


def vertices(corners: Array, normals: Array, colour: Colour, material: Material = Material.PLAIN) -> Vertices:
    """Return vertices of triangles: `corners` [N, 3, 3] in m, `normals` [N, 3] of each triangle."""
    made = np.zeros(3 * len(corners), VERTEX)
    made["position"] = corners.reshape(-1, 3)
    made["normal"][:, :3] = np.repeat(encoded(normals), 3, axis=0)
    made["colour"] = (*colour, material)
    return made


def indexed(mesh: Vertices) -> tuple[Vertices, NDArray[np.uint32]]:
    """Return a mesh's different vertices, in the order of the mesh, and for each of its corners which one it is.

    Corners that triangles share are then worked out once, not for each triangle.
    """
    if len(mesh) == 0:
        return mesh, np.zeros(0, np.uint32)
    words = mesh.view("<u4").reshape(len(mesh), -1)
    order = np.lexsort(words.T)
    differs = (words[order[1:]] != words[order[:-1]]).any(axis=1)
    group = np.zeros(len(mesh), np.int64)
    group[order] = np.concatenate(((0,), np.cumsum(differs)))
    first = np.minimum.reduceat(order, np.concatenate(((0,), np.flatnonzero(differs) + 1)))
    kept = np.sort(first)
    return mesh[kept], np.searchsorted(kept, first[group]).astype(np.uint32)


def facets(corners: Array, colour: Colour, material: Material = Material.PLAIN) -> Vertices:
    """Return triangles [N, 3, 3] with the normal of each, anticlockwise seen from its outer side."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    keep = lengths > 1e-12
    return vertices(corners[keep], normals[keep] / lengths[keep, None], colour, material)


def quads(corners: Array, colour: Colour, material: Material = Material.PLAIN) -> Vertices:
    """Return quadrilaterals [N, 4, 3], anticlockwise seen from outside, as two triangles each."""
    return facets(np.concatenate((corners[:, (0, 1, 2)], corners[:, (0, 2, 3)])), colour, material)


def joined(parts: Sequence[Vertices]) -> Vertices:
    """Return several meshes as one."""
    return np.concatenate(parts) if parts else np.zeros(0, VERTEX)


def placed(mesh: Vertices, place_m: tuple[float, float, float], yaw_rad: float, scale: float) -> Vertices:
    """Return a mesh `scale` times as large, turned about z, and moved."""
    made = mesh.copy()
    cosine, sine = math.cos(yaw_rad), math.sin(yaw_rad)
    turn = np.array(((cosine, -sine, 0.0), (sine, cosine, 0.0), (0.0, 0.0, 1.0)))
    made["position"] = scale * (mesh["position"] @ turn.T) + np.array(place_m)
    made["normal"][:, :3] = encoded((mesh["normal"][:, :3].astype(np.float64) - 128.0) / 127.0 @ turn.T)
    return made


def box(place: Box, colour: Colour, roof: Colour | None = None, material: Material = Material.PLAIN) -> Vertices:
    """Return a box without its underside; its roof may have a colour of its own."""
    cosine, sine = math.cos(place.yaw_rad), math.sin(place.yaw_rad)
    along = np.array((cosine, sine)) * place.half_length_m
    across = np.array((-sine, cosine)) * place.half_width_m
    middle = np.array((place.x_m, place.y_m))
    foot = np.array(
        [middle - along - across, middle + along - across, middle + along + across, middle - along + across]
    )
    low = np.column_stack((foot, np.full(4, place.z_m)))
    high = np.column_stack((foot, np.full(4, place.z_m + place.height_m)))
    walls = np.array([(low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]) for i in range(4)])
    return joined([quads(walls, colour, material), quads(high[None], colour if roof is None else roof)])


def upright(line: Array, colour: Colour, thick_m: float = 0.02) -> Vertices:
    """Return thin walls along a line [N, 3]: x, y and the height of each corner; each is as high as its first one."""
    parts = []
    for (x, y, height), (to_x, to_y, _) in pairwise(line.tolist()):
        place = Box(
            x_m=0.5 * (x + to_x), y_m=0.5 * (y + to_y), z_m=0.0,
            half_length_m=0.5 * (math.hypot(to_x - x, to_y - y) + thick_m), half_width_m=0.5 * thick_m,
            height_m=height, yaw_rad=math.atan2(to_y - y, to_x - x),
        )  # fmt: skip
        parts.append(box(place, colour))
    return joined(parts)


def prism(outline: Array, left_m: float, right_m: float, colour: Colour) -> Vertices:
    """Return a convex outline [N, 2] in (x, z) (anticlockwise from the right) between two distances to the left."""
    right = np.column_stack((outline[:, 0], np.full(len(outline), right_m), outline[:, 1]))
    left = np.column_stack((outline[:, 0], np.full(len(outline), left_m), outline[:, 1]))
    after = np.roll(np.arange(len(outline)), -1)
    rim = np.stack((left, left[after], right[after], right), axis=1)
    fan = np.arange(1, len(outline) - 1)
    near = np.stack((np.broadcast_to(right[0], (len(fan), 3)), right[fan], right[fan + 1]), axis=1)
    far = np.stack((np.broadcast_to(left[0], (len(fan), 3)), left[fan + 1], left[fan]), axis=1)
    return joined([quads(rim, colour), facets(np.concatenate((near, far)), colour)])


def cone(x_m: float, y_m: float, feet_m: tuple[float, float], radii_m: tuple[float, float], colour: Colour) -> Vertices:
    """Return an eight-sided upright cylinder or cone between two heights; the second radius may be 0."""
    angles = np.linspace(0.0, math.tau, 9)
    ring = np.column_stack((np.cos(angles), np.sin(angles)))
    middle = np.array((x_m, y_m))
    low, high = (
        np.column_stack((middle + radius * ring, np.full(9, height)))
        for radius, height in zip(radii_m, feet_m, strict=True)
    )
    sides = quads(np.stack((low[:-1], low[1:], high[1:], high[:-1]), axis=1), colour)
    if radii_m[1] <= 0.0:
        return sides
    top = np.array((x_m, y_m, feet_m[1]))
    lid = facets(np.stack((high[:-1], high[1:], np.broadcast_to(top, (8, 3))), axis=1), colour)
    return joined([sides, lid])


def wheel(x_m: float, y_m: float, radius_m: float, width_m: float, colour: Colour, rim: Colour) -> Vertices:
    """Return a wheel that stands on the ground, its axle along y: tyre, and the rim as a disc on both sides."""
    angles = np.linspace(0.0, math.tau, 13)
    tyre = np.column_stack((x_m + radius_m * np.cos(angles), radius_m + radius_m * np.sin(angles)))[:-1]
    hub = np.column_stack((x_m + 0.6 * radius_m * np.cos(angles), radius_m + 0.6 * radius_m * np.sin(angles)))[:-1]
    half = 0.5 * width_m
    return joined(
        [prism(tyre, y_m + half, y_m - half, colour), prism(hub, y_m + half + 0.005, y_m - half - 0.005, rim)]
    )


def ring(centre: Array, right: Array, up: Array, radii_m: tuple[float, float], colour: Colour) -> Vertices:
    """Return a round rim (a torus) about `centre`: distance to the rim's middle, and how thick it is."""
    large, small = radii_m
    around, across = np.linspace(0.0, math.tau, 33), np.linspace(0.0, math.tau, 9)
    normal = np.cross(right, up)
    spokes = np.cos(around)[:, None] * right + np.sin(around)[:, None] * up
    points = (
        centre
        + (large + small * np.cos(across))[None, :, None] * spokes[:, None, :]
        + (small * np.sin(across))[None, :, None] * normal
    )
    corners = np.stack((points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]), axis=2)
    return quads(corners.reshape(-1, 4, 3), colour)


def ribbon(
    line: Array, right_m: float, left_m: float, z_m: float | Array, colour: Colour, material: Material
) -> Vertices:
    """Return a strip along a line [N, 2] between two distances to its left, lying at height `z_m`, facing up."""
    if len(line) < 2:
        return np.zeros(0, VERTEX)
    across = left_of(line)
    z = np.broadcast_to(z_m, len(line))
    right = np.column_stack((line + right_m * across, z))
    left = np.column_stack((line + left_m * across, z))
    return quads(np.stack((right[:-1], right[1:], left[1:], left[:-1]), axis=1), colour, material)


def left_of(line: Array) -> Array:
    """Return unit vectors [N, 2] to the left of a line at each of its points, mitred where it bends."""
    steps = np.diff(line, axis=0)
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    steps = steps[lengths > 0.0] / lengths[lengths > 0.0, None] if (lengths == 0.0).any() else steps / lengths[:, None]
    if len(steps) != len(line) - 1:  # a repeated point has no direction: take its neighbour's
        filled = np.maximum.accumulate(np.where(lengths > 0.0, np.cumsum(lengths > 0.0) - 1, 0))
        steps = steps[filled]
    normals = np.column_stack((-steps[:, 1], steps[:, 0]))
    mean = np.vstack((normals[:1], normals[:-1] + normals[1:], normals[-1:]))
    mean /= np.linalg.norm(mean, axis=1)[:, None]
    beside = np.vstack((normals[:1], normals))
    stretch = np.maximum(0.5, np.sum(mean * beside, axis=1))
    return np.asarray(mean / stretch[:, None])
