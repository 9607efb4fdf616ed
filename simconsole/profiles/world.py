"""The world profile: a course as exact path primitives, and what stands on it.

Written by `python -m simconsole.world.tools.generate` from a readable plan (profiles/course_plan.py); nothing here is
meant to be edited by hand. Positions along the course (`s_m`) count from its start.
"""

from typing import Annotated, Literal

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


class WorldProfile(WorldSection, frozen=True, kw_only=True):
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
