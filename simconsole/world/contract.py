"""What every world must be that the console drives in, its own and those of other packages. Pure: it compares."""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from simconsole.values.height_field import PER_NODE, HeightField
from simconsole.world.drawing import Drawing
from simconsole.world.route import Route
from simconsole.world.world import World

GAP_M: Final = 0.01
"""By how far a route may jump from one of its pieces to the next."""
TIGHTEST_1PM: Final = 2.0
"""The largest curvature of a route."""
_STEP_M: Final = 1e-6


def problems(world: World, again: World) -> list[str]:
    """Return what is wrong with a world, nothing where it keeps the contract.

    Args:
        world: the world.
        again: the same, made a second time: it must be equal to the bit, or a recorded drive would not replay.
    """
    return list(shape(world)) or [*_ground(world), *_drawing(world)] or list(_differs(world, again))


def shape(world: World) -> Iterator[str]:
    """Yield what is wrong with a world before anybody drives in it: its route, which everybody looks at."""
    if not isinstance(world, World):
        yield f"{type(world).__name__}: a World"
        return
    route = world.route
    if not isinstance(route, Route):
        yield f"route: {type(route).__name__}: a Route"
        return
    columns = np.array((route.s, route.x, route.y, route.yaw, route.curvature, route.curvature_rate, route.limit))
    if not np.isfinite(columns).all() or not 0.0 < route.length_m < math.inf:
        yield "route: a value is not finite, or its length is not above 0"
        return
    if not (route.limit > 0.0).all():
        yield "route: limit_mps: not above 0"
    if np.abs(route.curvature).max() > TIGHTEST_1PM:
        yield f"route: curvature: {np.abs(route.curvature).max():.3g} 1/m, at most {TIGHTEST_1PM:g}"
    yield from _joints(route)


def _joints(route: Route) -> Iterator[str]:
    """Look whether each piece begins where the one before ends; of a closed route the first one, too."""
    for s_m in (*route.s[1:].tolist(), *((route.length_m,) if route.closed else ())):
        before, after = route.at(s_m - _STEP_M), route.at(s_m)
        gap_m = math.hypot(after.x_m - before.x_m, after.y_m - before.y_m)
        if gap_m > GAP_M:
            yield f"route: at {s_m:.2f} m it jumps by {gap_m:.3g} m"
            return


def _ground(world: World) -> Iterator[str]:
    field = world.ground
    if field is None:
        return
    if not isinstance(field, HeightField):
        yield f"ground: {type(field).__name__}: a HeightField, or None where it is flat"
        return
    wanted = (int(field.grid.rows), int(field.grid.columns), PER_NODE)
    if field.nodes.dtype != np.float64 or field.nodes.shape != wanted or min(wanted) < PER_NODE:
        yield f"ground: nodes {field.nodes.dtype} {field.nodes.shape}: float64 {wanted}"
    elif not np.isfinite(field.nodes).all() or not np.isfinite(field.grid).all():
        yield "ground: a value is not finite"
    elif not field.grid.cell_m > 0.0 or abs(field.grid.cell_m * field.grid.per_cell_m - 1.0) > 1e-12:
        yield "ground: cell_m and per_cell_m: above 0, one over the other"


def _drawing(world: World) -> Iterator[str]:
    drawing = world.drawing
    if not isinstance(drawing, Drawing):
        yield f"drawing: {type(drawing).__name__}: a Drawing"
        return
    for key, line in _lines(drawing):
        width = 3 if key == "walls" else 2
        if not isinstance(line, np.ndarray) or line.dtype != np.float64 or line.ndim != 2 or line.shape[1] != width:
            yield f"drawing: {key}: a float64 array [N, {width}]"
            return
        if not np.isfinite(line).all():
            yield f"drawing: {key}: a value is not finite"
            return
    if len(drawing.path) < PER_NODE:
        yield "drawing: path: fewer than two points"


def _lines(drawing: Drawing) -> Iterator[tuple[str, np.ndarray]]:
    for key in ("surfaces", "islands", "edges", "centre_lines", "zebras", "stop_lines", "walls"):
        yield from ((key, line) for line in getattr(drawing, key))
    yield "path", drawing.path


def _differs(world: World, again: World) -> Iterator[str]:
    """Look whether a second world is the first one to the bit."""
    if world is again:
        yield "made a second time: the same object: it must be made anew"
        return
    if not np.array_equal(_cells(world.route), _cells(again.route)):
        yield "made a second time: another route"
    if _bytes(world.ground) != _bytes(again.ground):
        yield "made a second time: another ground"
    if [line.tobytes() for _, line in _lines(world.drawing)] != [line.tobytes() for _, line in _lines(again.drawing)]:
        yield "made a second time: another drawing"


def _cells(route: Route) -> np.ndarray:
    return np.array((route.s, route.x, route.y, route.yaw, route.curvature, route.limit))


def _bytes(field: HeightField | None) -> bytes:
    return b"" if field is None else np.array(field.grid).tobytes() + field.nodes.tobytes()
