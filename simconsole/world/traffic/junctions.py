"""Who may drive into a junction: nobody without a grant, and no two grants for ways that cross or meet.

A vehicle asks when it comes near its line, and keeps its grant until its rear has left the junction. It gets one if its
light lets it go, no way that crosses its own is granted, nobody who goes first would have to wait for it, and there is
room behind the junction. So two vehicles of traffic never meet inside one.
"""

from typing import Final, NamedTuple

from simconsole.values.kernels import Row, kernel
from simconsole.world.people.yielding import Crossed
from simconsole.world.traffic.following import clearing_s
from simconsole.world.traffic.network import Network
from simconsole.world.traffic_columns import (
    ALONG,
    CONNECTIONS,
    COUNT,
    GRANTS,
    LANE,
    LANES,
    LENGTH,
    SPEED,
    STOOD,
    S,
)

GO: Final = 0
GIVE_WAY: Final = 1
STOP_IF_POSSIBLE: Final = 2
STOP: Final = 3

_ASK_MPS2: Final = 2.0
_HARDEST_MPS2: Final = 3.0  # for a light that changes
_NEAR_M: Final = 6.0
_GAP_S: Final = 1.5
_ROOM_M: Final = 3.0
_WAITED_S: Final = 2.0  # who has stood so long no longer keeps others waiting: else four would wait for each other
_STUCK_S: Final = 3.0
_SOON_S: Final = 2.0
_SOON_M: Final = 2.5  # who sets off before its line is about to enter
_SETS_OFF_MPS: Final = 0.3

SLOT: Final = 0
CONNECTION: Final = 1
DISTANCE: Final = 2
LINE: Final = 3


class Turn(NamedTuple):
    """Work arrays of one step: of each vehicle its line (slot, connection, m to it), of each connection the grants."""

    lines: Row  # float64 [vehicles, LINE]
    granted: Row  # int64 [connections]
    lights: Row  # int64 [connections]
    kept_free: Row  # int64 [connections]: 1: for somebody who is not traffic and has waited long
    crossed: Crossed


@kernel
def find_line(net: Network, path: Row, vehicle: Row, line: Row) -> None:
    """Write the first line ahead of a vehicle that it may not cross yet into `line`; slot -1 for none."""
    front = vehicle[S] + 0.5 * vehicle[LENGTH]
    line[SLOT] = -1.0
    line[CONNECTION] = -1.0
    end = 0.0
    for slot in range(path[COUNT]):
        end += net.lengths_m[path[LANES + slot]]
        if path[CONNECTIONS + slot] < 0 or path[GRANTS + slot] == 1 or end < front - 2.0:
            continue
        line[SLOT] = slot
        line[CONNECTION] = path[CONNECTIONS + slot]
        line[DISTANCE] = end - front
        break


@kernel
def count_grants(net: Network, path: Row, vehicle: Row, granted: Row, lights: Row) -> None:
    """Count the grants that a vehicle holds; take back what a light or a halt has overtaken."""
    front, rear = vehicle[S] + 0.5 * vehicle[LENGTH], vehicle[S] - 0.5 * vehicle[LENGTH]
    end = 0.0
    for slot in range(path[COUNT]):
        end += net.lengths_m[path[LANES + slot]]
        connection = path[CONNECTIONS + slot]
        if connection < 0 or path[GRANTS + slot] == 0 or rear > end + net.ways_m[connection]:
            continue
        ahead = end - front
        stops = ahead > vehicle[SPEED] * vehicle[SPEED] / (2.0 * _HARDEST_MPS2) + 0.5
        if stops and (lights[connection] >= STOP_IF_POSSIBLE or vehicle[STOOD] > _STUCK_S):
            path[GRANTS + slot] = 0
        else:
            granted[connection] += 1


@kernel
def count_others(net: Network, boxes: Row, first: int, granted: Row) -> None:
    """Count for boxes that are not traffic, from row `first` on, the ways that they take or will take at once."""
    for row in range(first, len(boxes)):
        lane = int(boxes[row, LANE])
        if boxes[row, LENGTH] <= 0.0 or lane < 0:
            continue
        left_m = net.lengths_m[lane] - boxes[row, ALONG] - 0.5 * boxes[row, LENGTH]
        enters = boxes[row, SPEED] > _SETS_OFF_MPS and left_m < _SOON_M + _SOON_S * boxes[row, SPEED]
        for connection in range(len(net.goals)):
            if enters and net.origins[connection] == lane:
                granted[connection] += 1
            for place in range(net.via_starts[connection], net.via_starts[connection + 1]):
                if net.via[place] == lane:
                    granted[connection] += 1


@kernel
def decide(net: Network, paths: Row, boxes: Row, values: Row, own: int, turn: Turn) -> None:
    """Grant a vehicle its next line, if it is near enough to ask and may go."""
    slot = int(turn.lines[own, SLOT])
    if slot < 0:
        return
    ahead, speed = turn.lines[own, DISTANCE], values[own, SPEED]
    connection = int(turn.lines[own, CONNECTION])
    if ahead < -0.5 or (
        ahead <= asking_m(speed)
        and _first_in_lane(paths, turn.lines, own)
        and _light_allows(turn.lights[connection], ahead, speed)
        and _ways_free(net, turn.granted, connection)
        and _nobody_goes_first(net, boxes, values, own, turn)
        and _room_behind(net, paths, values, own, connection)
    ):
        paths[own, GRANTS + slot] = 1
        turn.granted[connection] += 1
        turn.lines[own, SLOT] = -1.0
        turn.lines[own, CONNECTION] = -1.0


@kernel
def asking_m(speed_mps: float) -> float:
    """Return how far before its line a vehicle asks: it can still stop with comfort."""
    return _NEAR_M + 0.5 * speed_mps + speed_mps * speed_mps / (2.0 * _ASK_MPS2)


@kernel
def _light_allows(light: float, ahead_m: float, speed_mps: float) -> bool:
    if light == STOP_IF_POSSIBLE:
        return bool(ahead_m < speed_mps * speed_mps / (2.0 * _HARDEST_MPS2))
    return bool(light < STOP_IF_POSSIBLE)


@kernel
def _first_in_lane(paths: Row, lines: Row, own: int) -> bool:
    lane, ahead = paths[own, LANES + int(lines[own, SLOT])], lines[own, DISTANCE]
    for other in range(len(lines)):
        slot = int(lines[other, SLOT])
        if other != own and slot >= 0 and paths[other, LANES + slot] == lane and lines[other, DISTANCE] < ahead:
            return False
    return True


@kernel
def _ways_free(net: Network, granted: Row, connection: int) -> bool:
    for place in range(net.foe_starts[connection], net.foe_starts[connection + 1]):
        if granted[net.foes[place]] > 0:
            return False
    return True


@kernel
def _nobody_goes_first(net: Network, boxes: Row, values: Row, own: int, turn: Turn) -> bool:
    connection = int(turn.lines[own, CONNECTION])
    if turn.lights[connection] == GO:
        return True
    way = turn.lines[own, DISTANCE] + net.ways_m[connection] + values[own, LENGTH]
    needed_s = clearing_s(values[own, SPEED], way) + _GAP_S
    for place in range(net.first_starts[connection], net.first_starts[connection + 1]):
        first = net.firsts[place]
        if turn.lights[first] >= STOP_IF_POSSIBLE:
            continue
        for other in range(len(values)):
            if int(turn.lines[other, CONNECTION]) != first or values[other, STOOD] > _WAITED_S:
                continue
            if turn.lines[other, DISTANCE] < needed_s * (values[other, SPEED] + 1.0):
                return False
        for row in range(len(values), len(boxes)):
            if boxes[row, LENGTH] <= 0.0 or int(boxes[row, LANE]) != net.origins[first] or boxes[row, SPEED] < 0.5:
                continue
            left_m = net.lengths_m[net.origins[first]] - boxes[row, ALONG] - 0.5 * boxes[row, LENGTH]
            if left_m < needed_s * boxes[row, SPEED]:
                return False
    return True


@kernel
def _room_behind(net: Network, paths: Row, values: Row, own: int, connection: int) -> bool:
    """Return whether the lane behind the junction has room, those counted who are granted the way there already."""
    lane = net.goals[connection]
    needed = values[own, LENGTH] + _ROOM_M
    free, taken = net.lengths_m[lane], 0.0
    for other in range(len(values)):
        if other == own or values[other, LENGTH] <= 0.0:
            continue
        start, comes = 0.0, False
        for slot in range(paths[other, COUNT]):
            front = values[other, S] + 0.5 * values[other, LENGTH]
            if start > front + 60.0:
                break
            if paths[other, LANES + slot] == lane and values[other, S] - start < net.lengths_m[lane] + 6.0:
                rear = front - values[other, LENGTH] - start
                if front > start:
                    rear += values[other, SPEED] * values[other, SPEED] / 4.0
                    free = rear if rear < free else free
                elif comes:
                    taken += values[other, LENGTH] + _ROOM_M
            if paths[other, CONNECTIONS + slot] >= 0:
                comes = paths[other, GRANTS + slot] == 1
            start += net.lengths_m[paths[other, LANES + slot]]
    if net.lengths_m[lane] < needed:
        return bool(free == net.lengths_m[lane] and taken == 0.0)
    return bool(free - taken >= needed)
