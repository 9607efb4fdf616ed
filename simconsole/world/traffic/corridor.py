"""What is in a vehicle's way: the first box, of whatever kind, in the corridor that its body sweeps along its path."""

import math
from typing import Final, NamedTuple

from simconsole.values.kernels import Row, kernel
from simconsole.world.traffic.following import FAR_M
from simconsole.world.traffic.network import Network, segment_to
from simconsole.world.traffic_columns import COSINE, COUNT, LANES, LENGTH, SINE, SPEED, WIDTH, X, Y

MARGIN_M: Final = 0.35
_DISCS: Final = 5  # that cover a box, from end to end
_INSIDE: Final = 0.6  # of their radius the outermost lie inside it, so that its corners are covered too


class Ahead(NamedTuple):
    """The gap to the nearest box ahead, bumper to bumper, FAR_M for none, and its speed along the path."""

    gap_m: float
    speed_mps: float


class Body(NamedTuple):
    """The vehicle that looks: half its length and width, and how far left of its path the corridor reaches (m)."""

    half_length_m: float
    half_width_m: float
    low_m: float
    high_m: float


@kernel
def near_boxes(boxes: Row, own: int, horizon_m: float, near: Row) -> int:
    """Write the rows of boxes within `horizon_m`, but not far behind, into `near`; return how many."""
    x, y, cosine, sine = boxes[own, X], boxes[own, Y], boxes[own, COSINE], boxes[own, SINE]
    reach = horizon_m + 10.0
    count = 0
    for other in range(len(boxes)):
        if other == own or boxes[other, LENGTH] <= 0.0:
            continue
        dx, dy = boxes[other, X] - x, boxes[other, Y] - y
        if dx * dx + dy * dy < reach * reach and dx * cosine + dy * sine > -15.0:
            near[count] = other
            count += 1
    return count


@kernel
def nearest_ahead(
    net: Network, path: Row, s_m: float, body: Body, boxes: Row, near: Row, count: int, horizon_m: float
) -> Ahead:
    """Return the nearest of the `count` boxes `near` in the corridor of `body` from its middle `s_m` on."""
    start, gap, speed = 0.0, FAR_M, 0.0
    for slot in range(path[COUNT]):
        lane = path[LANES + slot]
        end = start + net.lengths_m[lane]
        if start > s_m + horizon_m or start - s_m - body.half_length_m > gap:
            break
        if count > 0 and end > s_m:
            row, last = segment_to(net, lane, net.point_starts[lane], s_m - start), net.point_starts[lane + 1] - 2
            while row <= last:
                reach = net.points[row + 1, 2]
                if start + reach <= s_m:
                    row += 1
                    continue
                free = net.points[row, 2] + _room(net.points[row, 0], net.points[row, 1], body, boxes, near, count)
                if reach < free:  # up to there along the lane nobody can be in the way
                    row = segment_to(net, lane, row + 1, free) if net.points[last + 1, 2] >= free else last + 1
                else:
                    found = _on_segment(net, row, s_m - start, body, boxes, near, count)
                    if found.gap_m < gap:
                        gap, speed = found.gap_m, found.speed_mps
                    row += 1
        start = end
    return Ahead(gap, speed)


@kernel
def _room(x: float, y: float, body: Body, boxes: Row, near: Row, count: int) -> float:
    """Return how far (m) a path that begins at a place may go on without coming near a box; less than 0: it is near."""
    aside = body.high_m if body.high_m > -body.low_m else -body.low_m
    found = FAR_M
    for place in range(count):
        box = near[place]
        dx, dy = boxes[box, X] - x, boxes[box, Y] - y
        reach = 0.5 * (boxes[box, LENGTH] + boxes[box, WIDTH]) + body.half_width_m + aside + MARGIN_M
        room = math.sqrt(dx * dx + dy * dy) - reach
        found = room if room < found else found
    return found


@kernel
def _on_segment(net: Network, row: int, from_m: float, body: Body, boxes: Row, near: Row, count: int) -> Ahead:
    """Return the nearest box on one segment of a lane, for a vehicle whose middle is `from_m` along the lane."""
    x, y, way = net.points[row, 0], net.points[row, 1], net.points[row, 2]
    dx, dy = net.points[row + 1, 0] - x, net.points[row + 1, 1] - y
    length = net.points[row + 1, 2] - way
    gap, speed = FAR_M, 0.0
    if length < 1e-9:
        return Ahead(gap, speed)
    dx, dy = dx / length, dy / length
    for place in range(count):
        box = near[place]
        to_x, to_y = boxes[box, X] - x, boxes[box, Y] - y
        along, lateral = to_x * dx + to_y * dy, dx * to_y - dy * to_x
        reach = 0.5 * boxes[box, LENGTH] + body.half_width_m + 2.0
        if along < -reach or along > length + reach:
            continue
        if lateral < body.low_m - reach or lateral > body.high_m + reach:
            continue
        radius = 0.5 * boxes[box, WIDTH]
        ahead = dx * boxes[box, COSINE] + dy * boxes[box, SINE]
        aside = dx * boxes[box, SINE] - dy * boxes[box, COSINE]
        for disc in range(_DISCS):
            shift = 0.5 * (disc - 2) * (0.5 * boxes[box, LENGTH] - _INSIDE * radius)
            there, off = along + shift * ahead, lateral + shift * aside
            beyond = there - length if there > length else (-there if there < 0.0 else 0.0)
            side = off - body.high_m if off > body.high_m else (body.low_m - off if off < body.low_m else 0.0)
            most = body.half_width_m + radius + MARGIN_M
            if beyond * beyond + side * side > most * most or way + there <= from_m:
                continue
            free = way + there - from_m - body.half_length_m - radius
            if free < gap:
                gap = free
                speed = boxes[box, SPEED] * ahead
    return Ahead(gap, 0.0 if speed < 0.0 else speed)


@kernel
def horizon(speed_mps: float) -> float:
    """Return how far ahead a vehicle looks (m)."""
    found = 15.0 + 2.5 * speed_mps + speed_mps * speed_mps / 3.0
    return 200.0 if found > 200.0 else found
