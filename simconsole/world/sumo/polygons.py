"""Read fixed things from SUMO's `.poly.xml`: buildings, walls, cones as polygons, trees as points, by types."""

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from simconsole.world.roads.road_map import BUILDING, CONE, TREE, WALL, Array, Obstacle, Skipped
from simconsole.world.sumo.net_checks import MAX_PLACE_M, Unfit, number, points
from simconsole.world.sumo.xml_guard import Element, read_elements, shown

MAX_ROUND_M: Final = 100_000.0
"""Of one outline; of all of them together 100 times as much."""
TRUNK_M: Final = 0.25
"""Radius of a tree's trunk."""
_MAX_TOLD: Final = 100
_SOLID: Final = {
    "building": BUILDING,
    "cone": CONE,
    "tree": TREE,
    "wall": WALL,
    "fence": WALL,
    "barrier": WALL,
    "guard_rail": WALL,
}
"""By a word of the type, as polyconvert writes types of OpenStreetMap (`building.house`, `natural.tree`)."""


def read_polygons(content: bytes, origin: str) -> tuple[tuple[Obstacle, ...], tuple[Skipped, ...]]:
    """Return the fixed things of a file, and what was not read.

    Raises:
        ProfileError: not XML, or hostile.
    """
    found: list[Obstacle] = []
    skipped: list[Skipped] = []
    left_m = 100.0 * MAX_ROUND_M

    def take(element: Element) -> None:
        nonlocal left_m
        try:
            read = _READERS.get(element.name)
            if read is None:
                raise Unfit("not an element that is read")
            kind = _kind(element)
            if kind is None:
                return
            if element.attributes.get("geo") in ("1", "true", "yes"):
                raise Unfit("geo: value true: places in metres of the network")
            outline = read(element, kind)
            round_m = float(np.hypot(*(outline - np.roll(outline, 1, axis=0)).T).sum())
            if round_m > min(MAX_ROUND_M, left_m):
                raise Unfit(f"shape: value of {round_m:.0f} m round it: at most {min(MAX_ROUND_M, left_m):.0f}")
            left_m -= round_m
            found.append(Obstacle(kind, outline))
        except Unfit as problem:
            if len(skipped) < _MAX_TOLD:
                skipped.append(Skipped(shown(element.name), str(element.line), str(problem)))

    read_elements(content, origin, "additional", take)
    return tuple(found), tuple(skipped)


def _kind(element: Element) -> str | None:
    """Return what kind of fixed thing an element is, None if it is none."""
    words = element.attributes.get("type", "").split(".")
    return next((_SOLID[word] for word in words if word in _SOLID), None)


def _polygon(element: Element, kind: str) -> Array:
    """Return the outline of a polygon; a wall that is not closed leads there and back."""
    outline = np.array([point[:2] for point in points(element, "shape", 2 if kind == WALL else 3)])
    if kind == WALL and (outline[0] != outline[-1]).any():
        return np.vstack((outline, outline[-2:0:-1]))
    return outline


def _point(element: Element, kind: str) -> Array:
    """Return the trunk of a tree.

    Raises:
        Unfit: a point of another kind, which has no outline.
    """
    if kind != TREE:
        raise Unfit(f"type: value {shown(element.attributes['type'])}: a tree, where it is a point")
    x, y = (number(element, key, -MAX_PLACE_M, MAX_PLACE_M) for key in ("x", "y"))
    angles = np.arange(8) * (math.tau / 8.0)
    return np.stack((x + TRUNK_M * np.cos(angles), y + TRUNK_M * np.sin(angles)), axis=1)


_READERS: Final[dict[str, Callable[[Element, str], Array]]] = {"poly": _polygon, "poi": _point}
