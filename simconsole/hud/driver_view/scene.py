"""The scene of a drive: what stands still, cut into pieces so that only what may be seen is drawn."""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.hud.driver_view.hills import LAYER_M, draped, heights, land, lifted
from simconsole.hud.driver_view.mesh import VERTEX, Box, Colour, Material, Vertices, box, cone, joined, quads, upright
from simconsole.hud.driver_view.road import MEADOW, occupancy_of, road_meshes
from simconsole.hud.driver_view.surroundings import NO_SURROUNDINGS, Limits, surroundings
from simconsole.hud.driver_view.vehicle_body import Size, VehicleMeshes, vehicle_meshes
from simconsole.values.height_field import HeightField
from simconsole.world.drawing import Drawing
from simconsole.world.drawing_layers import Light

Array = NDArray[np.float64]

PIECE_M: Final = 120.0
POST: Final[Colour] = (66, 70, 74)
WALL: Final[Colour] = (206, 200, 190)
CASE: Final[Colour] = (22, 24, 26)
LAMPS: Final[tuple[Colour, ...]] = ((232, 44, 36), (240, 168, 24), (46, 206, 106))
LAMP_NAMES: Final = ("red", "amber", "green")
LAMP_HEIGHTS_M: Final = (3.05, 2.75, 2.45)
_OFF_M: Final = 0.115
_LIT_OFF_M: Final = 0.125


class Pieces(NamedTuple):
    """Vertices sorted by place: piece i is `length[i]` vertices from `first[i]`, inside a ball about `centre[i]`."""

    vertices: Vertices
    first: NDArray[np.int64]
    length: NDArray[np.int64]
    centre: Array  # [N, 3] in m
    radius: Array  # [N] in m


class Models(NamedTuple):
    """What a lab has brought: things in `map`, and the vehicle's body in base_link; without vertices: none."""

    world: Vertices
    body: Vertices


NO_MESH: Final = np.zeros(0, VERTEX)
NO_MODELS: Final = Models(NO_MESH, NO_MESH)


class ViewScene(NamedTuple):
    """All that a renderer needs before the first frame."""

    layers: tuple[Pieces, ...]  # flat, from the ground up
    solids: Pieces
    vehicle: VehicleMeshes
    size: Size
    ground: HeightField | None = None
    lights: tuple[Light, ...] = ()

    def height_m(self, x_m: float, y_m: float) -> float:
        """Return the height of the ground at a place."""
        return 0.0 if self.ground is None else float(heights(self.ground, np.array(((x_m, y_m),)))[0])


class Part(NamedTuple):
    """What stands still and is of one kind; flat parts lie in layers, 0 the lowest."""

    name: str
    mesh: Vertices
    layer: int | None = None  # None: it has height
    signal: tuple[str, int] | None = None  # of a lamp: which link of which signal it shows


def world_parts(drawing: Drawing | None, limits: Limits, models: Vertices = NO_MESH) -> tuple[Part, ...]:
    """Return all that stands still: of a world, or an empty plain with a grid of lines where a session has none.

    Args:
        drawing: The world.
        limits: Of its road.
        models: What a lab has put there.
    """
    own = _own_parts(drawing, limits)
    return (*own, Part("models", models)) if len(models) else own


def _own_parts(drawing: Drawing | None, limits: Limits) -> tuple[Part, ...]:
    if drawing is None:
        land, grid = _plain()
        return Part("land", land, 0), Part("grid", grid, 1)
    taken = occupancy_of(drawing)
    road = road_meshes(drawing, taken, limits)
    told = bool(drawing.walls)  # an arena, or a map with buildings: nothing is made up beside what it says
    beside = NO_SURROUNDINGS if told else surroundings(drawing.path, limits, taken, drawing.ground)
    lamps = [
        Part(f"signal_{index}_{name}", _lamp(light, height_m, _unlit(colour)), signal=_told(light))
        for index, light in enumerate(drawing.lights)
        for name, height_m, colour in zip(LAMP_NAMES, LAMP_HEIGHTS_M, LAMPS, strict=True)
    ]
    walls = [Part("walls", joined([upright(line, WALL) for line in drawing.walls]))] if told else []
    parts = (
        Part("land", road.land, 0),
        Part("verges", road.verges, 1),
        Part("asphalt", road.asphalt, 1),
        Part("islands", road.islands, 2),
        Part("markings", road.markings, 3),
        Part("crossings", road.crossings, 3),
        Part("stop_lines", road.stop_lines, 3),
        Part("kerbs", road.kerbs),
        *walls,
        Part("signs", beside.signs),
        Part("buildings", beside.houses),
        Part("trees", beside.trees),
        Part("signals", joined([_signal_post(light) for light in drawing.lights])),
        *lamps,
    )
    return parts if drawing.ground is None else tuple(_on_ground(part, drawing.ground) for part in parts)


def _on_ground(part: Part, ground: HeightField) -> Part:
    """Return a part of a flat world as it lies on ground with height; buildings are there already."""
    if part.name == "land":
        return part._replace(mesh=land(ground, MEADOW))
    if part.layer is not None or part.name == "kerbs":
        return part._replace(mesh=draped(part.mesh, ground, LAYER_M * (part.layer or 0)))
    return part if part.name == "buildings" else part._replace(mesh=lifted(part.mesh, ground))


def view_scene(drawing: Drawing | None, limits: Limits, size: Size, models: Models = NO_MODELS) -> ViewScene:
    """Return the scene of a world, or of an empty plain where a session has none, and of a vehicle."""
    parts = world_parts(drawing, limits, models.world)
    vehicle = vehicle_meshes(size)
    ground = None if drawing is None else drawing.ground
    heights = sorted({part.layer for part in parts if part.layer is not None})
    layers = [joined([part.mesh for part in parts if part.layer == height]) for height in heights]
    solids = joined([part.mesh for part in parts if part.layer is None])
    return ViewScene(
        layers=tuple(pieces(layer) for layer in layers),
        solids=pieces(solids),
        vehicle=vehicle._replace(body=models.body) if len(models.body) else vehicle,
        size=size,
        ground=ground,
        lights=() if drawing is None else drawing.lights,
    )


def pieces(mesh: Vertices) -> Pieces:
    """Return a mesh cut into squares of PIECE_M by the middles of its triangles."""
    if len(mesh) == 0:
        none = np.zeros(0, np.int64)
        return Pieces(np.zeros(0, VERTEX), none, none, np.zeros((0, 3)), np.zeros(0))
    corners = mesh["position"].reshape(-1, 3, 3).astype(np.float64)
    cells = np.floor(corners.mean(axis=1)[:, :2] / PIECE_M).astype(np.int64)
    order = np.lexsort((cells[:, 1], cells[:, 0]))
    cells, corners = cells[order], corners[order]
    starts = np.concatenate(((0,), np.flatnonzero((np.diff(cells, axis=0) != 0).any(axis=1)) + 1))
    counts = np.diff(np.append(starts, len(cells)))
    low = np.minimum.reduceat(corners.min(axis=1), starts)
    high = np.maximum.reduceat(corners.max(axis=1), starts)
    return Pieces(
        vertices=mesh.reshape(-1, 3)[order].reshape(-1),
        first=3 * starts,
        length=3 * counts,
        centre=0.5 * (low + high),
        radius=0.5 * np.linalg.norm(high - low, axis=1),
    )


def in_sight(part: Pieces, view_projection: Array, reach_m: float, eye: Array) -> list[tuple[int, int]]:
    """Return (first vertex, count) of the runs that a camera may see, of pieces nearer than `reach_m`.

    Args:
        part: the pieces.
        view_projection: from `map` to clip space [4, 4].
        reach_m: how far anything is seen (fog).
        eye: the camera's place [3].
    """
    if len(part.first) == 0:
        return []
    planes = np.vstack([view_projection[3] + sign * view_projection[axis] for axis in (0, 1) for sign in (1.0, -1.0)])
    planes = planes / np.linalg.norm(planes[:, :3], axis=1)[:, None]
    distance = part.centre @ planes[:, :3].T + planes[:, 3]
    seen = (distance > -part.radius[:, None]).all(axis=1)
    away = part.centre - eye
    seen &= np.einsum("ij,ij->i", away, away) < (part.radius + reach_m) ** 2
    indices = np.flatnonzero(seen)
    if len(indices) == 0:
        return []
    last = np.append(indices[1:] - indices[:-1] != 1, True)
    first = np.append(True, last[:-1])
    starts = part.first[indices[first]]
    ends = part.first[indices[last]] + part.length[indices[last]]
    return list(zip(starts.tolist(), (ends - starts).tolist(), strict=True))


def _signal_post(light: Light) -> Vertices:
    """Return a traffic light's post and case."""
    place = Box(
        x_m=light.x_m, y_m=light.y_m, z_m=2.3, half_length_m=0.11, half_width_m=0.17, height_m=1.0,
        yaw_rad=light.yaw_rad,
    )  # fmt: skip
    return joined([cone(light.x_m, light.y_m, (0.0, 2.3), (0.06, 0.05), POST), box(place, CASE)])


def lit_lamps() -> tuple[Vertices, ...]:
    """Return the lamps that shine, red, amber and green, of a light at the origin of `map` that faces along -x."""
    here = Light(0.0, 0.0, 0.0)
    return tuple(
        _lamp(here, height_m, colour, Material.GLOWING, _LIT_OFF_M)
        for height_m, colour in zip(LAMP_HEIGHTS_M, LAMPS, strict=True)
    )


def _told(light: Light) -> tuple[str, int] | None:
    return None if light.program is None else (light.program.signal, light.program.link)


def _unlit(colour: Colour) -> Colour:
    red, green, blue = colour
    return red // 3, green // 3, blue // 3


def _lamp(
    light: Light, height_m: float, colour: Colour, material: Material = Material.PLAIN, off_m: float = _OFF_M
) -> Vertices:
    """Return one of its lamps, facing those who come, `off_m` before the middle of its case."""
    cosine, sine = np.cos(light.yaw_rad), np.sin(light.yaw_rad)
    back, left = np.array((-cosine, -sine, 0.0)), np.array((-sine, cosine, 0.0))
    up = np.array((0.0, 0.0, 1.0))
    centre = np.array((light.x_m, light.y_m, height_m)) + off_m * back
    corners = [0.1 * (a * left + b * up) + centre for a, b in ((1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0))]
    return quads(np.array([corners]), colour, material)


def _plain() -> tuple[Vertices, Vertices]:
    """Return an empty plain, and lines every 10 m on it for 200 m around the origin."""
    reach, wide = 1500.0, 0.05
    land = np.array([((-reach, -reach, 0.0), (reach, -reach, 0.0), (reach, reach, 0.0), (-reach, reach, 0.0))])
    at = np.arange(-200.0, 200.1, 10.0)
    lines = []
    for value in at.tolist():
        lines.append(
            (
                (-200.0, value - wide, 0.0),
                (200.0, value - wide, 0.0),
                (200.0, value + wide, 0.0),
                (-200.0, value + wide, 0.0),
            )
        )
        lines.append(
            (
                (value - wide, -200.0, 0.0),
                (value + wide, -200.0, 0.0),
                (value + wide, 200.0, 0.0),
                (value - wide, 200.0, 0.0),
            )
        )
    return quads(land, MEADOW, Material.MEADOW), quads(np.array(lines), (150, 156, 150))
