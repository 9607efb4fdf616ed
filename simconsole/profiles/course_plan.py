"""The plan of a course: what a person writes down, before the geometry is solved (world/planning.py)."""

from typing import Annotated, Literal

from msgspec import Meta, Struct

Length = Annotated[float, Meta(gt=0.0, le=1e4)]
Radius = Annotated[float, Meta(ge=8.0, le=1e4)]


class PlanSection(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of every part: unknown keys are errors."""


class PlannedCrossing(PlanSection, frozen=True, kw_only=True, tag_field="feature", tag="crossing"):
    """A pedestrian crossing, `at_m` from the beginning of its straight."""

    at_m: Annotated[float, Meta(ge=0.0, le=1e4)]
    """Where the crossing is, from the beginning of its straight."""
    width_m: Annotated[float, Meta(ge=1.0, le=20.0)] = 4.0
    """Width of the crossing along the road."""


class PlannedIntersection(PlanSection, frozen=True, kw_only=True, tag_field="feature", tag="intersection"):
    """A road that crosses at right angles, its middle `at_m` from the beginning of the straight."""

    at_m: Annotated[float, Meta(ge=0.0, le=1e4)]
    """Where the middle of the intersection is, from the beginning of its straight."""
    arm_m: Annotated[float, Meta(ge=10.0, le=500.0)] = 60.0
    """How far the crossing road reaches to each side."""
    signalled: bool = True
    """Put traffic lights at the intersection."""


class Straight(PlanSection, frozen=True, kw_only=True, tag_field="element", tag="straight"):
    """A straight. Exactly three straights of a loop are `free`: their lengths close it at its total length."""

    length_m: Length | Literal["free"]
    """Length of the straight, or `free`: exactly three straights of a loop are free, and their lengths close it."""
    features: tuple[PlannedCrossing | PlannedIntersection, ...] = ()
    """Crossings and intersections on this straight; none if left out."""


class Curve(PlanSection, frozen=True, kw_only=True, tag_field="element", tag="curve"):
    """A curve of `radius_m` with a curvature ramp (clothoid) at each end; left positive, `angle_deg` in total."""

    radius_m: Radius
    """Radius of the arc, of the centre of the driven lane."""
    angle_deg: Annotated[float, Meta(ge=-180.0, le=180.0)]
    """How far the road turns in all, ramps included; left is positive."""
    ramp_m: Length = 9.0
    """Length of the clothoid at each end, over which the curvature grows."""


class PlannedRoundabout(PlanSection, frozen=True, kw_only=True, tag_field="element", tag="roundabout"):
    """A roundabout, entered and left by right curves; the course leaves it `turn_deg` to the left of its entry."""

    radius_m: Radius
    """Radius of the centre of the lane in the ring."""
    entry_radius_m: Radius
    """Radius of the right curves that lead in and out."""
    turn_deg: Annotated[float, Meta(ge=-90.0, le=180.0)]
    """Direction in which the course leaves, counted from that of its entry; left is positive."""
    ramp_m: Length = 9.0
    """Length of the clothoids at the outer ends of the right curves."""
    swing_m: Length = 14.0
    """Length of the clothoid from the entry's right curve to the ring's left curve."""


class CoursePlan(PlanSection, frozen=True, kw_only=True):
    """A course from the map's origin along +x: a loop of `length_m`, or open, where that is left out."""

    schema: Literal[1]
    """Version of this kind of file; always 1."""
    title: str
    """Name of the course for people."""
    lane_width_m: Annotated[float, Meta(ge=2.0, le=6.0)]
    """Width of each lane."""
    speed_limit_kmh: Annotated[float, Meta(ge=5.0, le=200.0)]
    """Speed limit of the whole course."""
    length_m: Annotated[float, Meta(ge=100.0, le=1e5)] | None = None
    """Length of the whole loop; left out: the course is open, and nothing is `free`."""
    elements: Annotated[tuple[Straight | Curve | PlannedRoundabout, ...], Meta(min_length=1, max_length=1000)]
    """Straights, curves and roundabouts in the order in which they are driven."""
