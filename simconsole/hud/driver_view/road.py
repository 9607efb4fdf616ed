"""The road as meshes: asphalt, kerbs, pavement and paint, in layers from the ground up."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.hud.driver_view.mesh import Colour, Material, Vertices, facets, joined, left_of, quads, ribbon
from simconsole.hud.driver_view.occupancy import Occupancy
from simconsole.hud.driver_view.surroundings import Limits, in_town
from simconsole.world.drawing import Drawing
from simconsole.world.triangles import triangulate

Array = NDArray[np.float64]

ASPHALT: Final[Colour] = (74, 77, 82)
PAINT: Final[Colour] = (232, 233, 228)
KERB: Final[Colour] = (168, 166, 160)
PAVEMENT: Final[Colour] = (140, 138, 134)
GRAVEL: Final[Colour] = (128, 120, 104)
MEADOW: Final[Colour] = (88, 116, 62)
LAWN: Final[Colour] = (80, 124, 66)

LINE_M: Final = 0.12  # width of a painted line (RMS, German guidelines for markings: narrow line)
DASH_M: Final = 3.0
GAP_M: Final = 6.0  # (RMS: built-up areas, dash to gap 1:2)
KERB_HEIGHT_M: Final = 0.12
KERB_WIDTH_M: Final = 0.15
PAVEMENT_M: Final = 2.2
VERGE_M: Final = 1.5
STATION_STEP: Final = 10
LAND_M: Final = 3000.0  # from the course to the rim of the land
PROBE_M: Final = 0.9
THIN_M: Final = 0.005
THIN_RUN: Final = 32


class RoadMeshes(NamedTuple):
    """All of a road; everything but the kerbs is flat."""

    land: Vertices
    asphalt: Vertices
    islands: Vertices
    markings: Vertices
    crossings: Vertices
    stop_lines: Vertices
    verges: Vertices
    kerbs: Vertices


def occupancy_of(drawing: Drawing) -> Occupancy:
    """Return the ground that roads and their islands take."""
    polygons = (*drawing.surfaces, *drawing.islands)
    everything = np.vstack((*polygons, drawing.path))
    grid = Occupancy(everything.min(axis=0), everything.max(axis=0))
    for polygon in polygons:
        grid.add(polygon, triangulate(polygon))
    return grid


def road_meshes(drawing: Drawing, taken: Occupancy, limits: Limits = ()) -> RoadMeshes:
    """Return a drawing's meshes.

    Args:
        drawing: The world.
        taken: The road's ground, by which a kerb finds its outer side.
        limits: Along the drawing's path; a road outside of towns has no kerbs but verges.
    """
    borders = [_border(line, taken, _in_town(drawing.path, limits, line)) for line in drawing.edges]
    dashes = [dash for line in drawing.centre_lines for dash in dashes_of(line)]
    lines = [thinned(line) for line in (*drawing.edges, *dashes)]
    return RoadMeshes(
        land=_land(drawing.path),
        asphalt=joined([flat(polygon, ASPHALT, Material.ROAD) for polygon in drawing.surfaces]),
        islands=joined([flat(polygon, LAWN, Material.MEADOW) for polygon in drawing.islands]),
        markings=joined([ribbon(line, -0.5 * LINE_M, 0.5 * LINE_M, 0.0, PAINT, Material.PLAIN) for line in lines]),
        crossings=joined([flat(polygon, PAINT) for polygon in drawing.zebras]),
        stop_lines=joined([flat(polygon, PAINT) for polygon in drawing.stop_lines]),
        verges=joined([verge for verge, _ in borders]),
        kerbs=joined([kerb for _, kerb in borders]),
    )


def flat(polygon: Array, colour: Colour, material: Material = Material.PLAIN) -> Vertices:
    """Return a simple polygon [N, 2] lying on the ground."""
    points = np.column_stack((polygon, np.zeros(len(polygon))))
    corners = points[triangulate(polygon)]
    turned = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] < 0.0
    corners[turned] = corners[turned][:, ::-1]
    return facets(corners, colour, material)


def thinned(line: Array) -> Array:
    """Return a line [N, 2] without the points that lie within THIN_M of it anyway (Douglas and Peucker 1973).

    One point in THIN_RUN stays in any case, so that no part is much longer than a piece of the scene.
    """
    keep = np.zeros(len(line), dtype=bool)
    keep[::THIN_RUN] = keep[-1:] = True
    ends = np.flatnonzero(keep)
    open_runs = list(pairwise(ends.tolist()))
    while open_runs:
        start, end = open_runs.pop()
        along = line[end] - line[start]
        away = line[start + 1 : end] - line[start]
        if len(away) == 0:
            continue
        length = float(np.hypot(*along))
        across = np.abs(away @ np.array((-along[1], along[0]))) / length if length > 0.0 else np.hypot(*away.T)
        far = int(across.argmax())
        if across[far] > THIN_M:
            middle = start + 1 + far
            keep[middle] = True
            open_runs += [(start, middle), (middle, end)]
    return line[keep]


def dashes_of(line: Array) -> list[Array]:
    """Return the dashes of a line [N, 2], each with the line's own points between its ends."""
    way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    found = []
    for start in np.arange(0.5 * GAP_M, way[-1] - 0.5 * DASH_M, DASH_M + GAP_M).tolist():
        end = min(start + DASH_M, float(way[-1]))
        at = np.array((start, *way[(way > start) & (way < end)], end))
        found.append(np.column_stack((np.interp(at, way, line[:, 0]), np.interp(at, way, line[:, 1]))))
    return found


def _in_town(path: Array, limits: Limits, line: Array) -> NDArray[np.bool_]:
    """Return for each point [N, 2] of a line whether the path has a town's limit where it is nearest."""
    sparse = path[::STATION_STEP]
    way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(path, axis=0).T))))[::STATION_STEP]
    if len({bool(town) for town in in_town(limits, way)}) == 1:
        return np.broadcast_to(in_town(limits, way[:1]), len(line))
    away = (line[:, None, :] - sparse[None, :, :]) ** 2
    return in_town(limits, way[away.sum(axis=2).argmin(axis=1)])


def _border(line: Array, taken: Occupancy, town: NDArray[np.bool_]) -> tuple[Vertices, Vertices]:
    """Return the verge, and kerb and pavement, along an edge of the road, where its outer side is free."""
    if len(line) < 2:
        return joined([]), joined([])
    across = left_of(line)
    verges: list[Vertices] = []
    kerbs: list[Vertices] = []
    for side in (-1.0, 1.0):
        free = ~taken.is_taken(line + side * PROBE_M * across)
        for start, end in _runs(free & town):
            part = thinned(line[start:end])
            kerbs += _kerb_part(part, left_of(part), side)
        for start, end in _runs(free & ~town):
            right, left = sorted((0.5 * LINE_M * side, VERGE_M * side))
            verges.append(ribbon(thinned(line[start:end]), right, left, 0.0, GRAVEL, Material.ROAD))
    return joined(verges), joined(kerbs)


def _kerb_part(line: Array, across: Array, side: float) -> Sequence[Vertices]:
    """Return face, top and pavement of a kerb on one side of a line: 1 left, -1 right."""
    offsets = (0.5 * LINE_M, 0.5 * LINE_M + KERB_WIDTH_M, 0.5 * LINE_M + KERB_WIDTH_M + PAVEMENT_M)
    foot, face, back = (line + side * offset * across for offset in offsets)
    low, inner, top, rim = (
        np.column_stack((points, np.full(len(line), height)))
        for points, height in ((foot, 0.0), (foot, KERB_HEIGHT_M), (face, KERB_HEIGHT_M), (back, KERB_HEIGHT_M))
    )
    ground = rim - (0.0, 0.0, KERB_HEIGHT_M)
    strips = ((low, inner, KERB), (inner, top, KERB), (top, rim, PAVEMENT), (rim, ground, PAVEMENT))
    made = []
    for near, far, colour in strips:
        corners = np.stack((near[:-1], near[1:], far[1:], far[:-1]), axis=1)
        made.append(quads(corners if side > 0.0 else corners[:, ::-1], colour))
    return made


def _runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return (start, end) of every run of at least two True."""
    edges = np.flatnonzero(np.diff(np.concatenate(((False,), mask, (False,))).astype(int)))
    return [(start, end) for start, end in edges.reshape(-1, 2).tolist() if end - start >= 2]


def _land(path: Array) -> Vertices:
    """Return meadow around the course to beyond what fog lets through."""
    (west, south), (east, north) = path.min(axis=0) - LAND_M, path.max(axis=0) + LAND_M
    x, y = np.linspace(west, east, 25), np.linspace(south, north, 25)
    corner = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    flat_land = np.concatenate((corner, np.zeros((*corner.shape[:2], 1))), axis=-1)
    cells = np.stack((flat_land[:-1, :-1], flat_land[1:, :-1], flat_land[1:, 1:], flat_land[:-1, 1:]), axis=2)
    return quads(cells.reshape(-1, 4, 3), MEADOW, Material.MEADOW)
