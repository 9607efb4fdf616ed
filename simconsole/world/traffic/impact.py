"""What a collision does to two bodies in the plane: one impulse where they touch (world/obstacles/impulse.py). Pure."""

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

from simconsole.world.obstacles.impulse import RESTITUTION, Mobility, impulse
from simconsole.world.traffic.road_users import Box

_CLOSING_MPS: Final = 1e-3  # sides that approach each other more slowly than this were not the first to touch

Point = tuple[float, float]


class Moving(NamedTuple):
    """A rigid body in `map`; place and velocity are those of its centre of gravity."""

    mass_kg: float
    yaw_inertia_kgm2: float
    x_m: float
    y_m: float
    vx_mps: float
    vy_mps: float
    yaw_rate_radps: float


class Contact(NamedTuple):
    """Where two footprints touch: a point, and the direction from the second to the first, of length 1."""

    x_m: float
    y_m: float
    normal_x: float
    normal_y: float


class Change(NamedTuple):
    """How an impulse changes a body's motion, in `map`."""

    vx_mps: float
    vy_mps: float
    yaw_rate_radps: float


def contact_of(one: Box, other: Box, towards_mps: Point) -> Contact | None:
    """Return where two footprints that overlap touch, None where they do not overlap or do not approach.

    The sides that touched are those that overlap since the shortest time, at the velocity `towards_mps` (x and y, m/s)
    of the first one's middle against the second's.
    """
    shared = _clipped(_corners(one), _corners(other))
    if len(shared) < 3:
        return None
    best, normal = math.inf, (0.0, 0.0)
    for side in (one, other):
        for turned in range(4):
            yaw = side.yaw_rad + 0.5 * math.pi * turned
            x, y = math.cos(yaw), math.sin(yaw)
            closing = -(towards_mps[0] * x + towards_mps[1] * y)
            if closing < _CLOSING_MPS:
                continue
            deep = max(px * x + py * y for px, py in _corners(other)) - min(px * x + py * y for px, py in _corners(one))
            if 0.0 <= deep / closing < best:
                best, normal = deep / closing, (x, y)
    if best == math.inf:
        return None
    count = len(shared)
    return Contact(sum(x for x, _ in shared) / count, sum(y for _, y in shared) / count, *normal)


def collide(one: Moving, other: Moving, contact: Contact) -> tuple[Change, Change] | None:
    """Return how a collision changes the motion of two bodies, None where they do not approach each other there."""
    n, t = (contact.normal_x, contact.normal_y), (-contact.normal_y, contact.normal_x)
    arms = [(contact.x_m - body.x_m, contact.y_m - body.y_m) for body in (one, other)]
    relative = [a - b for a, b in zip(_at(one, arms[0]), _at(other, arms[1]), strict=True)]
    normal_mps, sliding_mps = (relative[0] * axis[0] + relative[1] * axis[1] for axis in (n, t))
    if normal_mps >= 0.0:
        return None
    knn, ktt, knt = 0.0, 0.0, 0.0  # m/s along each axis for an impulse of 1 N s along each
    for body, arm in zip((one, other), arms, strict=True):
        along_n, along_t = arm[0] * n[1] - arm[1] * n[0], arm[0] * t[1] - arm[1] * t[0]
        knn += 1.0 / body.mass_kg + along_n * along_n / body.yaw_inertia_kgm2
        ktt += 1.0 / body.mass_kg + along_t * along_t / body.yaw_inertia_kgm2
        knt += along_n * along_t / body.yaw_inertia_kgm2
    push = impulse(normal_mps, sliding_mps, -(1.0 + RESTITUTION) * normal_mps, Mobility(knn, ktt, knt))
    if push.normal_ns <= 0.0:
        return None
    on_one = (push.normal_ns * n[0] + push.along_ns * t[0], push.normal_ns * n[1] + push.along_ns * t[1])
    return _changed(one, arms[0], on_one, 1.0), _changed(other, arms[1], on_one, -1.0)


def _at(body: Moving, arm: Point) -> Point:
    """Return the velocity of a point of a body, `arm` from its centre of gravity."""
    return body.vx_mps - body.yaw_rate_radps * arm[1], body.vy_mps + body.yaw_rate_radps * arm[0]


def _changed(body: Moving, arm: Point, impulse: Point, sign: float) -> Change:
    turned = arm[0] * impulse[1] - arm[1] * impulse[0]
    per_kg = sign / body.mass_kg
    return Change(impulse[0] * per_kg, impulse[1] * per_kg, sign * turned / body.yaw_inertia_kgm2)


def _corners(box: Box) -> list[Point]:
    """Return the corners of a footprint, to the left round."""
    cosine, sine = 0.5 * math.cos(box.yaw_rad), 0.5 * math.sin(box.yaw_rad)
    forward = (box.length_m * cosine, box.length_m * sine)
    left = (-box.width_m * sine, box.width_m * cosine)
    return [
        (box.x_m + along * forward[0] + aside * left[0], box.y_m + along * forward[1] + aside * left[1])
        for along, aside in ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0))
    ]


def _clipped(polygon: Sequence[Point], by: Sequence[Point]) -> list[Point]:
    """Return the part of a convex polygon inside another (Sutherland and Hodgman 1974)."""
    found = list(polygon)
    for (x, y), (to_x, to_y) in zip(by, (*by[1:], by[0]), strict=True):
        inside = [(to_x - x) * (py - y) - (to_y - y) * (px - x) for px, py in found]
        before, found = found, []
        for place, (point, depth) in enumerate(zip(before, inside, strict=True)):
            last, last_depth = before[place - 1], inside[place - 1]
            if (depth >= 0.0) != (last_depth >= 0.0):
                share = last_depth / (last_depth - depth)
                found.append((last[0] + share * (point[0] - last[0]), last[1] + share * (point[1] - last[1])))
            if depth >= 0.0:
                found.append(point)
    return found
