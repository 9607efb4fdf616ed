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


class GradePoint(WorldSection, frozen=True, kw_only=True):
    """The height of the road's axis at a place; from one to the next the grade is one and the same."""

    s_m: Station
    height_m: Annotated[float, Meta(ge=-1e3, le=1e4)]


class GroundProfile(WorldSection, frozen=True, kw_only=True):
    """The ground of a world that is not flat: how its roads lie, and what is beside them."""

    vertical_curve_m: Annotated[float, Meta(ge=0.0, le=500.0)] = 40.0
    """Length of the vertical curve over which a change of grade is spread."""
    bank_percent: Annotated[float, Meta(ge=0.0, le=12.0)] = 0.0
    """Of the road into a bend whose radius is `bank_full_radius_m` or less; of a wider one less, by curvature."""
    bank_full_radius_m: Annotated[float, Meta(ge=20.0, le=2000.0)] = 250.0
    kerb_m: Annotated[float, Meta(ge=0.0, le=0.2)] = 0.0
    """By how much the ground beside the road is higher than it."""
    off_road_friction_share: Annotated[float, Meta(ge=0.05, le=1.5)] = 0.6
    """Friction beside the road, as a share of the road's."""


class CourseGroundProfile(GroundProfile, frozen=True, kw_only=True):
    """The same of a course, with the heights along it."""

    grades: Annotated[tuple[GradePoint, ...], Meta(max_length=1000)] = ()


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
    ground: CourseGroundProfile | None = None
    """Without it the ground is flat, and the same beside the road as on it."""


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
    ground: GroundProfile | None = None
    """With it the ground is as high as the map's lanes; without it flat, and the same beside the road as on it."""


WorldProfile = CourseProfile | RoadsProfile
KINDS: Final = ("course", "roads")
RESERVED: Final = ("arena",)
