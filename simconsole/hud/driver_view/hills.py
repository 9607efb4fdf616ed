"""A flat scene laid on ground with height: roads draped over it, what stands on it lifted, the land itself."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from simconsole.hud.driver_view.mesh import Colour, Material, Vertices, encoded, facets
from simconsole.values.height_field import HeightField, spline_at

Array = NDArray[np.float64]

LONGEST_M: Final = 6.0
"""Edge of a draped triangle: over a vertical curve of 500 m radius the middle of such a chord is 9 mm off."""
LAYER_M: Final = 0.012
"""Between two layers: more than what two meshes of the same ground differ by."""
LAND_CELL_M: Final = 12.0
SUNK_M: Final = 0.25
"""By how much the land lies below the road's own mesh: its cells are too wide to follow a road to the centimetre."""
FAR_M: Final = 3000.0


def heights(ground: HeightField, points: Array) -> Array:
    """Return the heights [N] of the ground, without its kerbs, at points [N, 2 or 3]."""
    return spline_at(ground, 0, points[:, 0], points[:, 1])


def lifted(mesh: Vertices, ground: HeightField, above_m: float = 0.0) -> Vertices:
    """Return a mesh with each vertex as much higher as the ground below it."""
    raised = mesh.copy()
    raised["position"][:, 2] += heights(ground, mesh["position"].astype(np.float64)) + above_m
    return raised


def stood(mesh: Vertices, ground: HeightField | None) -> Vertices:
    """Return one upright thing with its foot at the lowest ground below it; flat ground (None) leaves it."""
    if ground is None or len(mesh) == 0:
        return mesh
    raised = mesh.copy()
    raised["position"][:, 2] += heights(ground, mesh["position"].astype(np.float64)).min()
    return raised


def draped(mesh: Vertices, ground: HeightField, above_m: float) -> Vertices:
    """Return a flat mesh as it lies on the ground, in triangles small enough to follow it."""
    if len(mesh) == 0:
        return mesh
    small = lifted(divided(mesh, LONGEST_M), ground, above_m)
    corners = small["position"].reshape(-1, 3, 3).astype(np.float64)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    small["normal"][:, :3] = np.repeat(encoded(normals), 3, axis=0)
    return small


def divided(mesh: Vertices, longest_m: float) -> Vertices:
    """Return a mesh whose triangles have no edge above `longest_m`: the longest edge is halved until that is so.

    Two triangles with a common edge halve it at the same place, so no gaps open.
    """
    done: list[Vertices] = []
    rest = mesh.reshape(-1, 3)
    while len(rest):
        corners = rest["position"][:, :, :2].astype(np.float64)
        edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
        long = edges.max(axis=1) > longest_m
        done.append(rest[~long])
        rest, edges = rest[long], edges[long]
        first = edges.argmax(axis=1)
        rows = np.arange(len(rest))
        a, b, c = (rest[rows, (first + turn) % 3] for turn in range(3))
        middle = a.copy()
        middle["position"] = 0.5 * (a["position"] + b["position"])
        rest = np.concatenate((np.stack((a, middle, c), axis=1), np.stack((middle, b, c), axis=1)))
    return np.concatenate(done).reshape(-1)


def land(ground: HeightField, colour: Colour) -> Vertices:
    """Return the land: the field in cells of LAND_CELL_M, and level ground around it to beyond what fog hides."""
    grid = ground.grid
    axes = []
    for start, count in ((grid.from_x_m, grid.columns), (grid.from_y_m, grid.rows)):
        end = start + grid.cell_m * (count - 1.0)
        inner = np.linspace(start, end, max(2, round((end - start) / LAND_CELL_M)))
        outer = np.array((FAR_M, 1200.0, 400.0))
        axes.append(np.concatenate((start - outer, inner, end + outer[::-1])))
    corner = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    height = heights(ground, corner.reshape(-1, 2)).reshape(corner.shape[:2]) - SUNK_M
    points = np.concatenate((corner, height[..., None]), axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    triangles = np.stack((np.stack((a, b, c), axis=2), np.stack((a, c, d), axis=2)), axis=2)
    return facets(triangles.reshape(-1, 3, 3), colour, Material.MEADOW)
