"""Write the shipped worlds that are road maps: `python -m simconsole.world.tools.shipped_maps FOLDER` (shell).

Needs netconvert (extra `sumo`). The folder has the courses that are built as networks, too.
"""

import math
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Final, NamedTuple

from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import CourseProfile
from simconsole.values.errors import ProfileError, SimConsoleError
from simconsole.values.platform import Pose
from simconsole.values.units import MPS_PER_KMH, RAD_PER_DEG
from simconsole.world.path_geometry import Piece, travel
from simconsole.world.sumo.course_network import course_network
from simconsole.world.sumo.netconvert import build
from simconsole.world.sumo.plain_xml import PlainEdge, PlainNetwork, PlainNode

_STEP_M: Final = 4.0
_RAMP_M: Final = 40.0
_CONE_M: Final = 0.15

Point = tuple[float, ...]


class Shipped(NamedTuple):
    """One shipped world: its network, the edges that are driven, polygons (SUMO's XML) beside it, and its ground."""

    title: str
    network: PlainNetwork
    edges: tuple[str, ...]
    polygons: str | None = None
    ground: str | None = None


def bent(start: Pose, *bends: tuple[float, float]) -> list[Pose]:
    """Return poses every few metres along (length in m, turn in degrees) after each other, with curvature ramps."""
    poses, pose = [start], start
    for length, turn_deg in bends:
        curvature = turn_deg * RAD_PER_DEG / max(length - _RAMP_M, 1.0) if turn_deg else 0.0
        parts = [Piece(length, 0.0, 0.0)]
        if turn_deg:
            ramp = Piece(_RAMP_M, 0.0, curvature)
            parts = [ramp, Piece(length - 2.0 * _RAMP_M, curvature, curvature), ramp.mirrored]
        for part in parts:
            count = max(1, round(part.length_m / _STEP_M))
            poses += [travel(pose, part, part.length_m * step / count) for step in range(1, count + 1)]
            pose = travel(pose, part)
    return poses


def urban(folder: Path) -> Shipped:
    """Return the urban course as a network."""
    course = load_world(str(folder / "urban.yaml"))
    assert isinstance(course, CourseProfile)
    network, lap = course_network(course)
    return Shipped("Urban course with signals, 2.6 km", network, lap)


def motorway() -> Shipped:
    """Return 3.4 km of a motorway: two lanes, an exit, an entry with a lane to merge from, and what leads there."""
    axis = bent(Pose(0.0, 0.0, 0.0), (900.0, 0.0), (700.0, 25.0), (600.0, 0.0), (800.0, -30.0), (400.0, 0.0))
    cuts = [0, len(axis) * 10 // 34, len(axis) * 13 // 34, len(axis) * 20 // 34, len(axis) * 24 // 34, len(axis) - 1]
    names = ("west", "diverge", "exit", "entry", "merge", "east")
    nodes = [PlainNode(name, axis[cut].x_m, axis[cut].y_m) for name, cut in zip(names, cuts, strict=True)]
    lanes = (2, 3, 2, 3, 2)
    edges = [
        _road(f"{one}-{other}", one, other, axis[cuts[place] : cuts[place + 1] + 1], 130.0, lanes[place], 3.75)
        for place, (one, other) in enumerate(pairwise(names))
    ]
    leaving, joining = axis[cuts[2]], axis[cuts[3]]
    off = _shifted(bent(Pose(leaving.x_m, leaving.y_m, leaving.yaw_rad), (220.0, -25.0), (150.0, 0.0)), -9.0)
    on = _shifted(bent(Pose(joining.x_m, joining.y_m, joining.yaw_rad + math.pi), (220.0, 25.0), (150.0, 0.0)), 9.0)
    nodes += [PlainNode("off", off[-1].x_m, off[-1].y_m), PlainNode("on", on[-1].x_m, on[-1].y_m)]
    edges += [
        _road("ramp-off", "exit", "off", off, 60.0, 1, 3.75)._replace(priority=0),
        _road("ramp-on", "on", "entry", on[::-1], 60.0, 1, 3.75)._replace(priority=0),
    ]
    driven = ("ramp-on", "entry-merge", "merge-east")
    return Shipped("Motorway with ramps, 3.4 km", PlainNetwork(nodes, edges), driven)


def country() -> Shipped:
    """Return 3 km of a country road over hills of 40 m: bends to both sides, grades of up to 11 %."""
    bends = ((250.0, 0.0), (260.0, 70.0), (120.0, 0.0), (330.0, -110.0), (200.0, 0.0), (180.0, 60.0), (240.0, -75.0))
    more = ((160.0, 0.0), (420.0, 130.0), (100.0, 0.0), (280.0, -60.0), (300.0, 0.0))
    axis = bent(Pose(0.0, 0.0, 0.3), *bends, *more)
    line = [(pose.x_m, pose.y_m, _hill_m(_STEP_M * place)) for place, pose in enumerate(axis)]
    names = ("valley", "chapel", "pass", "village")
    cuts = [0, len(line) // 3, len(line) * 2 // 3, len(line) - 1]
    nodes = [PlainNode(name, *line[cut]) for name, cut in zip(names, cuts, strict=True)]
    edges: list[PlainEdge] = []
    for place, (one, other) in enumerate(pairwise(names)):
        part = tuple(line[cuts[place] : cuts[place + 1] + 1])
        there = PlainEdge(
            id=f"{one}-{other}", start=one, end=other, line=part, limit_mps=80.0 * MPS_PER_KMH, width_m=3.25
        )
        edges += [there, there._replace(id=f"{other}-{one}", start=other, end=one, line=part[::-1])]
    driven = tuple(f"{one}-{other}" for one, other in pairwise(names))
    ground = "{bank_percent: 5, bank_full_radius_m: 250, off_road_friction_share: 0.6}"
    return Shipped("Hilly country road, 3 km", PlainNetwork(nodes, edges), driven, ground=ground)


def _hill_m(s_m: float) -> float:
    return 20.0 * (1.0 - math.cos(math.tau * s_m / 1600.0)) + 2.0 * math.sin(math.tau * s_m / 370.0)


def skid_pad() -> Shipped:
    """Return a wide straight with a slalom and a double lane change of cones, and a circle of 50 m radius."""
    straight = bent(Pose(0.0, 0.0, 0.0), (600.0, 0.0))
    ring = [
        Pose(700.0 + 50.0 * math.cos(angle), 50.0 * math.sin(angle), angle + 0.5 * math.pi)
        for angle in (math.pi + math.tau * step / 96 for step in range(97))
    ]
    joint = ring[24]
    nodes = [
        PlainNode("start", straight[0].x_m, straight[0].y_m),
        PlainNode("gate", straight[-1].x_m, straight[-1].y_m),
        PlainNode("circle", ring[0].x_m, ring[0].y_m, radius_m=20.0),
        PlainNode("south", joint.x_m, joint.y_m),
    ]
    width = 12.0
    edges = [
        _road("straight", "start", "gate", straight, 100.0, 1, width)._replace(centred=True),
        _road("feeder", "gate", "circle", [straight[-1], ring[0]], 50.0, 1, width)._replace(centred=True),
        _road("circle-1", "circle", "south", ring[:25], 60.0, 1, width)._replace(centred=True, priority=3),
        _road("circle-2", "south", "circle", ring[24:], 60.0, 1, width)._replace(centred=True, priority=3),
    ]
    cones = [(100.0 + 18.0 * number, 0.0) for number in range(10)]
    for from_m, to_m, side in ((330.0, 342.0, -1.8), (355.5, 366.5, 1.6), (379.0, 391.0, -1.8)):
        cones += [(x, side + half) for x in (from_m, 0.5 * (from_m + to_m), to_m) for half in (-1.5, 1.5)]
    driven = ("straight", "feeder", "circle-1", "circle-2")
    return Shipped("Skid pad with cones", PlainNetwork(nodes, edges), driven, _cones(cones))


def _cones(places: Sequence[tuple[float, float]]) -> str:
    lines = []
    for number, (x, y) in enumerate(places):
        corners = ((-_CONE_M, -_CONE_M), (_CONE_M, -_CONE_M), (_CONE_M, _CONE_M), (-_CONE_M, _CONE_M))
        shape = " ".join(f"{x + dx:.2f},{y + dy:.2f}" for dx, dy in corners)
        lines.append(f'  <poly id="cone{number}" type="cone" color="orange" shape="{shape}"/>')
    return "\n".join(("<additional>", *lines, "</additional>", ""))


def _road(
    name: str, start: str, end: str, axis: Sequence[Pose], limit_kmh: float, lanes: int, width_m: float
) -> PlainEdge:
    return PlainEdge(
        id=name,
        start=start,
        end=end,
        line=tuple((pose.x_m, pose.y_m) for pose in axis),
        limit_mps=limit_kmh * MPS_PER_KMH,
        width_m=width_m,
        lanes=lanes,
    )


def _shifted(axis: Sequence[Pose], lateral_m: float) -> list[Pose]:
    """Return an axis that begins where it did and is `lateral_m` further left after 60 m."""
    found = []
    for place, pose in enumerate(axis):
        x = min(place * _STEP_M / 60.0, 1.0)
        side = lateral_m * x * x * (3.0 - 2.0 * x)
        found.append(
            Pose(pose.x_m - side * math.sin(pose.yaw_rad), pose.y_m + side * math.cos(pose.yaw_rad), pose.yaw_rad)
        )
    return found


def write(folder: Path, name: str, shipped: Shipped) -> None:
    """Write one world into a folder. Raises ProfileError."""
    quoted = ", ".join(f'"{edge}"' for edge in shipped.edges)
    lines = [
        "# Written by simconsole.world.tools.shipped_maps.",
        "schema: 1",
        "kind: roads",
        f'title: "{shipped.title}"',
        f"map: {{name: {name}.net.xml}}",
        *([f"polygons: {{name: {name}.poly.xml}}"] if shipped.polygons else []),
        f"route: {{by: edges, edges: [{quoted}]}}",
        *([f"ground: {shipped.ground}"] if shipped.ground else []),
        "",
    ]
    net = build(shipped.network, name)
    try:
        (folder / f"{name}.net.xml").write_bytes(net)
        if shipped.polygons:
            (folder / f"{name}.poly.xml").write_text(shipped.polygons, encoding="utf-8")
        (folder / f"{name}.yaml").write_text("\n".join(lines), encoding="utf-8", newline="\n")
    except OSError as error:
        raise ProfileError(f"{folder}: file: {error.strerror}: a folder that can be written to") from error


def main(arguments: Sequence[str]) -> int:
    """Run the command; return its exit code."""
    if len(arguments) != 1:
        print("usage: python -m simconsole.world.tools.shipped_maps FOLDER", file=sys.stderr)
        return 2
    folder = Path(arguments[0])
    try:
        write(folder, "urban_signals", urban(folder))
        write(folder, "motorway", motorway())
        write(folder, "country", country())
        write(folder, "skid_pad", skid_pad())
    except SimConsoleError as error:
        print(f"error: {error}", file=sys.stderr)
        return error.exit_code
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
