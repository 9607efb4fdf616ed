"""The path of a vehicle: a window of lanes that moves along with it, and places on it."""

import math
from typing import Final, NamedTuple

from simconsole.values.kernels import Row, kernel
from simconsole.world.traffic.network import Network, segment_to
from simconsole.world.traffic_columns import CONNECTIONS, COUNT, GRANTS, LANES, SLOTS, drawn

AHEAD_M: Final = 220.0
BEHIND_M: Final = 12.0
WHEELBASE_M: Final = 2.6
_SLOWDOWN_MPS2: Final = 1.2
_ROOM: Final = 10  # slots that one connection and its lanes need


class Place(NamedTuple):
    """A point of a path and the direction of the path there."""

    x_m: float
    y_m: float
    cosine: float
    sine: float


@kernel
def forget_behind(net: Network, path: Row, s_m: float) -> float:
    """Drop the lanes that lie more than BEHIND_M behind `s_m`; return `s_m` on what remains."""
    while path[COUNT] > 1 and s_m - net.lengths_m[path[LANES]] > BEHIND_M:
        s_m -= net.lengths_m[path[LANES]]
        path[COUNT] -= 1
        for slot in range(path[COUNT]):
            path[LANES + slot] = path[LANES + slot + 1]
            path[CONNECTIONS + slot] = path[CONNECTIONS + slot + 1]
            path[GRANTS + slot] = path[GRANTS + slot + 1]
    return s_m


@kernel
def look_ahead(net: Network, path: Row, s_m: float) -> None:
    """Choose ways until the path reaches AHEAD_M further than `s_m`, or there is none."""
    total = 0.0
    for slot in range(path[COUNT]):
        total += net.lengths_m[path[LANES + slot]]
    while total < s_m + AHEAD_M and path[COUNT] <= SLOTS - _ROOM:
        last = path[COUNT] - 1
        lane = path[LANES + last]
        first, end = net.out_starts[lane], net.out_starts[lane + 1]
        if first == end:
            break
        connection = net.out[first + drawn(path, end - first)]
        path[CONNECTIONS + last] = connection
        for place in range(net.via_starts[connection], net.via_starts[connection + 1]):
            total += append(net, path, net.via[place])
        total += append(net, path, net.goals[connection])


@kernel
def append(net: Network, path: Row, lane: int) -> float:
    """Add a lane to a path; return its length."""
    slot = path[COUNT]
    path[LANES + slot] = lane
    path[CONNECTIONS + slot] = -1
    path[GRANTS + slot] = 0
    path[COUNT] = slot + 1
    return float(net.lengths_m[lane])


@kernel
def place_at(net: Network, path: Row, s_m: float) -> Place:
    """Return the place `s_m` along a path; before its beginning and behind its end in a straight line."""
    last = path[COUNT] - 1
    slot = 0
    while slot < last and s_m > net.lengths_m[path[LANES + slot]]:
        s_m -= net.lengths_m[path[LANES + slot]]
        slot += 1
    lane = path[LANES + slot]
    row = segment_to(net, lane, net.point_starts[lane], s_m)
    x, y = net.points[row, 0], net.points[row, 1]
    dx, dy = net.points[row + 1, 0] - x, net.points[row + 1, 1] - y
    length = math.sqrt(dx * dx + dy * dy)
    if length < 1e-9:
        return Place(x, y, 1.0, 0.0)
    cosine, sine = dx / length, dy / length
    along = s_m - net.points[row, 2]
    return Place(x + along * cosine, y + along * sine, cosine, sine)


@kernel
def middle_at(net: Network, path: Row, s_m: float) -> Place:
    """Return the middle of a vehicle whose axles are on the path round `s_m`, and its heading."""
    front, rear = place_at(net, path, s_m + 0.5 * WHEELBASE_M), place_at(net, path, s_m - 0.5 * WHEELBASE_M)
    dx, dy = front.x_m - rear.x_m, front.y_m - rear.y_m
    length = math.sqrt(dx * dx + dy * dy)
    if length < 1e-9:
        return front
    return Place(0.5 * (front.x_m + rear.x_m), 0.5 * (front.y_m + rear.y_m), dx / length, dy / length)


@kernel
def desired_speed(net: Network, path: Row, s_m: float, share: float) -> float:
    """Return the speed (m/s) that the limits here and ahead let a vehicle want; it slows down before a lower one."""
    start, found = 0.0, 100.0
    for slot in range(path[COUNT]):
        lane = path[LANES + slot]
        end = start + net.lengths_m[lane]
        if end >= s_m:
            limit = net.limits_mps[lane] * share
            ahead = start - s_m
            if ahead > 0.0:
                if 2.0 * _SLOWDOWN_MPS2 * ahead > found * found:
                    break  # from here on no limit is felt yet
                limit = math.sqrt(limit * limit + 2.0 * _SLOWDOWN_MPS2 * ahead)
            if limit < found:
                found = limit
        start = end
    return 1.0 if found < 1.0 else found
