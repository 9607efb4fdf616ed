"""What must hold of the elements of a `.net.xml` before sumolib sees them."""

import math
from collections.abc import Callable
from typing import Final

from simconsole.world.roads.road_map import CROSSING, INTERNAL, WALKING_AREA
from simconsole.world.sumo.xml_guard import Element, shown

MAX_PLACE_M: Final = 1e7
"""Of a coordinate: the earth's projections go no further."""
MAX_POINTS: Final = 5000
MAX_NAME: Final = 200
MAX_LINKS: Final = 1000
MAX_PHASES: Final = 500
FUNCTIONS: Final = ("", INTERNAL, CROSSING, WALKING_AREA)

_APART_M: Final = 1e-3
_STATES: Final = frozenset("rRyYgGuosS")
_BITS: Final = frozenset("01")


class Unfit(Exception):
    """An element that cannot be used; its text says what of it, and what is allowed."""


def check(element: Element) -> None:
    """Check an element with its children, except for what it refers to.

    Raises:
        Unfit: it or one of its children cannot be used.
    """
    for part in (element, *element.children):
        rule = RULES.get(part.name)
        if rule is not None:
            rule(part)


def number(element: Element, key: str, low: float, high: float, default: float | None = None) -> float:
    """Return an attribute as a finite number from `low` to `high`.

    Raises:
        Unfit: it is none, or missing without a default.
    """
    text = element.attributes.get(key)
    if text is None:
        if default is None:
            raise Unfit(f"{key}: value missing: {low:g} to {high:g}")
        return default
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise Unfit(f"{key}: value {shown(text)}: {low:g} to {high:g}")
    return value


def whole(element: Element, key: str, high: int, default: int | None = None) -> int:
    """Return an attribute as an integer from 0 (or `default`, where that is less) to `high`.

    Raises:
        Unfit: it is none, or missing without a default.
    """
    text = element.attributes.get(key)
    if text is None and default is not None:
        return default
    if text is None or len(text) > len(str(high)) or not text.isascii() or not text.isdecimal() or int(text) > high:
        raise Unfit(f"{key}: value {'missing' if text is None else shown(text)}: a whole number, 0 to {high}")
    return int(text)


def name(element: Element, key: str) -> str:
    """Return an attribute that names something.

    Raises:
        Unfit: it is missing, empty, long, or has blanks or unprintable characters.
    """
    text = element.attributes.get(key, "")
    if not 0 < len(text) <= MAX_NAME or not text.isprintable() or " " in text:
        raise Unfit(f"{key}: value {shown(text)}: a name of 1 to {MAX_NAME} characters without blanks")
    return text


def points(element: Element, key: str, least: int) -> list[tuple[float, ...]]:
    """Return an attribute as points of two or three coordinates in m; a missing one has none.

    Raises:
        Unfit: fewer than `least`, too many, or one that is no point.
    """
    texts = element.attributes.get(key, "").split()
    if not least <= len(texts) <= MAX_POINTS:
        raise Unfit(f"{key}: value of {len(texts)} points: {least} to {MAX_POINTS}")
    found = []
    for text in texts:
        try:
            point = tuple(float(one) for one in text.split(","))
        except ValueError:
            point = ()
        if len(point) not in (2, 3) or not all(abs(one) <= MAX_PLACE_M for one in point):
            raise Unfit(f"{key}: value {shown(text)}: two or three coordinates within {MAX_PLACE_M:g} m")
        found.append(point)
    return found


def _edge(element: Element) -> None:
    name(element, "id")
    function = element.attributes.get("function", "")
    if function not in FUNCTIONS:
        raise Unfit(f"function: value {shown(function)}: one of normal, {', '.join(FUNCTIONS[1:])}")
    if function:
        if not element.attributes["id"].startswith(":") or "_" not in element.attributes["id"]:
            raise Unfit(f"id: value {shown(element.attributes['id'])}: :JUNCTION_NUMBER inside a junction")
    else:
        name(element, "from")
        name(element, "to")
    if function == CROSSING and not element.attributes.get("crossingEdges", "").split():
        raise Unfit("crossingEdges: value missing: the edges that it crosses")
    priority = element.attributes.get("priority", "0").removeprefix("-")
    if not priority.isascii() or not priority.isdecimal() or len(priority) > 9:
        raise Unfit(f"priority: value {shown(priority)}: a whole number")
    points(element, "shape", 0)
    lanes = [part for part in element.children if part.name == "lane"]
    if not lanes:
        raise Unfit("lane: value missing: at least one")
    for place, lane in enumerate(lanes):
        if whole(lane, "index", len(lanes) - 1) != place:
            raise Unfit(f"lane index: value {lane.attributes['index']}: {place}, one after the other from the right")
        found = points(lane, "shape", 2)
        # Inside a junction that only joins two edges, a lane may have no length.
        if not function and max(math.dist(found[0][:2], point[:2]) for point in found) < _APART_M:
            raise Unfit(f"shape: value {shown(lane.attributes['shape'])}: two different points")


def _lane(element: Element) -> None:
    name(element, "id")
    number(element, "speed", 0.0, 200.0)
    number(element, "length", 0.0, MAX_PLACE_M)
    number(element, "width", 0.05, 100.0, 3.2)
    points(element, "shape", 2)


def _junction(element: Element) -> None:
    name(element, "id")
    name(element, "type")
    number(element, "x", -MAX_PLACE_M, MAX_PLACE_M)
    number(element, "y", -MAX_PLACE_M, MAX_PLACE_M)
    number(element, "z", -MAX_PLACE_M, MAX_PLACE_M, 0.0)
    points(element, "shape", 0)
    for key in ("incLanes", "intLanes"):
        if key not in element.attributes and not element.attributes["id"].startswith(":"):
            raise Unfit(f"{key}: value missing: names of lanes, or nothing")
    inside = element.attributes["id"].startswith(":")
    if inside and any(part.name == "request" for part in element.children):
        raise Unfit("request: value of a junction inside a junction: none")


def _request(element: Element) -> None:
    whole(element, "index", MAX_LINKS)
    for key in ("response", "foes"):
        text = element.attributes.get(key, "")
        if not 0 < len(text) <= MAX_LINKS or not _BITS.issuperset(text):
            raise Unfit(f"{key}: value {shown(text)}: 1 to {MAX_LINKS} digits 0 or 1")


def _connection(element: Element) -> None:
    for key in ("from", "to", "dir", "state"):
        name(element, key)
    whole(element, "fromLane", 100)
    whole(element, "toLane", 100)
    if element.attributes.get("tl"):
        name(element, "tl")
        whole(element, "linkIndex", MAX_LINKS)
        whole(element, "linkIndex2", MAX_LINKS, -1)


def _program(element: Element) -> None:
    name(element, "id")
    name(element, "programID")
    name(element, "type")
    number(element, "offset", -1e9, 1e9)
    phases = [part for part in element.children if part.name == "phase"]
    if not 0 < len(phases) <= MAX_PHASES:
        raise Unfit(f"phase: value of {len(phases)} phases: 1 to {MAX_PHASES}")
    if len({len(phase.attributes.get("state", "")) for phase in phases}) != 1:
        raise Unfit("phase state: value of another length: as many letters in each phase")


def _phase(element: Element) -> None:
    number(element, "duration", 0.0, 1e6)
    state = element.attributes.get("state", "")
    if not 0 < len(state) <= MAX_LINKS or not _STATES.issuperset(state):
        raise Unfit(f"state: value {shown(state)}: 1 to {MAX_LINKS} letters of {''.join(sorted(_STATES))}")


def _location(element: Element) -> None:
    parts = element.attributes.get("netOffset", "").split(",")
    try:
        offset = [float(part) for part in parts]
    except ValueError:
        offset = []
    if len(offset) != 2 or not all(abs(part) <= MAX_PLACE_M * 10.0 for part in offset):
        raise Unfit(f"netOffset: value {shown(','.join(parts))}: two numbers")
    projection = element.attributes.get("projParameter", "")
    if len(projection) > 1000 or not projection.isprintable():
        raise Unfit("projParameter: value too long or unprintable: a PROJ definition")


def _roundabout(element: Element) -> None:
    if not element.attributes.get("edges", "").split() or not element.attributes.get("nodes", "").split():
        raise Unfit("edges: value missing: names of edges")


RULES: Final[dict[str, Callable[[Element], None]]] = {
    "edge": _edge,
    "lane": _lane,
    "junction": _junction,
    "request": _request,
    "connection": _connection,
    "tlLogic": _program,
    "phase": _phase,
    "location": _location,
    "roundabout": _roundabout,
}
