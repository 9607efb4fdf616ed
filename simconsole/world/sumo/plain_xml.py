"""SUMO's plain files, from which netconvert builds a network: nodes, edges, crossings."""

from collections.abc import Sequence
from typing import NamedTuple
from xml.sax.saxutils import quoteattr


class PlainNode(NamedTuple):
    """A node; kinds are SUMO's: priority, traffic_light, dead_end, zipper and others."""

    id: str
    x_m: float
    y_m: float
    z_m: float = 0.0
    kind: str = "priority"
    radius_m: float | None = None


class PlainEdge(NamedTuple):
    """An edge; its lanes lie right of its line, or on both sides of it where it is `centred`."""

    id: str
    start: str
    end: str
    line: tuple[tuple[float, ...], ...]  # x, y and, where there are heights, z
    limit_mps: float
    width_m: float
    lanes: int = 1
    priority: int = 1
    centred: bool = False
    sidewalk_m: float = 0.0


class PlainCrossing(NamedTuple):
    """A crossing for people on foot at a node, over these edges."""

    node: str
    edges: tuple[str, ...]
    width_m: float = 4.0


class PlainNetwork(NamedTuple):
    """All of it; a roundabout is the edges of its ring, `connections` pairs of edges where not all are meant."""

    nodes: Sequence[PlainNode]
    edges: Sequence[PlainEdge]
    crossings: Sequence[PlainCrossing] = ()
    roundabouts: Sequence[tuple[str, ...]] = ()

    def texts(self) -> dict[str, str]:
        """Return the files by the options of netconvert that name them."""
        return {
            "--node-files": _file("nodes", [_node(node) for node in self.nodes]),
            "--edge-files": _file("edges", [_edge(edge) for edge in self.edges] + self._roundabouts()),
            "--connection-files": _file("connections", [_crossing(one) for one in self.crossings]),
        }

    def _roundabouts(self) -> list[str]:
        ends = {edge.id: edge.start for edge in self.edges}
        return [
            _element("roundabout", {"nodes": " ".join(ends[edge] for edge in ring), "edges": " ".join(ring)})
            for ring in self.roundabouts
        ]


def _node(node: PlainNode) -> str:
    given = {"id": node.id, "x": _m(node.x_m), "y": _m(node.y_m), "type": node.kind}
    if node.z_m:
        given["z"] = _m(node.z_m)
    if node.radius_m is not None:
        given["radius"] = _m(node.radius_m)
    return _element("node", given)


def _edge(edge: PlainEdge) -> str:
    sidewalk = {"sidewalkWidth": _m(edge.sidewalk_m)} if edge.sidewalk_m else {}
    return _element(
        "edge",
        sidewalk
        | {
            "id": edge.id,
            "from": edge.start,
            "to": edge.end,
            "numLanes": str(edge.lanes),
            "speed": _m(edge.limit_mps),
            "width": _m(edge.width_m),
            "priority": str(edge.priority),
            "spreadType": "center" if edge.centred else "right",
            "shape": " ".join(",".join(map(_m, point)) for point in edge.line),
        },
    )


def _crossing(one: PlainCrossing) -> str:
    given = {"node": one.node, "edges": " ".join(one.edges), "width": _m(one.width_m), "priority": "true"}
    return _element("crossing", given)


def _element(name: str, given: dict[str, str]) -> str:
    return f"  <{name} {' '.join(f'{key}={quoteattr(value)}' for key, value in given.items())}/>"


def _file(root: str, lines: list[str]) -> str:
    return "\n".join((f"<{root}>", *lines, f"</{root}>", ""))


def _m(value: float) -> str:
    return f"{value + 0.0:.2f}"
