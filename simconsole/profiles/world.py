"""The world profile, of one of two kinds: a course as exact path primitives, or a road map and a route on it.

A course is written by `python -m simconsole.world.tools.generate` from a readable plan (profiles/course_plan.py);
nothing of it is meant to be edited by hand. Positions along it (`s_m`) count from its start.
"""

from typing import Annotated, Final, Literal

from msgspec import Meta, Struct

Metres = Annotated[float, Meta(ge=-1e5, le=1e5)]
Station = Annotated[float, Meta(ge=0.0, le=1e5)]
Angle = Annotated[float, Meta(ge=-1e3, le=1e3)]
Curvature = Annotated[float, Meta(ge=-1.0, le=1.0)]


class WorldSection(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of every part: unknown keys are errors."""


class Primitive(WorldSection, frozen=True, kw_only=True):
    """One piece of the theoretical path: curvature runs linearly from start to end (left positive)."""

    kind: Literal["line", "clothoid", "arc"]
    s_m: Station
    x_m: Metres
    y_m: Metres
    yaw_rad: Angle
    length_m: Annotated[float, Meta(gt=0.0, le=1e4)]
    curvature_start_1pm: Curvature
    curvature_end_1pm: Curvature


class Crossing(WorldSection, frozen=True, kw_only=True):
    """A pedestrian crossing over the whole road."""

    s_m: Station
    width_m: Annotated[float, Meta(ge=1.0, le=20.0)]


class Intersection(WorldSection, frozen=True, kw_only=True):
    """A right-angled crossing with another two-lane road, `s_m` at the middle; lights if `signalled`."""

    s_m: Station
    arm_m: Annotated[float, Meta(ge=10.0, le=500.0)]
    signalled: bool


class Roundabout(WorldSection, frozen=True, kw_only=True):
    """A roundabout that the course enters at `s_m` and leaves at `end_s_m`; radius of the lane's centre."""

    s_m: Station
    end_s_m: Station
    x_m: Metres
    y_m: Metres
    radius_m: Annotated[float, Meta(ge=5.0, le=200.0)]


class CourseProfile(WorldSection, frozen=True, kw_only=True, tag_field="kind", tag="course"):
    """One course, driven on the right; the primitives are the centre of the driven lane.

    It is a loop where its end meets its start, else it is open: an autopilot stops at its end.
    """

    schema: Literal[1]
    title: str
    lane_width_m: Annotated[float, Meta(ge=2.0, le=6.0)]
    speed_limit_kmh: Annotated[float, Meta(ge=5.0, le=200.0)]
    length_m: Annotated[float, Meta(gt=0.0, le=1e5)]
    path: Annotated[tuple[Primitive, ...], Meta(min_length=1, max_length=10_000)]
    crossings: tuple[Crossing, ...] = ()
    intersections: tuple[Intersection, ...] = ()
    roundabouts: tuple[Roundabout, ...] = ()


EdgeId = Annotated[str, Meta(min_length=1, max_length=200)]
MapName = Annotated[str, Meta(pattern=r"^.{1,1000}\.xml(\.gz)?$")]
Digest = Annotated[str, Meta(pattern=r"^[0-9a-f]{64}$")]


class MapFile(WorldSection, frozen=True, kw_only=True):
    """A file of the map: in the folder of the profile, or that of the drive, which has it compressed."""

    name: MapName
    sha256: Digest | None = None
    """Of the uncompressed text; a recorded drive has it."""


class RouteByEdges(WorldSection, frozen=True, kw_only=True, tag_field="by", tag="edges"):
    """One edge after the other, each connected to the next."""

    edges: Annotated[tuple[EdgeId, ...], Meta(min_length=1, max_length=10_000)]


class RouteByPlaces(WorldSection, frozen=True, kw_only=True, tag_field="by", tag="places"):
    """The quickest way from one edge to another at the speed limits."""

    start: EdgeId
    goal: EdgeId


class RandomRoute(WorldSection, frozen=True, kw_only=True, tag_field="by", tag="random"):
    """A way that the seed draws, at least `length_m` long where the map lets it, no edge twice."""

    seed: Annotated[int, Meta(ge=0, le=2**53)]
    length_m: Annotated[float, Meta(ge=50.0, le=1e5)] = 2000.0


class RoadsProfile(WorldSection, frozen=True, kw_only=True, tag_field="kind", tag="roads"):
    """A road map, SUMO's `.net.xml`, and the route that is driven on it."""

    schema: Literal[1]
    title: str
    map: MapFile
    polygons: MapFile | None = None
    """Of buildings and cones: SUMO's `.poly.xml`."""
    route: RouteByEdges | RouteByPlaces | RandomRoute


WorldProfile = CourseProfile | RoadsProfile
KINDS: Final = ("course", "roads")
RESERVED: Final = ("arena",)
