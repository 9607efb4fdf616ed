"""The values of a road map: what the console knows of roads, whatever file they came from.

Metres in `map`; lanes refer to each other, and edges to their lanes, by their place in the map's tuples.
"""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROAD: Final = "road"
INTERNAL: Final = "internal"
CROSSING: Final = "crossing"
WALKING_AREA: Final = "walkingarea"


class Lane(NamedTuple):
    """One lane: its centre line as float64 [N, 3] in driving direction, the height last."""

    id: str
    edge: int
    number: int  # in its edge, from the right
    line: Array
    width_m: float
    limit_mps: float
    drivable: bool  # open to passenger cars

    @property
    def length_m(self) -> float:
        """Length of the centre line."""
        return float(np.hypot(*np.diff(self.line[:, :2], axis=0).T).sum())


class Edge(NamedTuple):
    """Lanes side by side: a road from junction to junction, or a part of a junction."""

    id: str
    function: str  # ROAD, INTERNAL, CROSSING or WALKING_AREA
    type: str
    lanes: tuple[int, ...]  # from the right
    crossed: tuple[int, ...] = ()  # of a crossing: the edges that it leads over
    signal: int = -1  # of a crossing: the signal that controls it
    link: int = -1  # and its place in that signal's states


class Connection(NamedTuple):
    """From the end of a lane to the beginning of another, over the lanes `via` inside a junction."""

    from_lane: int
    to_lane: int
    via: tuple[int, ...]
    direction: str  # s, l, r, t (turn round), L and R (partly), as SUMO writes them
    signal: int = -1  # that controls it
    link: int = -1  # its place in that signal's states
    foes: tuple[int, ...] = ()  # lanes inside the junction, crossings too, whose users may be in the way
    yields_to: tuple[int, ...] = ()  # those of them whose users go first


class Phase(NamedTuple):
    """One phase of a signal's program: one letter for each of its links."""

    duration_s: float
    state: str


class Program(NamedTuple):
    """A program of a signal; its phases follow each other for ever, `offset_s` later than the clock."""

    id: str
    kind: str
    offset_s: float
    phases: tuple[Phase, ...]


class Signal(NamedTuple):
    """Traffic lights under one control."""

    id: str
    programs: tuple[Program, ...]


_NO_PROGRAM: Final = Program("", "off", 0.0, (Phase(1.0, ""),))


def active(signal: Signal) -> Program:
    """Return the program that a signal follows; one that has none shows nothing, for ever."""
    return signal.programs[0] if signal.programs else _NO_PROGRAM


class Junction(NamedTuple):
    """Where edges meet; its outline as float64 [N, 2]."""

    id: str
    kind: str
    x_m: float
    y_m: float
    outline: Array


class GeoReference(NamedTuple):
    """From `map` to the earth: projected place = place in map - offset, by a PROJ definition (`!`: none)."""

    offset_x_m: float
    offset_y_m: float
    projection: str


class Skipped(NamedTuple):
    """What of a file was not read, and why: one line for people."""

    element: str
    place: str
    reason: str


class MapReport(NamedTuple):
    """What was read of a file, by name, and what was not."""

    counts: tuple[tuple[str, int], ...]
    skipped: tuple[Skipped, ...]


BUILDING: Final = "building"
CONE: Final = "cone"
TREE: Final = "tree"
WALL: Final = "wall"


class Obstacle(NamedTuple):
    """A fixed thing beside the lanes, or on them; of two points it is a line without thickness."""

    kind: str  # BUILDING, CONE, TREE or WALL
    outline: Array  # float64 [N, 2]


class RoadMap(NamedTuple):
    """A road map."""

    lanes: tuple[Lane, ...]
    edges: tuple[Edge, ...]
    connections: tuple[Connection, ...]
    signals: tuple[Signal, ...]
    junctions: tuple[Junction, ...]
    roundabouts: tuple[tuple[int, ...], ...]  # the edges of each
    geo: GeoReference
    report: MapReport
    moved_m: tuple[float, float] = (0.0, 0.0)  # taken away from the places that the files have
    obstacles: tuple[Obstacle, ...] = ()

    def edge(self, edge_id: str) -> int | None:
        """Return the place of an edge, None if the map has none of this name."""
        return next((place for place, edge in enumerate(self.edges) if edge.id == edge_id), None)
