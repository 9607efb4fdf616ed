"""A course as SUMO's plain files: the same road, with the lane in the other direction, junctions, lights, crossings."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Final, NamedTuple

from simconsole.profiles.world import CourseProfile, Intersection, Roundabout
from simconsole.values.units import MPS_PER_KMH
from simconsole.world.course import Course
from simconsole.world.drawing_layers import Frame, axis_frame
from simconsole.world.sumo.plain_xml import PlainCrossing, PlainEdge, PlainNetwork, PlainNode

_STEP_M: Final = 2.0
_RING_RADIUS_M: Final = 8.0  # of the kerbs where roads meet the ring
_CORNER_RADIUS_M: Final = 7.0
_RING_STEPS: Final = 12
_SIDEWALK_M: Final = 2.0

Point = tuple[float, ...]


class Break(NamedTuple):
    """Where the course's road is cut: the node that ends one edge, and the one that begins the next."""

    s_m: float
    node: str
    end_s_m: float
    next_node: str


def course_network(profile: CourseProfile) -> tuple[PlainNetwork, tuple[str, ...]]:
    """Return the network of a course and the edges of one lap, in driving order."""
    building = _Building(Course(profile))
    return building.network(), tuple(building.lap)


class _Building:
    def __init__(self, course: Course) -> None:
        self._course, self._world = course, course.world
        self._limit = self._world.speed_limit_kmh * MPS_PER_KMH
        self._nodes: list[PlainNode] = []
        self._edges: list[PlainEdge] = []
        self._crossings: list[PlainCrossing] = []
        self._rings: list[tuple[str, ...]] = []
        self.lap: list[str] = []

    def network(self) -> PlainNetwork:
        self._add_node("start", axis_frame(self._course, 0.0))
        breaks = sorted(self._breaks())
        stations = [Break(0.0, "start", 0.0, "start"), *breaks, Break(self._course.length_m, "start", 0.0, "start")]
        ring_edges = {ring.node: number for number, ring in enumerate(b for b in breaks if b.end_s_m != b.s_m)}
        for number, (one, other) in enumerate(pairwise(stations)):
            self._add_road(f"road{number}", one, other)
            if other.node in ring_edges:
                self._add_ring(other, self._world.roundabouts[ring_edges[other.node]])
        self._add_crossings()
        return PlainNetwork(self._nodes, self._edges, self._crossings, self._rings)

    def _breaks(self) -> Iterator[Break]:
        for number, spot in enumerate(self._world.intersections):
            self._add_intersection(f"junction{number}", spot)
            yield Break(spot.s_m, f"junction{number}", spot.s_m, f"junction{number}")
        for number, crossing in enumerate(self._world.crossings):
            self._add_node(f"crossing{number}", axis_frame(self._course, crossing.s_m))
            yield Break(crossing.s_m, f"crossing{number}", crossing.s_m, f"crossing{number}")
        for number, ring in enumerate(sorted(self._world.roundabouts, key=lambda one: one.s_m)):
            for end, s_m, back in (("in", ring.s_m, math.pi), ("out", ring.end_s_m, 0.0)):
                angle = self._course.at(s_m).yaw_rad + back
                self._nodes.append(
                    PlainNode(
                        f"ring{number}{end}",
                        ring.x_m + ring.radius_m * math.cos(angle),
                        ring.y_m + ring.radius_m * math.sin(angle),
                        radius_m=_RING_RADIUS_M,
                    )
                )
            yield Break(ring.s_m, f"ring{number}in", ring.end_s_m, f"ring{number}out")

    def _add_node(self, name: str, frame: Frame, kind: str = "priority") -> None:
        radius = _CORNER_RADIUS_M if kind == "traffic_light" else None
        self._nodes.append(PlainNode(name, frame.x_m, frame.y_m, kind=kind, radius_m=radius))

    def _add_intersection(self, name: str, spot: Intersection) -> None:
        frame = axis_frame(self._course, spot.s_m)
        self._add_node(name, frame, "traffic_light" if spot.signalled else "priority")
        for side, turn in (("left", 0.5 * math.pi), ("right", -0.5 * math.pi)):
            arm = frame.turned(turn)
            end = f"{name}{side}"
            x, y = frame.x_m + spot.arm_m * math.cos(arm.yaw_rad), frame.y_m + spot.arm_m * math.sin(arm.yaw_rad)
            self._nodes.append(PlainNode(end, x, y, kind="dead_end"))
            line = ((frame.x_m, frame.y_m), (x, y))
            self._add_edges(f"{end}", name, end, line, priority=1)

    def _add_road(self, name: str, one: Break, other: Break) -> None:
        axis = self._course.offset(0.5 * self._world.lane_width_m, one.end_s_m, other.s_m, _STEP_M)
        line = tuple((float(x), float(y)) for x, y in axis)
        self.lap.append(name)
        self._add_edges(name, one.next_node, other.node, line, priority=2)

    def _add_edges(self, name: str, start: str, end: str, line: tuple[Point, ...], priority: int) -> None:
        """Add a road with a lane in each direction."""
        there = PlainEdge(
            id=name,
            start=start,
            end=end,
            line=line,
            limit_mps=self._limit,
            width_m=self._world.lane_width_m,
            priority=priority,
            sidewalk_m=_SIDEWALK_M,
        )
        self._edges += [there, there._replace(id=f"-{name}", start=end, end=start, line=line[::-1])]

    def _add_ring(self, at: Break, ring: Roundabout) -> None:
        """Add the ring as two edges, anticlockwise, the first of them from the entry to the exit of the lap."""
        entry, leave = (next(node for node in self._nodes if node.id == name) for name in (at.node, at.next_node))
        angles = [math.atan2(node.y_m - ring.y_m, node.x_m - ring.x_m) for node in (entry, leave)]
        names = []
        arcs = ((entry, leave, angles[0], angles[1]), (leave, entry, angles[1], angles[0]))
        for start, end, first, last in arcs:
            turn = (last - first) % math.tau
            line = tuple(
                (
                    ring.x_m + ring.radius_m * math.cos(first + turn * step / _RING_STEPS),
                    ring.y_m + ring.radius_m * math.sin(first + turn * step / _RING_STEPS),
                )
                for step in range(_RING_STEPS + 1)
            )
            names.append(f"{start.id}-{end.id}")
            self._edges.append(
                PlainEdge(
                    id=names[-1],
                    start=start.id,
                    end=end.id,
                    line=line,
                    limit_mps=self._limit,
                    width_m=self._world.lane_width_m,
                    priority=3,
                    centred=True,
                )
            )
        self.lap.append(names[0])
        self._rings.append(tuple(names))

    def _add_crossings(self) -> None:
        for number, crossing in enumerate(self._world.crossings):
            node = f"crossing{number}"
            edges = tuple(edge.id for edge in self._edges if edge.end == node and not edge.id.startswith("-"))
            both = (*edges, *(f"-{edge}" for edge in edges))
            self._crossings.append(PlainCrossing(node, both, crossing.width_m))
        for number, spot in enumerate(self._world.intersections):
            if not spot.signalled:
                continue
            node = f"junction{number}"
            for edge in self._edges:
                if edge.end == node and not edge.id.startswith("-"):
                    self._crossings.append(PlainCrossing(node, (edge.id, f"-{edge.id}")))
                elif edge.start == node and not edge.id.startswith("-"):
                    self._crossings.append(PlainCrossing(node, (f"-{edge.id}", edge.id)))
