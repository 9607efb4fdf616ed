"""Read buildings and cones from SUMO's `.poly.xml`."""

from typing import Final

import numpy as np

from simconsole.world.roads.road_map import Array, Skipped
from simconsole.world.sumo.net_checks import Unfit, points
from simconsole.world.sumo.xml_guard import Element, read_elements, shown

_MAX_TOLD: Final = 100
_KINDS: Final = ("building", "cone")


def read_polygons(content: bytes, origin: str) -> tuple[tuple[Array, ...], tuple[Skipped, ...]]:
    """Return the outlines of buildings and cones, float64 [N, 2] each, and what was not read.

    Raises:
        ProfileError: not XML, or hostile.
    """
    outlines: list[Array] = []
    skipped: list[Skipped] = []

    def take(element: Element) -> None:
        try:
            if element.name != "poly":
                raise Unfit("not an element that is read")
            if not element.attributes.get("type", "").startswith(_KINDS):
                return
            if element.attributes.get("geo") in ("1", "true", "yes"):
                raise Unfit("geo: value true: places in metres of the network")
            outlines.append(np.array([point[:2] for point in points(element, "shape", 3)]))
        except Unfit as problem:
            if len(skipped) < _MAX_TOLD:
                skipped.append(Skipped(shown(element.name), str(element.line), str(problem)))

    read_elements(content, origin, "additional", take)
    return tuple(outlines), tuple(skipped)
