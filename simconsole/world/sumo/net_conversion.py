"""From sumolib's network to a road map."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from simconsole.world.roads.road_map import (
    CROSSING,
    ROAD,
    Array,
    Connection,
    Edge,
    GeoReference,
    Junction,
    Lane,
    MapReport,
    Phase,
    Program,
    RoadMap,
    Signal,
)

CAR: Final = "passenger"
FAR_M: Final = 50_000.0
"""A map whose middle lies further from its origin than this is moved there, by whole kilometres."""

_MOST_VIA: Final = 8
_APART_M: Final = 1e-3


def road_map(net: Any, crossed: Mapping[str, tuple[str, ...]], report: MapReport) -> RoadMap:
    """Return the road map of a network that `sumolib` has read.

    Args:
        net: sumolib's network, with internal lanes, programs and connections of people on foot.
        crossed: the edges that each crossing leads over, by names.
        report: what was left out; the counts are filled in.
    """
    places = {edge.getID(): place for place, edge in enumerate(net.getEdges())}
    lanes: list[Lane] = []
    lane_places: dict[str, int] = {}
    moved = _moved(net)
    signals = {signal.getID(): place for place, signal in enumerate(net.getTrafficLights())}
    edges = []
    for place, edge in enumerate(net.getEdges()):
        own = []
        for lane in edge.getLanes():
            lane_places[lane.getID()] = len(lanes)
            own.append(len(lanes))
            lanes.append(_lane(lane, place, moved))
        over = tuple(places[name] for name in crossed.get(edge.getID(), ()) if name in places)
        signal, link = _crossing_signal(edge, signals)
        edges.append(
            Edge(
                id=edge.getID(),
                function=edge.getFunction() or ROAD,
                type=edge.getType(),
                lanes=tuple(own),
                crossed=over,
                signal=signal,
                link=link,
            )
        )
    connections = tuple(_connections(net, lane_places, signals))
    rings = [tuple(places[name] for name in ring.getEdges() if name in places) for ring in net.getRoundabouts()]
    found = RoadMap(
        lanes=tuple(lanes),
        edges=tuple(edges),
        connections=connections,
        signals=tuple(_signal(signal) for signal in net.getTrafficLights()),
        junctions=tuple(_junctions(net, moved)),
        roundabouts=tuple(ring for ring in rings if ring),
        geo=_geo(net, moved),
        report=report,
        moved_m=(float(moved[0]), float(moved[1])),
    )
    return found._replace(report=report._replace(counts=_counts(found)))


def _crossing_signal(edge: Any, signals: Mapping[str, int]) -> tuple[int, int]:
    """Return the signal and the link that people on foot obey at a crossing, -1 and -1 where they have none."""
    if edge.getFunction() == CROSSING:
        for connections in edge.getIncoming().values():
            for one in connections:
                if one.getTLSID() in signals:
                    return signals[one.getTLSID()], one.getTLLinkIndex()
    return -1, -1


def _moved(net: Any) -> Array:
    """Return what is taken away from all places (x, y, z): coordinates stay small."""
    points = [point for edge in net.getEdges() for lane in edge.getLanes() for point in lane.getShape3D()[:1]]
    if not points:
        return np.zeros(3)
    middle = np.median(np.array(points), axis=0)
    if float(np.abs(middle[:2]).max()) <= FAR_M:
        return np.zeros(3)
    return np.array((*(np.round(middle[:2] / 1000.0) * 1000.0), 0.0))


def _lane(lane: Any, edge: int, moved: Array) -> Lane:
    line = np.array(lane.getShape3D(), dtype=np.float64) - moved
    apart = np.hypot(*np.diff(line[:, :2], axis=0).T) > _APART_M
    apart[-1] |= not apart.any()
    return Lane(
        id=lane.getID(),
        edge=edge,
        number=lane.getIndex(),
        line=line[np.concatenate(((True,), apart))],
        width_m=lane.getWidth(),
        limit_mps=lane.getSpeed(),
        drivable=lane.allows(CAR) and lane.getEdge().getFunction() in ("", "internal"),
    )


def _connections(net: Any, lanes: Mapping[str, int], signals: Mapping[str, int]) -> list[Connection]:
    found = []
    foes, firsts = _rights_of_way(net, lanes, "_foes"), _rights_of_way(net, lanes, "_prohibits")
    for edge in net.getEdges(withInternal=False):
        for lane in edge.getLanes():
            for one in lane.getOutgoing():
                via = _via(net, one, lanes)
                if via is not None and one.getToLane().getID() in lanes:
                    found.append(
                        Connection(
                            from_lane=lanes[lane.getID()],
                            to_lane=lanes[one.getToLane().getID()],
                            via=via,
                            direction=one.getDirection(),
                            signal=signals.get(one.getTLSID(), -1),
                            link=one.getTLLinkIndex(),
                            foes=tuple(sorted({foe for lane in via for foe in foes.get(lane, ())})),
                            yields_to=tuple(sorted({first for lane in via for first in firsts.get(lane, ())})),
                        )
                    )
    return found


def _rights_of_way(net: Any, lanes: Mapping[str, int], table: str) -> dict[int, tuple[int, ...]]:
    """Return for the last lane of each link of each junction those of the links that its table names.

    The links of a junction are counted as its lanes inside, and the digits of a table from the right.
    """
    found = {}
    for node in net.getNodes():
        inside = [lanes.get(name) for name in node.getInternal() or ()]
        for index, digits in getattr(node, table).items():
            lane = inside[index] if index < len(inside) else None
            if lane is not None:
                named = [other for other, digit in zip(inside, reversed(digits), strict=False) if digit == "1"]
                found[lane] = tuple(other for other in named if other is not None)
    return found


def _via(net: Any, connection: Any, lanes: Mapping[str, int]) -> tuple[int, ...] | None:
    """Return the lanes inside the junction, one after the other; None where one is missing."""
    goal, name = connection.getToLane().getID(), connection.getViaLaneID()
    found: list[int] = []
    for _ in range(_MOST_VIA):
        if not name:
            return tuple(found)
        if name not in lanes:
            return None
        found.append(lanes[name])
        following = [one for one in net.getLane(name).getOutgoing() if one.getToLane().getID() == goal]
        name = following[0].getViaLaneID() if following else ""
    return None


def _signal(signal: Any) -> Signal:
    return Signal(
        signal.getID(),
        tuple(
            Program(
                name,
                program.getType(),
                float(program.getOffset()),
                tuple(Phase(float(phase.duration), phase.state) for phase in program.getPhases()),
            )
            for name, program in signal.getPrograms().items()
        ),
    )


def _junctions(net: Any, moved: Array) -> list[Junction]:
    found = []
    for node in net.getNodes():
        if node.getType() is None:  # an edge names it, but the file does not describe it
            continue
        x, y = node.getCoord()
        outline = np.array([point[:2] for point in node.getShape()], dtype=np.float64).reshape(-1, 2) - moved[:2]
        found.append(
            Junction(
                id=node.getID(),
                kind=node.getType(),
                x_m=x - float(moved[0]),
                y_m=y - float(moved[1]),
                outline=outline,
            )
        )
    return found


def _geo(net: Any, moved: Array) -> GeoReference:
    location = net._location  # its own accessor needs pyproj
    x, y = (float(part) for part in location.get("netOffset", "0,0").split(","))
    return GeoReference(x - float(moved[0]), y - float(moved[1]), location.get("projParameter", "!"))


def _counts(found: RoadMap) -> tuple[tuple[str, int], ...]:
    functions = [edge.function for edge in found.edges]
    return (
        ("edges", functions.count(ROAD)),
        ("lanes", sum(found.edges[lane.edge].function == ROAD for lane in found.lanes)),
        ("lanes for cars", sum(found.edges[lane.edge].function == ROAD and lane.drivable for lane in found.lanes)),
        ("lanes inside junctions", functions.count("internal")),
        ("connections", len(found.connections)),
        ("junctions", len(found.junctions)),
        ("signals", len(found.signals)),
        ("signal programs", sum(len(signal.programs) for signal in found.signals)),
        ("crossings", functions.count("crossing")),
        ("walking areas", functions.count("walkingarea")),
        ("roundabouts", len(found.roundabouts)),
    )
