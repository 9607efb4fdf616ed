"""The world profile, of one of three kinds: a course as exact path primitives, a road map with a route, or an arena.

A course is written by `python -m simconsole.world.tools.generate` from a readable plan (profiles/course_plan.py);
nothing of it is meant to be edited by hand. Positions along it (`s_m`) count from its start.
"""

import math
from itertools import pairwise
from typing import Annotated, Final, Literal

from msgspec import Meta, Struct

from simconsole.profiles.validation import RegisteredName, worded

Metres = Annotated[float, Meta(ge=-1e5, le=1e5)]
Station = Annotated[float, Meta(ge=0.0, le=1e5)]
Angle = Annotated[float, Meta(ge=-1e3, le=1e3)]
Curvature = Annotated[float, Meta(ge=-1.0, le=1.0)]


class WorldSection(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of every part: unknown keys are errors."""


class Primitive(WorldSection, frozen=True, kw_only=True):
    """One piece of the theoretical path: curvature runs linearly from start to end (left positive)."""

    kind: Literal["line", "clothoid", "arc"]
    """Shape of the piece: straight, with curvature that grows (`clothoid`), or of one curvature."""
    s_m: Station
    """Where the piece begins along the course."""
    x_m: Metres
    """Where the piece begins along x of the map."""
    y_m: Metres
    """Where the piece begins along y of the map."""
    yaw_rad: Angle
    """Heading at the beginning of the piece, left-positive."""
    length_m: Annotated[float, Meta(gt=0.0, le=1e4)]
    """Length of the piece."""
    curvature_start_1pm: Curvature
    """Curvature at the beginning of the piece, left-positive."""
    curvature_end_1pm: Curvature
    """Curvature at the end of the piece, left-positive."""


class Crossing(WorldSection, frozen=True, kw_only=True):
    """A pedestrian crossing over the whole road."""

    s_m: Station
    """Where the middle of the crossing is along the course."""
    width_m: Annotated[float, Meta(ge=1.0, le=20.0)]
    """Width of the crossing along the road."""


class Intersection(WorldSection, frozen=True, kw_only=True):
    """A right-angled crossing with another two-lane road, `s_m` at the middle; lights if `signalled`."""

    s_m: Station
    """Where the middle of the intersection is along the course."""
    arm_m: Annotated[float, Meta(ge=10.0, le=500.0)]
    """How far the crossing road reaches to each side."""
    signalled: bool
    """There are traffic lights at the intersection."""


class Roundabout(WorldSection, frozen=True, kw_only=True):
    """A roundabout that the course enters at `s_m` and leaves at `end_s_m`; radius of the lane's centre."""

    s_m: Station
    """Where the course enters the roundabout."""
    end_s_m: Station
    """Where the course leaves the roundabout."""
    x_m: Metres
    """Middle of the roundabout along x of the map."""
    y_m: Metres
    """Middle of the roundabout along y of the map."""
    radius_m: Annotated[float, Meta(ge=5.0, le=200.0)]
    """Radius of the centre of the lane in the ring."""


class GradePoint(WorldSection, frozen=True, kw_only=True):
    """The height of the road's axis at a place; from one to the next the grade is one and the same."""

    s_m: Station
    """The place along the course."""
    height_m: Annotated[float, Meta(ge=-1e3, le=1e4)]
    """Height of the road's axis there."""


class GroundProfile(WorldSection, frozen=True, kw_only=True):
    """The ground of a world that is not flat: how its roads lie, and what is beside them."""

    vertical_curve_m: Annotated[float, Meta(ge=0.0, le=500.0)] = 40.0
    """Length of the vertical curve over which a change of grade is spread."""
    bank_percent: Annotated[float, Meta(ge=0.0, le=12.0)] = 0.0
    """How far the road leans into a bend of `bank_full_radius_m` or less; into a wider one less, by curvature."""
    bank_full_radius_m: Annotated[float, Meta(ge=20.0, le=2000.0)] = 250.0
    """Radius of a bend up to which the road leans by all of `bank_percent`."""
    kerb_m: Annotated[float, Meta(ge=0.0, le=0.2)] = 0.0
    """By how much the ground beside the road is higher than it."""
    off_road_friction_share: Annotated[float, Meta(ge=0.05, le=1.5)] = 0.6
    """Friction beside the road, as a share of the road's."""


class CourseGroundProfile(GroundProfile, frozen=True, kw_only=True):
    """The same of a course, with the heights along it."""

    grades: Annotated[tuple[GradePoint, ...], Meta(max_length=1000)] = ()
    """Heights along the course; left out, it is level."""


class CourseProfile(WorldSection, frozen=True, kw_only=True, tag_field="kind", tag="course"):
    """One course, driven on the right; the primitives are the centre of the driven lane.

    It is a loop where its end meets its start, else it is open: an autopilot stops at its end.
    """

    schema: Literal[1]
    """Version of this kind of file; always 1."""
    title: str
    """Name of the course for people."""
    lane_width_m: Annotated[float, Meta(ge=2.0, le=6.0)]
    """Width of each lane."""
    speed_limit_kmh: Annotated[float, Meta(ge=5.0, le=200.0)]
    """Speed limit of the whole course."""
    length_m: Annotated[float, Meta(gt=0.0, le=1e5)]
    """Length of the whole course."""
    path: Annotated[tuple[Primitive, ...], Meta(min_length=1, max_length=10_000)]
    """The centre of the driven lane, piece by piece."""
    crossings: tuple[Crossing, ...] = ()
    """Pedestrian crossings; none if left out."""
    intersections: tuple[Intersection, ...] = ()
    """Intersections with other roads; none if left out."""
    roundabouts: tuple[Roundabout, ...] = ()
    """Roundabouts on the course; none if left out."""
    ground: CourseGroundProfile | None = None
    """Heights and banks of the course and what is beside it; left out, the ground is flat, and the same beside the road
    as on it."""


EdgeId = Annotated[str, Meta(min_length=1, max_length=200)]
MapName = Annotated[str, worded(r"^.{1,1000}\.xml(\.gz)?$", "a file that ends in .xml or .xml.gz")]
Digest = Annotated[str, worded(r"^[0-9a-f]{64}$", "a SHA-256 as 64 digits of 0-9a-f")]


class MapFile(WorldSection, frozen=True, kw_only=True, eq=False):
    """A file of the map: in the folder of the profile, or that of the drive, which has it compressed."""

    name: MapName
    """Name of the file, in the folder of the profile or of the drive, which has it compressed."""
    sha256: Digest | None = None
    """SHA-256 of the uncompressed text; a recorded drive has it."""

    def __eq__(self, other: object) -> bool:
        """Return whether the content is the same, wherever it lies: a drive's report finds the world driven in."""
        return isinstance(other, MapFile) and self._content() == other._content()

    def __hash__(self) -> int:
        return hash(self._content())

    def _content(self) -> str:
        return self.sha256 or self.name


class RouteByEdges(WorldSection, frozen=True, kw_only=True, tag_field="by", tag="edges"):
    """One edge after the other, each connected to the next."""

    edges: Annotated[tuple[EdgeId, ...], Meta(min_length=1, max_length=10_000)]
    """Names of the map's edges in the order in which they are driven, each connected to the next."""


class RouteByPlaces(WorldSection, frozen=True, kw_only=True, tag_field="by", tag="places"):
    """The quickest way from one edge to another at the speed limits."""

    start: EdgeId
    """Name of the edge on which the route begins."""
    goal: EdgeId
    """Name of the edge on which the route ends."""


class RandomRoute(WorldSection, frozen=True, kw_only=True, tag_field="by", tag="random"):
    """A way that the seed draws, at least `length_m` long where the map lets it, no edge twice."""

    seed: Annotated[int, Meta(ge=0, le=2**53)]
    """Number that the way is drawn from: equal seeds give equal ways."""
    length_m: Annotated[float, Meta(ge=50.0, le=1e5)] = 2000.0
    """How long the way is at least, where the map lets it."""


class RoadsProfile(WorldSection, frozen=True, kw_only=True, tag_field="kind", tag="roads"):
    """A road map, SUMO's `.net.xml`, and the route that is driven on it."""

    schema: Literal[1]
    """Version of this kind of file; always 1."""
    title: str
    """Name of the road map for people."""
    map: MapFile
    """The road map, SUMO's `.net.xml`."""
    polygons: MapFile | None = None
    """Buildings, walls, trees and cones, SUMO's `.poly.xml`; left out, there are none."""
    route: RouteByEdges | RouteByPlaces | RandomRoute
    """The way that is driven: by edges, by start and goal, or drawn by a seed."""
    ground: GroundProfile | None = None
    """How the ground lies: it is as high as the map's lanes; left out, it is flat, and the same beside the road as on
    it."""


Place = Annotated[float, Meta(ge=-500.0, le=500.0)]
"""A coordinate of an arena, in m of map."""
Height = Annotated[float, Meta(ge=0.05, le=5.0)]
MOST_WALLS: Final = 20_000
KEEP_OFF_M: Final = 0.1
"""A place where a robot shall stand is at least so far from every wall and obstacle."""


class ArenaPoint(WorldSection, frozen=True, kw_only=True):
    """A corner, or a place on the way round."""

    x_m: Place
    """Place along x of the map."""
    y_m: Place
    """Place along y of the map."""


class Wall(WorldSection, frozen=True, kw_only=True):
    """A line of straight walls without thickness, from corner to corner; closed: and back to the first one."""

    points: Annotated[tuple[ArenaPoint, ...], Meta(min_length=2, max_length=1000)]
    """Corners of the wall, one after the other; neighbours must differ."""
    closed: bool = False
    """The wall goes on from its last corner to its first one."""
    height_m: Height = 0.5
    """Height of the wall."""

    @property
    def sides(self) -> tuple[tuple[ArenaPoint, ArenaPoint], ...]:
        """Both ends of each straight piece."""
        return tuple(pairwise((*self.points, self.points[0]) if self.closed else self.points))


class Pillar(WorldSection, frozen=True, kw_only=True):
    """A round obstacle."""

    x_m: Place
    """Middle of the pillar along x of the map."""
    y_m: Place
    """Middle of the pillar along y of the map."""
    radius_m: Annotated[float, Meta(ge=0.01, le=20.0)]
    """Radius of the pillar."""
    height_m: Height = 0.5
    """Height of the pillar."""


class Spot(WorldSection, frozen=True, kw_only=True):
    """A place with a heading where a robot shall stand."""

    name: Annotated[str, worded(r"^[A-Za-z0-9_-]{1,32}$", "letters, digits, _ and -, up to 32")]
    """What the place is called; each name once."""
    x_m: Place
    """Place along x of the map; at least 0.1 m from every wall and pillar."""
    y_m: Place
    """Place along y of the map; at least 0.1 m from every wall and pillar."""
    yaw_deg: Annotated[float, Meta(ge=-180.0, le=180.0)] = 0.0
    """Heading of a robot that stands there, left-positive from x of the map."""


class ArenaProfile(WorldSection, frozen=True, kw_only=True, tag_field="kind", tag="arena"):
    """A flat floor with walls and obstacles, where robots start, and the places of their tasks."""

    schema: Literal[1]
    """Version of this kind of file; always 1."""
    title: str
    """Name of the arena for people."""
    walls: Annotated[tuple[Wall, ...], Meta(max_length=MOST_WALLS)] = ()
    """Walls without thickness; at least one wall or one of `pillars` is needed."""
    pillars: Annotated[tuple[Pillar, ...], Meta(max_length=1000)] = ()
    """Round obstacles; none if left out."""
    starts: Annotated[tuple[Spot, ...], Meta(min_length=1, max_length=64)]
    """Places where robots stand at first; a session without a start begins at the first one."""
    targets: Annotated[tuple[Spot, ...], Meta(max_length=64)] = ()
    """Places of the robots' tasks; none if left out."""
    round: Annotated[tuple[ArenaPoint, ...], Meta(min_length=2, max_length=1000)] | None = None
    """A way through the arena that a robot can drive: the world's route."""

    def __post_init__(self) -> None:
        """Refuse what contradicts itself.

        Raises:
            ValueError: names key and value.
        """
        _require(bool(self.walls or self.pillars), "walls: value []: at least one wall or one of pillars")
        for place, wall in enumerate(self.walls):
            apart = all(math.hypot(b.x_m - a.x_m, b.y_m - a.y_m) > 1e-6 for a, b in wall.sides)
            _require(apart, f"walls[{place}].points: the same point twice in a row: points that differ")
        for key, spots in (("starts", self.starts), ("targets", self.targets)):
            names = [spot.name for spot in spots]
            _require(len(set(names)) == len(names), f"{key}: a name twice in {', '.join(names)}: each one once")
            for spot in spots:
                gap_m = self._gap_m(spot.x_m, spot.y_m)
                _require(
                    gap_m >= KEEP_OFF_M,
                    f"{key}: {spot.name} is {gap_m:.3f} m from a wall or a pillar: at least {KEEP_OFF_M} m",
                )

    def _gap_m(self, x_m: float, y_m: float) -> float:
        """Return how far a place is from what is next to it; negative inside of a pillar."""
        round_ones = [math.hypot(x_m - one.x_m, y_m - one.y_m) - one.radius_m for one in self.pillars]
        straight = [_apart_m(x_m, y_m, a, b) for wall in self.walls for a, b in wall.sides]
        return min((*round_ones, *straight))


class OwnWorldProfile(WorldSection, frozen=True, kw_only=True, tag_field="kind", tag="own"):
    """A world that another package has registered (entry point `simconsole.worlds`)."""

    schema: Literal[1]
    """Version of this kind of file; always 1."""
    title: str
    """Name of the world for people."""
    name: RegisteredName
    """Name under which the other package has registered the world."""
    parameters: dict[str, float] = {}
    """Parameters of the world that differ from its own values; each has bounds of its own."""

    def __hash__(self) -> int:
        """Let equal profiles be one world, which is made once."""
        return hash((self.title, self.name, *sorted(self.parameters.items())))


def _apart_m(x_m: float, y_m: float, a: ArenaPoint, b: ArenaPoint) -> float:
    """Return the distance of a place from a straight wall."""
    along_x, along_y = b.x_m - a.x_m, b.y_m - a.y_m
    share = ((x_m - a.x_m) * along_x + (y_m - a.y_m) * along_y) / (along_x**2 + along_y**2)
    share = min(max(share, 0.0), 1.0)
    return math.hypot(x_m - a.x_m - share * along_x, y_m - a.y_m - share * along_y)


def _require(good: bool, what: str) -> None:
    if not good:
        raise ValueError(what)


WorldProfile = CourseProfile | RoadsProfile | ArenaProfile | OwnWorldProfile
KINDS: Final = ("course", "roads", "arena", "own")
