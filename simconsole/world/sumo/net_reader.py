"""Read SUMO's `.net.xml`: checked element by element, understood by sumolib, turned into a road map.

An element that does not fit, or refers to one that was left out, is left out and named in the map's report; what
remains must be a map that a car can drive on.
"""

from collections import Counter
from typing import Any, Final

from simconsole.values.errors import ProfileError
from simconsole.world.roads.road_map import CROSSING, MapReport, RoadMap, Skipped
from simconsole.world.sumo.net_checks import Unfit, check
from simconsole.world.sumo.net_conversion import road_map
from simconsole.world.sumo.xml_guard import Element, read_elements, shown

MAX_TOLD: Final = 100
"""Elements that a report names one by one."""
MAX_NAMES: Final = 10
"""Names of elements that it counts."""

_UNDERSTOOD: Final = ("location", "edge", "junction", "connection", "tlLogic", "roundabout")
_CHILDREN: Final = {"edge": ("lane",), "tlLogic": ("phase",), "junction": ("request",)}
_UNREAD: Final = ("type", "param", "neigh", "stopOffset")
"""Parts of a network that the console has no use for: lanes say what may use them."""
_LATER: Final = ("connection", "tlLogic", "roundabout")
"""Read last: they refer to edges, which may follow them in a file that other programs wrote."""


def read_net(content: bytes, origin: str) -> RoadMap:
    """Return the road map of a network.

    Args:
        content: the file, uncompressed.
        origin: its name, which opens every message.

    Raises:
        ProfileError: not XML, hostile, or without a lane that a car may use.
    """
    reading = _Reading()
    read_elements(content, origin, "net", reading.take)
    found = reading.finish()
    if not any(lane.drivable for lane in found.lanes):
        reasons = "".join(f"; line {part.place}: <{part.element}>: {part.reason}" for part in found.report.skipped[:1])
        raise ProfileError(f"{origin}: <net>: no lane for cars: at least one{reasons}")
    return found


class _Reading:
    """One network while it is read."""

    def __init__(self) -> None:
        from sumolib.net import NetReader

        self._reader: Any = NetReader(withInternal=True, withPrograms=True, withPedestrianConnections=True)
        self._skipped: list[Skipped] = []
        self._left_out: Counter[str] = Counter()
        self._later: list[Element] = []
        self._edges: set[str] = set()
        self._crossed: dict[str, tuple[str, ...]] = {}

    def take(self, element: Element) -> None:
        if element.name in _LATER:
            self._later.append(element)
        else:
            self._read(element)

    def finish(self) -> RoadMap:
        for element in self._later:
            self._read(element)
        report = MapReport((), tuple(self._skipped))
        if more := sum(self._left_out.values()) - len(self._skipped):
            most = sorted(self._left_out.most_common(MAX_NAMES))
            names = ", ".join(f"{count} <{shown(name)}>" for name, count in most)
            names += f" and {len(self._left_out) - MAX_NAMES} other names" if len(self._left_out) > MAX_NAMES else ""
            report = MapReport((), (*report.skipped, Skipped("net", "-", f"{more} more; all in all {names}")))
        return road_map(self._reader.getNet(), self._crossed, report)

    def _read(self, element: Element) -> None:
        if element.name in _UNREAD:
            return
        if element.name not in _UNDERSTOOD:
            self._leave_out(element, "not an element that is read")
            return
        try:
            check(element)
            self._refers(element)
            self._pass_on(element)
        except Unfit as problem:
            self._leave_out(element, str(problem))
        except (LookupError, ValueError, TypeError, AttributeError, AssertionError) as error:
            self._leave_out(element, f"not understood: {type(error).__name__}: {shown(str(error))}")

    def _leave_out(self, element: Element, reason: str) -> None:
        self._left_out[element.name] += 1
        if len(self._skipped) < MAX_TOLD:
            self._skipped.append(Skipped(shown(element.name), str(element.line), reason))

    def _refers(self, element: Element) -> None:
        """Check what an element refers to. Raises Unfit."""
        given = element.attributes
        if element.name == "edge":
            if given["id"] in self._edges:
                raise Unfit(f"id: value {shown(given['id'])}: a name that no other edge has")
            self._edges.add(given["id"])
            if given.get("function") == CROSSING:
                self._crossed[given["id"]] = tuple(given["crossingEdges"].split())
        elif element.name == "connection":
            for key in ("from", "to"):
                if given[key] not in self._edges:
                    raise Unfit(f"{key}: value {shown(given[key])}: an edge that was read")

    def _pass_on(self, element: Element) -> None:
        """Give an element to sumolib, without what would refer to elements that may be missing."""
        given = {key: value for key, value in element.attributes.items() if key != "bidi"}
        if element.name == "location":
            given = {"convBoundary": "", "origBoundary": "", "projParameter": "!", **given}
        if element.name == "edge" and given.get("function") == CROSSING:
            given["crossingEdges"] = ""
        self._reader.startElement(element.name, given)
        for part in element.children:
            if part.name in _CHILDREN.get(element.name, ()):
                self._reader.startElement(part.name, part.attributes)
                self._reader.endElement(part.name)
            elif part.name not in _UNREAD:
                self._leave_out(part, "not an element that is read")
        self._reader.endElement(element.name)
