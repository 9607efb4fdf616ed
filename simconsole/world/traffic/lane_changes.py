"""When a vehicle changes lanes: MOBIL.

Kesting, Treiber, Helbing: General lane-changing model MOBIL for car-following models, Transportation Research Record
1999 (2007), 86-94: a change must be safe for the follower in the new lane, and worth its while with some regard for the
others. Whoever is on a lane that nothing follows must leave it: then only safety counts.
"""

from typing import Final

from simconsole.values.kernels import Row, kernel
from simconsole.world.traffic.following import FAR_M, acceleration
from simconsole.world.traffic.network import Network
from simconsole.world.traffic.paths import look_ahead
from simconsole.world.traffic_columns import (
    ACCELERATION,
    ALONG,
    CHANGED,
    CONNECTIONS,
    COSINE,
    COUNT,
    GRANTS,
    LANE,
    LANES,
    LENGTH,
    OFFSET,
    SINCE_CHANGE,
    SINE,
    SPEED,
    SPEED_SHARE,
    TIME_GAP,
    WIDTH,
    S,
    X,
    Y,
)

POLITENESS: Final = 0.2
THRESHOLD_MPS2: Final = 0.2
SAFE_MPS2: Final = 2.0
FORCED_MPS2: Final = 4.0  # the paper's, for who must leave its lane: a change may make the follower brake so hard
CHANGE_S: Final = 4.0
"""How long a change takes."""
_REST_S: Final = 6.0
_AFTER_M: Final = 20.0  # of its lane are behind it
_BEFORE_M: Final = 45.0  # and so much lies ahead
_SLOWEST_MPS: Final = 2.0
_BESIDE_M: Final = 2.0


@kernel
def consider(net: Network, paths: Row, boxes: Row, values: Row, own: int) -> None:
    """Let a vehicle begin a change of lane, where it may, should and can."""
    path = paths[own]
    start, slot = 0.0, 0
    while slot < path[COUNT] - 1 and values[own, S] > start + net.lengths_m[path[LANES + slot]]:
        start += net.lengths_m[path[LANES + slot]]
        slot += 1
    lane = path[LANES + slot]
    along = values[own, S] - start
    ends = net.out_starts[lane] == net.out_starts[lane + 1] and net.leaves[lane] == 0
    left_m = net.lengths_m[lane] - along
    if net.left[lane] < 0 and net.right[lane] < 0:
        return
    if along < _AFTER_M or (left_m < _BEFORE_M and not ends) or path[GRANTS + slot] == 1:
        return
    if values[own, SPEED] < _SLOWEST_MPS and not ends:
        return
    for side in range(2):
        target = net.left[lane] if side == 0 else net.right[lane]
        if target < 0:
            continue
        if net.leaves[lane] == 0 and net.out_starts[target] == net.out_starts[target + 1]:
            continue
        if _wanted(net, paths, boxes, values, own, lane, target, along, ends):
            _begin(net, path, values[own], lane, target, along, side)
            return


@kernel
def _wanted(
    net: Network, paths: Row, boxes: Row, values: Row, own: int, lane: int, target: int, along: float, ends: bool
) -> bool:
    """Return whether a change is safe and worth its while."""
    there = along * net.lengths_m[target] / net.lengths_m[lane]
    lead_gap, lead_speed, gap, follower = FAR_M, 0.0, FAR_M, -1
    for other in range(len(boxes)):
        if other == own or boxes[other, LENGTH] <= 0.0:
            continue
        place = _along_lane(net, paths, boxes, values, other, target)
        if place >= FAR_M:
            continue
        free = place - there
        apart = 0.5 * (boxes[other, LENGTH] + values[own, LENGTH])
        if free >= 0.0 and free - apart < lead_gap:
            lead_gap, lead_speed = free - apart, boxes[other, SPEED]
        if free < 0.0 and -free - apart < gap:
            gap, follower = -free - apart, other
    if lead_gap < _BESIDE_M or gap < _BESIDE_M or not _room_beside(boxes, own, lane, target, net):
        return False
    speed = values[own, SPEED]
    desired = net.limits_mps[target] * values[own, SPEED_SHARE]
    after = acceleration(speed, desired, lead_gap, lead_speed, values[own, TIME_GAP])
    safe = FORCED_MPS2 if ends else SAFE_MPS2
    if after < -safe:
        return False
    lost = 0.0
    if follower >= 0:
        behind = boxes[follower, SPEED]
        wish = behind if behind > 1.0 else 1.0
        cut = acceleration(behind, 1.2 * wish, gap, speed, 1.2)
        if cut < -safe:
            return False
        before = values[follower, ACCELERATION] if follower < len(values) else 0.0
        lost = before - cut if before > cut else 0.0
    return ends or after - values[own, ACCELERATION] > THRESHOLD_MPS2 + POLITENESS * lost


@kernel
def _along_lane(net: Network, paths: Row, boxes: Row, values: Row, other: int, lane: int) -> float:
    """Return how far along `lane` the middle of a box is, negative where it comes to it; FAR_M if it is not near."""
    if other >= len(values):
        return float(boxes[other, ALONG]) if int(boxes[other, LANE]) == lane else FAR_M
    start = 0.0
    for slot in range(paths[other, COUNT]):
        at = values[other, S] - start
        if at < -60.0:
            break
        if paths[other, LANES + slot] == lane and at < net.lengths_m[lane] + 6.0:
            return float(at)
        start += net.lengths_m[paths[other, LANES + slot]]
    return FAR_M


@kernel
def _room_beside(boxes: Row, own: int, lane: int, target: int, net: Network) -> bool:
    """Return whether no box, on whatever lane, lies where the vehicle would be after the change."""
    side = 0.5 * (net.widths_m[lane] + net.widths_m[target])
    if target < lane:
        side = -side
    cosine, sine = boxes[own, COSINE], boxes[own, SINE]
    for other in range(len(boxes)):
        if other == own or boxes[other, LENGTH] <= 0.0:
            continue
        dx, dy = boxes[other, X] - boxes[own, X], boxes[other, Y] - boxes[own, Y]
        ahead, aside = dx * cosine + dy * sine, dy * cosine - dx * sine
        apart = 0.5 * (boxes[other, LENGTH] + boxes[own, LENGTH]) + _BESIDE_M
        off = aside - side
        near = off < 0.5 * (boxes[other, WIDTH] + boxes[own, WIDTH]) and off > -0.5 * (
            boxes[other, WIDTH] + boxes[own, WIDTH]
        )
        if near and ahead < apart and ahead > -apart:
            return False
    return True


@kernel
def _begin(net: Network, path: Row, vehicle: Row, lane: int, target: int, along: float, side: int) -> None:
    """Put a vehicle onto its new lane, with the offset that it still has from it."""
    path[COUNT] = 1
    path[LANES] = target
    path[CONNECTIONS] = -1
    path[GRANTS] = 0
    vehicle[S] = along * net.lengths_m[target] / net.lengths_m[lane]
    width = 0.5 * (net.widths_m[lane] + net.widths_m[target])
    vehicle[OFFSET] = -width if side == 0 else width
    vehicle[CHANGED] = 0.0
    vehicle[SINCE_CHANGE] = 0.0
    look_ahead(net, path, vehicle[S])


@kernel
def rested(vehicle: Row) -> bool:
    """Return whether a vehicle's last change is done and some time ago."""
    return bool(vehicle[CHANGED] >= 1.0 and vehicle[SINCE_CHANGE] > _REST_S)
