"""From a plan to exact geometry: ramps, roundabout entries, and the three free straights that close the loop."""

import math
from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from simconsole.profiles.course_plan import CoursePlan, Curve, PlannedCrossing, PlannedRoundabout, Straight
from simconsole.profiles.world import CourseProfile, Crossing, Intersection, Primitive, Roundabout
from simconsole.values.errors import ProfileError
from simconsole.values.platform import Pose
from simconsole.values.units import RAD_PER_DEG
from simconsole.world.path_geometry import Piece, centre, travel, travel_all

ORIGIN: Final = Pose(0.0, 0.0, 0.0)
PLACES_M: Final = 10
PLACES_RAD: Final = 13
"""Decimals of a world's figures: finer than any that matters, coarser than any difference between machines."""
_BISECTIONS: Final = 80


class Solved(NamedTuple):
    """One element of the plan with its pieces."""

    element: Straight | Curve | PlannedRoundabout
    pieces: tuple[Piece, ...]


def solve(plan: CoursePlan, name: str) -> CourseProfile:
    """Return the world of `plan`; `name` is the file that errors name.

    Raises ProfileError when a loop does not turn once round, has not three free straights in independent directions,
    or cannot close with straights of positive length; when an open course has free straights; when a curve is too
    short for its ramps.
    """
    solved = [Solved(element, _pieces(element, plan.lane_width_m, name)) for element in plan.elements]
    if plan.length_m is not None:
        solved = _close(solved, plan.length_m, name)
    elif any(_is_free(element) for element in plan.elements):
        raise ProfileError(f"{name}: length_m: value missing: the length of the loop that free straights close")
    path: list[Primitive] = []
    crossings: list[Crossing] = []
    intersections: list[Intersection] = []
    roundabouts: list[Roundabout] = []
    s, pose = 0.0, ORIGIN
    for element, pieces in solved:
        if isinstance(element, Straight):
            for feature in element.features:
                if feature.at_m >= pieces[0].length_m:
                    raise ProfileError(
                        f"{name}: elements.features.at_m: {feature.at_m:g} is beyond its straight, "
                        f"which is {pieces[0].length_m:.1f} m long"
                    )
                at = round(s + feature.at_m, PLACES_M)
                if isinstance(feature, PlannedCrossing):
                    crossings.append(Crossing(s_m=at, width_m=feature.width_m))
                else:
                    intersections.append(Intersection(s_m=at, arm_m=feature.arm_m, signalled=feature.signalled))
        if isinstance(element, PlannedRoundabout):
            roundabouts.append(_ring(element, pieces, s, pose))
        for piece in pieces:
            path.append(_primitive(piece, s, pose))
            s, pose = s + piece.length_m, travel(pose, piece)
    return CourseProfile(
        schema=1,
        title=plan.title,
        lane_width_m=plan.lane_width_m,
        speed_limit_kmh=plan.speed_limit_kmh,
        length_m=round(s, PLACES_M),
        path=tuple(path),
        crossings=tuple(crossings),
        intersections=tuple(intersections),
        roundabouts=tuple(roundabouts),
    )


def _close(solved: list[Solved], length_m: float, name: str) -> list[Solved]:
    """Give the free straights the lengths that bring the path back to its start after `length_m`."""
    yaw, directions = 0.0, []
    for element, pieces in solved:
        if _is_free(element):
            directions.append((math.cos(yaw), math.sin(yaw), 1.0))
        yaw += sum(piece.turn_rad for piece in pieces)
    if abs(abs(yaw) - math.tau) > 1e-9:
        raise ProfileError(
            f"{name}: elements: the course turns {math.degrees(yaw):.6f} deg in all, must be 360 or -360"
        )
    if len(directions) != 3:
        raise ProfileError(f"{name}: elements: {len(directions)} straights are free, must be 3")
    matrix = np.array(directions).T
    if abs(np.linalg.det(matrix)) < 1e-3:
        raise ProfileError(f"{name}: elements: the three free straights must point in different directions")
    end = travel_all(ORIGIN, tuple(piece for part in solved for piece in part.pieces))
    fixed = sum(piece.length_m for part in solved for piece in part.pieces)
    lengths = np.linalg.solve(matrix, np.array((-end.x_m, -end.y_m, length_m - fixed))).tolist()
    if min(lengths) <= 0.0:
        shown = ", ".join(f"{length:.1f}" for length in lengths)
        raise ProfileError(f"{name}: elements: free straights would be {shown} m long, must be above 0")
    free: Iterator[float] = iter(lengths)
    return [Solved(e, (Piece(next(free), 0.0, 0.0),)) if _is_free(e) else Solved(e, pieces) for e, pieces in solved]


def _is_free(element: Straight | Curve | PlannedRoundabout) -> bool:
    return isinstance(element, Straight) and element.length_m == "free"


def _pieces(element: Straight | Curve | PlannedRoundabout, lane_width_m: float, name: str) -> tuple[Piece, ...]:
    if isinstance(element, Straight):
        return () if element.length_m == "free" else (Piece(float(element.length_m), 0.0, 0.0),)
    if isinstance(element, PlannedRoundabout):
        return _roundabout(element, 0.5 * lane_width_m, name)
    turn = element.angle_deg * RAD_PER_DEG
    curvature = math.copysign(1.0 / element.radius_m, turn)
    arc = abs(turn) * element.radius_m - element.ramp_m
    if arc <= 0.0:
        raise ProfileError(
            f"{name}: elements.curve.ramp_m: {element.ramp_m:g} is too long for {element.angle_deg:g} deg at radius "
            f"{element.radius_m:g} m, must be below {abs(turn) * element.radius_m:.2f}"
        )
    ramp = Piece(element.ramp_m, 0.0, curvature)
    return ramp, Piece(arc, curvature, curvature), ramp.mirrored


def _roundabout(element: PlannedRoundabout, axis_offset_m: float, name: str) -> tuple[Piece, ...]:
    """Entry, ring and (mirrored) exit, so that the ring's centre lies on the axis of both roads.

    The road's axis is `axis_offset_m` left of the driven lane. The longer the entry's right curve, the further right
    of the lane the ring comes to lie: one unknown, found by bisection.
    """
    right, left = -1.0 / element.entry_radius_m, 1.0 / element.radius_m

    def entry(arc_m: float) -> tuple[Piece, ...]:
        return (
            Piece(element.ramp_m, 0.0, right),
            Piece(arc_m, right, right),
            Piece(element.swing_m, right, left),
        )

    low, high = 1e-3, element.entry_radius_m * 1.4
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        if centre(travel_all(ORIGIN, entry(middle)), element.radius_m)[1] > axis_offset_m:
            low = middle
        else:
            high = middle
    pieces = entry(0.5 * (low + high))
    _, y = centre(travel_all(ORIGIN, pieces), element.radius_m)
    turn = element.turn_deg * RAD_PER_DEG - 2.0 * sum(piece.turn_rad for piece in pieces)
    if abs(y - axis_offset_m) > 1e-6 or turn <= 0.0:
        raise ProfileError(
            f"{name}: elements.roundabout: no entry of radius {element.entry_radius_m:g} m reaches the ring"
        )
    ring = Piece(turn * element.radius_m, left, left)
    return (*pieces, ring, *(piece.mirrored for piece in reversed(pieces)))


def _ring(element: PlannedRoundabout, pieces: tuple[Piece, ...], s: float, pose: Pose) -> Roundabout:
    x, y = centre(travel_all(pose, pieces[:3]), element.radius_m)
    end = s + sum(piece.length_m for piece in pieces)
    return Roundabout(
        s_m=round(s, PLACES_M),
        end_s_m=round(end, PLACES_M),
        x_m=round(x, PLACES_M),
        y_m=round(y, PLACES_M),
        radius_m=element.radius_m,
    )


def _primitive(piece: Piece, s: float, pose: Pose) -> Primitive:
    straight = piece.curvature_start_1pm == 0.0 == piece.curvature_end_1pm
    bent = "arc" if piece.curvature_start_1pm == piece.curvature_end_1pm else "clothoid"
    return Primitive(
        kind="line" if straight else bent,  # type: ignore[arg-type]  # two of the three literals, from a plain str
        s_m=round(s, PLACES_M),
        x_m=round(pose.x_m, PLACES_M),
        y_m=round(pose.y_m, PLACES_M),
        yaw_rad=round(pose.yaw_rad, PLACES_RAD),
        length_m=round(piece.length_m, PLACES_M),
        curvature_start_1pm=round(piece.curvature_start_1pm, PLACES_RAD),
        curvature_end_1pm=round(piece.curvature_end_1pm, PLACES_RAD),
    )
