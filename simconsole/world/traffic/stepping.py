"""One step of all vehicles: paths, grants, accelerations, positions, changes of lane, in this order."""

import math
from typing import Final, NamedTuple

from simconsole.values.kernels import Row, kernel
from simconsole.values.trigonometry import atan2
from simconsole.world.people.walking import TALLEST_M
from simconsole.world.people.yielding import occupied_ahead
from simconsole.world.traffic.corridor import Body, horizon, near_boxes, nearest_ahead
from simconsole.world.traffic.following import FAR_M, acceleration
from simconsole.world.traffic.junctions import (
    DISTANCE,
    SLOT,
    Turn,
    asking_m,
    count_grants,
    count_others,
    decide,
    find_line,
)
from simconsole.world.traffic.lane_changes import CHANGE_S, consider, rested
from simconsole.world.traffic.network import Network
from simconsole.world.traffic.paths import desired_speed, forget_behind, look_ahead, middle_at
from simconsole.world.traffic.road_users import RoadUserKind
from simconsole.world.traffic_columns import (
    ACCELERATION,
    BOX,
    CHANGED,
    CONNECTIONS,
    COSINE,
    COUNT,
    CRASHED,
    LANES,
    LENGTH,
    OFFSET,
    SINCE_CHANGE,
    SINE,
    SPEED,
    SPEED_SHARE,
    STOOD,
    TIME_GAP,
    WIDTH,
    S,
    X,
    Y,
)

CRASHED_MPS2: Final = 6.0
INDICATED_M: Final = 40.0
"""So far before a junction vehicles indicate where they turn."""
VAN_M: Final = 5.2  # longer vehicles are vans
_CONSIDER_EVERY: Final = 16  # steps; a vehicle's turn comes by its number
_LOOK_EVERY: Final = 2  # steps: looking ahead is most of the work, and people take longer to react
_STANDS_MPS: Final = 0.3
_NEARER_M: Final = 1.0  # to a crossing than to somebody who stands
_PERSON_M: Final = 1.75


@kernel
def step_traffic(
    net: Network, values: Row, paths: Row, boxes: Row, turn: Turn, near: Row, step: int, period_s: float
) -> None:
    """Move all vehicles on by one period.

    Args:
        net: the roads.
        values: of each vehicle, float64 [vehicles, VALUES]; written.
        paths: of each vehicle, int64 [vehicles, PATH]; written.
        boxes: float64 [vehicles + others, BOX]; the others' rows are given, those of traffic written.
        turn: work arrays, and the lights of all connections.
        near: a work array, int64 [vehicles + others].
        step: number of this step.
        period_s: its length.
    """
    count = len(values)
    for connection in range(len(turn.granted)):
        turn.granted[connection] = turn.kept_free[connection]
    for own in range(count):
        show_box(boxes[own], values[own])
        turn.lines[own, SLOT] = -1.0
        turn.lines[own, 1] = -1.0
        if values[own, LENGTH] > 0.0:
            values[own, S] = forget_behind(net, paths[own], values[own, S])
            look_ahead(net, paths[own], values[own, S])
            count_grants(net, paths[own], values[own], turn.granted, turn.lights)
            find_line(net, paths[own], values[own], turn.lines[own])
    count_others(net, boxes, count, turn.granted)
    for own in range(count):
        if values[own, LENGTH] > 0.0:
            decide(net, paths, boxes, values, own, turn)
    for own in range(count):
        if values[own, LENGTH] > 0.0 and (step + own) % _LOOK_EVERY == 0:
            values[own, ACCELERATION] = _wish(net, paths[own], values, own, boxes, turn, near)
        if values[own, CRASHED] > 0.0:
            values[own, ACCELERATION] = -CRASHED_MPS2
    for own in range(count):
        if values[own, LENGTH] > 0.0:
            _move(net, paths[own], values[own], period_s)
            if _has_left(net, paths[own], values[own]):
                values[own, LENGTH] = 0.0
            show_box(boxes[own], values[own])
    for own in range(count):
        asks = values[own, LENGTH] > 0.0 and values[own, CRASHED] == 0.0
        if asks and (step + own) % _CONSIDER_EVERY == 0 and rested(values[own]):
            consider(net, paths, boxes, values, own)


@kernel
def show_box(box: Row, vehicle: Row) -> None:
    """Copy what others see of a vehicle."""
    for column in range(BOX):
        box[column] = vehicle[column]


@kernel
def _wish(net: Network, path: Row, values: Row, own: int, boxes: Row, turn: Turn, near: Row) -> float:
    """Return the acceleration that a vehicle wants: the least of what leader, line and end of lane ask for."""
    speed, s = values[own, SPEED], values[own, S]
    half = 0.5 * values[own, LENGTH]
    offset = _offset(values[own])
    body = Body(half, 0.5 * values[own, WIDTH], offset if offset < 0.0 else 0.0, offset if offset > 0.0 else 0.0)
    reach = horizon(speed)
    count = near_boxes(boxes, own, reach, near)
    desired = desired_speed(net, path, s, values[own, SPEED_SHARE])
    ahead = nearest_ahead(net, path, s, body, boxes, near, count, reach)
    found = acceleration(speed, desired, ahead.gap_m, ahead.speed_mps, values[own, TIME_GAP])
    if turn.lines[own, SLOT] >= 0.0 and turn.lines[own, DISTANCE] <= asking_m(speed):
        line = acceleration(speed, desired, turn.lines[own, DISTANCE], 0.0, 0.5)
        found = line if line < found else found
    crossing = occupied_ahead(net.lengths_m, path, s + half, turn.crossed, reach)
    if crossing < FAR_M:
        stop = acceleration(speed, desired, crossing + _NEARER_M, 0.0, 0.5)
        found = stop if stop < found else found
    last = path[COUNT] - 1
    if path[CONNECTIONS + last] < 0 and net.leaves[path[LANES + last]] == 0:
        end = -s - half
        for slot in range(path[COUNT]):
            end += net.lengths_m[path[LANES + slot]]
        if end < reach and net.out_starts[path[LANES + last]] == net.out_starts[path[LANES + last] + 1]:
            stop = acceleration(speed, desired, end, 0.0, 0.5)
            found = stop if stop < found else found
    return found


@kernel
def _offset(vehicle: Row) -> float:
    """Return how far left of its path a vehicle is while it changes lanes (m)."""
    p = vehicle[CHANGED]
    return float(vehicle[OFFSET] * (1.0 - p * p * (3.0 - 2.0 * p)))


@kernel
def _move(net: Network, path: Row, vehicle: Row, period_s: float) -> None:
    """Move a vehicle along its path with its acceleration (ballistic update), and over to its lane."""
    before = vehicle[SPEED]
    speed = before + vehicle[ACCELERATION] * period_s
    if speed < 0.0:
        speed = 0.0
    way = 0.5 * (before + speed) * period_s
    if speed == 0.0 and before > 0.0:
        way = 0.5 * before * before / -vehicle[ACCELERATION]  # it stands before the period ends
    old = _offset(vehicle)
    vehicle[SPEED] = speed
    vehicle[S] += way
    vehicle[STOOD] = vehicle[STOOD] + period_s if speed < _STANDS_MPS else 0.0
    vehicle[SINCE_CHANGE] += period_s
    if vehicle[CHANGED] < 1.0:
        went = 0.5 * way  # slower than 2 m/s it moves aside no faster than its wheels let it
        ready = vehicle[CHANGED] + (went if went < period_s else period_s) / CHANGE_S
        vehicle[CHANGED] = 1.0 if ready > 1.0 else ready
    new = _offset(vehicle)
    place = middle_at(net, path, vehicle[S])
    vehicle[X] = place.x_m - new * place.sine
    vehicle[Y] = place.y_m + new * place.cosine
    ahead, aside = (way, new - old) if new != old and way > 0.0 else (1.0, 0.0)
    length = math.sqrt(ahead * ahead + aside * aside)
    vehicle[COSINE] = (place.cosine * ahead - place.sine * aside) / length
    vehicle[SINE] = (place.sine * ahead + place.cosine * aside) / length


@kernel
def _has_left(net: Network, path: Row, vehicle: Row) -> bool:
    """Return whether a vehicle has come to where its road leaves the map."""
    if net.leaves[path[LANES + path[COUNT] - 1]] == 0:
        return False
    end = 0.0
    for slot in range(path[COUNT]):
        end += net.lengths_m[path[LANES + slot]]
    return bool(vehicle[S] + 0.5 * vehicle[LENGTH] > end)


@kernel
def indicators(net: Network, path: Row, vehicle: Row) -> float:
    """Return where a vehicle indicates to: 1 left, -1 right, 0 nowhere.

    To where it changes lanes, else to where it leaves the junction that is next, or that it is in.
    """
    if vehicle[CHANGED] < 1.0:
        return 1.0 if vehicle[OFFSET] < 0.0 else -1.0
    front, rear = vehicle[S] + 0.5 * vehicle[LENGTH], vehicle[S] - 0.5 * vehicle[LENGTH]
    end = 0.0
    for slot in range(path[COUNT]):
        end += net.lengths_m[path[LANES + slot]]
        connection = path[CONNECTIONS + slot]
        if connection >= 0 and rear < end + net.ways_m[connection]:
            return float(net.turns[connection]) if end - front < INDICATED_M else 0.0
    return 0.0


class Everybody(NamedTuple):
    """The arrays that each step works on, the same from step to step: what `step_traffic` and `list_users` take."""

    net: Network
    values: Row
    paths: Row
    boxes: Row
    turn: Turn
    near: Row
    ids: Row
    users: Row


class Stepped(NamedTuple):
    """What a step has brought."""

    users: int  # how many are in the table
    gone: int  # how many vehicles are on no road


@kernel
def step_and_list(all_of: Everybody, step: int, period_s: float) -> Stepped:
    """Do as `step_traffic` and `list_users`; a `step` before the first one, -1, is none."""
    if step < 0:
        return Stepped(0, 0)
    values = all_of.values
    step_traffic(all_of.net, values, all_of.paths, all_of.boxes, all_of.turn, all_of.near, step, period_s)
    gone = 0
    for own in range(len(values)):
        if values[own, LENGTH] == 0.0:
            gone += 1
    return Stepped(list_users(all_of.net, values, all_of.paths, all_of.boxes, all_of.ids, all_of.users), gone)


@kernel
def list_all(all_of: Everybody) -> int:
    """Do as `list_users`."""
    return list_users(all_of.net, all_of.values, all_of.paths, all_of.boxes, all_of.ids, all_of.users)


@kernel
def list_users(net: Network, values: Row, paths: Row, boxes: Row, ids: Row, rows: Row) -> int:
    """Write all boxes on the road but the ego's as road users into `rows`, float64 [boxes, FIELDS]; return how many.

    The ego's box is the first that is no vehicle of traffic.
    """
    count = 0
    for row in range(len(boxes)):
        if row == len(values) or boxes[row, LENGTH] <= 0.0:
            continue
        kind, height = float(RoadUserKind.CAR), 1.5
        if boxes[row, LENGTH] > VAN_M:
            kind, height = float(RoadUserKind.VAN), 2.3
        elif boxes[row, LENGTH] < TALLEST_M:
            kind, height = float(RoadUserKind.PEDESTRIAN), _PERSON_M
        rows[count, 0] = ids[row]
        rows[count, 1] = kind
        rows[count, 2], rows[count, 3] = boxes[row, X], boxes[row, Y]
        rows[count, 4] = atan2(boxes[row, SINE], boxes[row, COSINE])
        rows[count, 5] = boxes[row, SPEED]
        rows[count, 6], rows[count, 7] = boxes[row, LENGTH], boxes[row, WIDTH]
        rows[count, 8] = height
        rows[count, 10] = indicators(net, paths[row], values[row]) if row < len(values) else 0.0
        count += 1
    return count
