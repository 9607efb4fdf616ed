"""The world and the car as shapes for the operators: triangles, lines and boxes in `map`. Pure arrays, no rerun."""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.height_field import HeightField, spline_at
from simconsole.values.signals import Mode
from simconsole.world.drawing import Drawing
from simconsole.world.triangles import Indices, triangulate

Array = NDArray[np.float64]
Colour = tuple[int, int, int]

ASPHALT: Final[Colour] = (52, 56, 62)
GROUND: Final[Colour] = (30, 38, 34)
GREEN: Final[Colour] = (58, 92, 62)
PAINT: Final[Colour] = (226, 228, 230)
MAP_EDGE: Final[Colour] = (84, 92, 102)
THEORETICAL: Final[Colour] = (120, 140, 165)
WALL: Final[Colour] = (150, 142, 128)
BODY: Final[Colour] = (214, 126, 44)
GLASS: Final[Colour] = (60, 70, 84)
LAMPS: Final[tuple[Colour, ...]] = ((150, 40, 40), (150, 110, 30), (40, 130, 70))

MODE_COLOURS: Final[dict[float, Colour]] = {
    Mode.PARKED: (128, 138, 150),
    Mode.MANUAL: (226, 232, 238),
    Mode.SHARED: (150, 222, 176),
    Mode.AUTONOMOUS: (54, 217, 123),
    Mode.TAKEOVER_REQUESTED: (255, 176, 32),
    Mode.MINIMAL_RISK: (255, 110, 60),
    Mode.STOPPED: (98, 108, 120),
    Mode.EMERGENCY_STOP: (235, 45, 60),
}
"""The driven path's colour says who drove; the mode lane names it."""

DASH_M: Final = 3.0
GAP_M: Final = 4.0
LIFT_M: Final = 0.02
"""Height between two layers of paint, so that the nearer one is seen."""
LAND_CELL_M: Final = 10.0
LAND_SUNK_M: Final = 0.4
"""Its cells are too wide to follow a road's hollows: the land must not cover the road."""
GROUND_MARGIN_M: Final = 400.0
CAR_LENGTH_M: Final = 4.0
POST_M: Final = 3.4
HEAD_M: Final = 0.9


class Mesh(NamedTuple):
    """Triangles: vertices [N, 3] in m and their indices [M, 3]."""

    vertices: Array
    triangles: Indices


class Solid(NamedTuple):
    """A box along the axes of its own frame, in m."""

    centre: tuple[float, float, float]
    half_size: tuple[float, float, float]
    colour: Colour


class Dimensions(NamedTuple):
    """A vehicle's outer size in m; base_link is `rear_overhang_m` from its rear end."""

    length_m: float
    width_m: float
    height_m: float
    rear_overhang_m: float

    @property
    def is_ball(self) -> bool:
        """Whether it is as long as wide as high."""
        return self.length_m == self.width_m == self.height_m

    @property
    def scale(self) -> float:
        """Size against a car: how much nearer the camera of a small robot stands."""
        return min(1.0, max(0.1, self.length_m / CAR_LENGTH_M))


class WorldShapes(NamedTuple):
    """What stands still: everything to draw of a course."""

    ground: Mesh
    surfaces: Mesh
    islands: Mesh
    paint: Mesh
    edges: tuple[Array, ...]
    centre_dashes: tuple[Array, ...]
    light_posts: Array
    light_lamps: Array
    path: Array
    walls: Mesh
    wall_lines: tuple[Array, ...]


def world_shapes(drawing: Drawing) -> WorldShapes:
    """Return the shapes of a course; lines come as [N, 3]."""
    flat = _flat_shapes(drawing)
    return flat if drawing.ground is None else _on_ground(flat, drawing.ground)


def _on_ground(flat: WorldShapes, ground: HeightField) -> WorldShapes:
    """Return the shapes of a flat world as they lie on ground with height."""

    def high(points: Array) -> Array:
        up = spline_at(ground, 0, points[..., 0], points[..., 1])
        return points + np.stack((np.zeros_like(up), np.zeros_like(up), up), axis=-1)

    def high_mesh(of: Mesh) -> Mesh:
        return of._replace(vertices=high(of.vertices))

    return flat._replace(
        ground=high_mesh(_land(ground)),
        surfaces=high_mesh(flat.surfaces),
        islands=high_mesh(flat.islands),
        paint=high_mesh(flat.paint),
        edges=tuple(high(line) for line in flat.edges),
        centre_dashes=tuple(high(dash) for dash in flat.centre_dashes),
        path=high(flat.path),
    )


def _land(ground: HeightField) -> Mesh:
    """Return the land of a field in cells of LAND_CELL_M, a little below the roads."""
    grid = ground.grid
    x, y = (
        np.linspace(start, start + grid.cell_m * (count - 1.0), max(2, round(grid.cell_m * count / LAND_CELL_M)))
        for start, count in ((grid.from_x_m, grid.columns), (grid.from_y_m, grid.rows))
    )
    places = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    first = (np.arange(len(x) - 1)[:, None] * len(y) + np.arange(len(y) - 1)).ravel()
    corners = np.stack((first, first + len(y), first + len(y) + 1, first, first + len(y) + 1, first + 1), axis=1)
    return Mesh(lifted(places, -LAND_SUNK_M), corners.reshape(-1, 3).astype(np.uint32))


def _flat_shapes(drawing: Drawing) -> WorldShapes:
    """Return the shapes as they lie on the plane; lights stand on the ground as it is."""
    posts, lamps = light_places(drawing)
    return WorldShapes(
        ground=mesh((_ground(drawing.path),), -5.0 * LIFT_M),
        surfaces=mesh(drawing.surfaces, 0.0),
        islands=mesh(drawing.islands, LIFT_M),
        paint=mesh((*drawing.zebras, *drawing.stop_lines), 2.0 * LIFT_M),
        edges=tuple(lifted(line, 2.0 * LIFT_M) for line in drawing.edges),
        centre_dashes=tuple(lifted(dash, 2.0 * LIFT_M) for line in drawing.centre_lines for dash in dashes(line)),
        light_posts=posts,
        light_lamps=lamps,
        path=lifted(drawing.path, 3.0 * LIFT_M),
        walls=upright(drawing.walls),
        wall_lines=tuple(lifted(line[:, :2], 2.0 * LIFT_M) for line in drawing.walls),
    )


def lifted(line: Array, z_m: float) -> Array:
    """Return [N, 2] as [N, 3] at one height."""
    return np.column_stack((line, np.full(len(line), z_m)))


def raised(points: Array, height_m: float) -> Array:
    """Return points [N, 3] a little higher."""
    return np.asarray(points + np.array((0.0, 0.0, height_m)))


def on_map(points: Array) -> Array:
    """Return points [N, 2 or 3] for a picture whose y axis points down: north stays up."""
    return np.column_stack((points[:, 0], -points[:, 1]))


def mesh(polygons: tuple[Array, ...], z_m: float) -> Mesh:
    """Return the triangles of simple polygons [N, 2] (closed by this function), all at one height."""
    vertices: list[Array] = []
    triangles: list[Indices] = []
    count = 0
    for polygon in polygons:
        vertices.append(lifted(polygon, z_m))
        triangles.append(triangulate(polygon) + np.uint32(count))
        count += len(polygon)
    if not vertices:
        return Mesh(np.empty((0, 3)), np.empty((0, 3), np.uint32))
    return Mesh(np.vstack(vertices), np.vstack(triangles))


def upright(lines: tuple[Array, ...]) -> Mesh:
    """Return walls along lines [N, 3] (x, y and height of each corner), two triangles for each piece."""
    pieces = (
        np.concatenate([np.stack((line[:-1], line[1:]), axis=1) for line in lines]) if lines else np.empty((0, 2, 3))
    )
    feet = pieces * (1.0, 1.0, 0.0)
    corners = np.stack((feet[:, 0], feet[:, 1], pieces[:, 1], pieces[:, 0]), axis=1).reshape(-1, 3)
    halves = np.array(((0, 1, 2), (0, 2, 3)), dtype=np.uint32)
    first = 4 * np.arange(len(pieces), dtype=np.uint32)
    return Mesh(corners, (first[:, None, None] + halves).reshape(-1, 3))


def dashes(line: Array) -> list[Array]:
    """Return the dashes of a line [N, 2]: DASH_M painted, GAP_M not."""
    steps = np.hypot(*np.diff(line, axis=0).T)
    way = np.concatenate(((0.0,), np.cumsum(steps)))
    found: list[Array] = []
    start = 0.0
    while start + 0.5 * DASH_M < way[-1]:
        at = np.array((start, start + 0.5 * DASH_M, min(start + DASH_M, float(way[-1]))))
        found.append(np.column_stack((np.interp(at, way, line[:, 0]), np.interp(at, way, line[:, 1]))))
        start += DASH_M + GAP_M
    return found


def _ground(path: Array) -> Array:
    """Return the rectangle of land around the course."""
    (west, south), (east, north) = path.min(axis=0) - GROUND_MARGIN_M, path.max(axis=0) + GROUND_MARGIN_M
    return np.array(((west, south), (east, south), (east, north), (west, north)))


def light_places(drawing: Drawing) -> tuple[Array, Array]:
    """Return post feet [N, 3] and lamps [N, 3, 3] (red, amber, green) of the traffic lights of a drawing."""
    lights = np.array([light[:3] for light in drawing.lights]).reshape(-1, 3)
    up = np.zeros(len(lights))
    if drawing.ground is not None:
        up = spline_at(drawing.ground, 0, lights[:, 0], lights[:, 1])
    posts = np.column_stack((lights[:, :2], up))
    # A light faces the traffic: its lamps sit on the side from which that traffic comes.
    face = posts - 0.22 * np.column_stack((np.cos(lights[:, 2]), np.sin(lights[:, 2]), np.zeros(len(lights))))
    heights = (POST_M + 0.3, POST_M, POST_M - 0.3)
    lamps = np.stack([raised(face, height) for height in heights], axis=1)
    return posts, lamps


def car_solids(size: Dimensions) -> tuple[Solid, ...]:
    """Return the car's body and cabin in the frame of base_link."""
    middle = 0.5 * size.length_m - size.rear_overhang_m
    width = 0.5 * size.width_m
    low = 0.6 * size.height_m
    clearance = 0.18 * size.height_m
    body = Solid((middle, 0.0, 0.5 * (low + clearance)), (0.5 * size.length_m, width, 0.5 * (low - clearance)), BODY)
    high = 0.5 * (size.height_m - low)
    at = (middle - 0.06 * size.length_m, 0.0, low + high)
    return body, Solid(at, (0.27 * size.length_m, 0.9 * width, high), GLASS)
