"""Whom a vehicle on a route has to let pass: people on crossings, and vehicles with the right of way at junctions.

Seen from where others are and how they move; where they want to go only their indicators tell. Who is on a crossing, or
steps onto it, is let pass until they are beyond the vehicle's lane; who stands at its edge while its own light tells
people to wait does so (SUMO's people wait there, ours further back), and who stands before the lane of a vehicle whose
front is at the crossing already. A vehicle with the right of way is let pass if it comes within the critical headway
(`conflicts.CRITICAL_S`), unless it is on a roundabout and indicates that it leaves it; who is inside the junction is
let out. Vehicles that have stood for a while before their line let others go, and at a traffic light those, too, that
have stood inside the junction and indicate to the left: they wait for who comes.

Who turns to the left and has passed the junction's line still lets oncoming vehicles pass, and waits inside for that,
before their ways; until they have to stop for their own light, whatever the own one shows by then.
"""

from bisect import bisect_left
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np

from simconsole.values.numerics.array_functions import cosine as cosine_of
from simconsole.values.numerics.array_functions import sine as sine_of
from simconsole.values.signals import FAR, SignalState
from simconsole.world.people.footways import KERB_M
from simconsole.world.roads.road_map import Array
from simconsole.world.rules.conflicts import Duties, Entry, Foot, Watched
from simconsole.world.traffic.road_users import RoadUserKind

LightOf = Callable[[int, int], int]
"""Returns the `SignalState` that a link of a signal shows; both by their places in the map."""

AHEAD_M: Final = 80.0
BEHIND_M: Final = 3.0
"""So far behind a line it is still told that its duty was not met."""
EXCUSED_MPS2: Final = 3.0
"""Who would have to brake harder than this when a duty arises has none: as at amber (Gazis, Herman, Maradudin 1960)."""
_EXCUSED_S: Final = 0.3
_LASTS_S: Final = 0.4  # so long a duty is kept after it was seen last
_STOOD_S: Final = 2.0
_STANDS_MPS: Final = 0.3
_STEPS_MPS: Final = 0.3
_AT_KERB_M: Final = 0.06  # nearer to the carriageway than who waits
_EDGE_M: Final = 0.3  # less of a crossing nobody has walked who waits before it
_THERE_M: Final = 0.5  # nearer to a crossing a front keeps people from its lane
_CLEAR_M: Final = 0.5
_BESIDE_M: Final = 1.5  # further from a lane's centre line nobody is on it
_ALIGNED: Final = 0.6
_SETS_OFF_MPS: Final = 2.5  # who is slower than this may speed up
_INSIDE_S: Final = 3.0  # who is inside the junction and reaches the common place later than this is passed
_SLOWEST_MPS: Final = 3.0
_AMBER: Final = (SignalState.PERMISSIVE_CLEARANCE, SignalState.PROTECTED_CLEARANCE)
_STOPS: Final = (SignalState.STOP_AND_REMAIN, SignalState.PRE_MOVEMENT, *_AMBER)


class Owed(NamedTuple):
    """What a vehicle owes others."""

    yield_m: float  # from its front to the line before which it waits, negative just beyond it; FAR: nothing is owed
    yield_s: float  # until who goes first is in its way; FAR: nobody would be hindered


NOTHING_OWED: Final = Owed(FAR, FAR)


class Motion(NamedTuple):
    """The vehicle that owes."""

    front_m: float  # of its front, along the route
    speed_mps: float
    time_s: float


class RightOfWay:
    """Looks at others along a route, again and again; it remembers who has stood, and which duties there are."""

    def __init__(self, duties: Duties) -> None:
        """Take where the route gives way."""
        lines = [(foot.line_m, foot) for foot in duties.crossings] + [(one.line_m, one) for one in duties.entries]
        self._lines: list[tuple[float, Foot | Entry]] = sorted(lines, key=lambda line: line[0])
        self._at = [line for line, _ in self._lines]
        self._inside = {id(one.connection) for one in duties.entries if one.inside}
        self._stood: dict[float, float] = {}
        self._seen: dict[int, float] = {}  # when each duty was seen last
        self._hindered: dict[int, float] = {}
        self._excused: set[int] = set()

    def owed(self, own: Motion, users: Array, light: LightOf) -> Owed:
        """Return what is owed now; `users` are the others, float64 [users, FIELDS of RoadUser]."""
        first, end = bisect_left(self._at, own.front_m - BEHIND_M), bisect_left(self._at, own.front_m + AHEAD_M)
        near = range(first, end)
        for gone in [line for line in self._seen if line not in near]:
            self._forget(gone)
        if first == end:
            return NOTHING_OWED
        standing = self._standing(users, own.time_s)
        for line in near:
            place, duty = self._lines[line]
            left_m = place - own.front_m
            if left_m < 0.0 and (line not in self._seen or self._waits_inside(duty)):
                continue
            found = _who_goes_first(duty, left_m, own.speed_mps, users, standing, light)
            if found is not None:
                self._take(line, left_m, own, found)
            elif line in self._seen and own.time_s - self._seen[line] > _LASTS_S:
                self._forget(line)
            if line in self._seen and (line not in self._excused or isinstance(duty, Foot)):
                return Owed(left_m, FAR if line in self._excused else self._hindered[line])
        return NOTHING_OWED

    def _waits_inside(self, duty: Foot | Entry) -> bool:
        """Return whether who has passed this line may still wait for the same vehicles, inside the junction."""
        return isinstance(duty, Entry) and not duty.inside and id(duty.connection) in self._inside

    def _take(self, line: int, left_m: float, own: Motion, hindered_s: float) -> None:
        needed_m = own.speed_mps * (_EXCUSED_S + own.speed_mps / (2.0 * EXCUSED_MPS2))
        if line not in self._seen and left_m < needed_m:
            self._excused.add(line)
        self._seen[line], self._hindered[line] = own.time_s, hindered_s

    def _forget(self, line: int) -> None:
        del self._seen[line]
        self._excused.discard(line)

    def _standing(self, users: Array, now_s: float) -> Array:
        """Return which users have stood for a while."""
        stands = users[:, 5] < _STANDS_MPS
        self._stood = {user: self._stood.get(user, now_s) for user in users[stands, 0].tolist()}
        return np.array([now_s - self._stood.get(user, now_s) > _STOOD_S for user in users[:, 0].tolist()], np.bool_)


def _who_goes_first(
    duty: Foot | Entry, left_m: float, speed_mps: float, users: Array, standing: Array, light: LightOf
) -> float | None:
    """Return in how many seconds who goes first is in the way, FAR: nobody is hindered; None: nobody goes first."""
    on_foot = users[:, 1] == RoadUserKind.PEDESTRIAN
    if isinstance(duty, Foot):
        return 0.0 if len(users) and _somebody_crosses(duty, left_m, users[on_foot], light) else None
    return _vehicle_first(duty, left_m, speed_mps, users[~on_foot], standing[~on_foot], light)


def _somebody_crosses(foot: Foot, left_m: float, people: Array, light: LightOf) -> bool:
    """Return whether somebody is on a crossing, or steps onto it, and has not passed the vehicle's lane.

    Who stands on it before that lane waits for a vehicle whose front is there already.
    """
    (x, y), (to_x, to_y) = foot.crossing.line[[0, -1]].tolist()
    length = float(np.hypot(to_x - x, to_y - y))
    cosine, sine = (to_x - x) / length, (to_y - y) / length
    along = (people[:, 2] - x) * cosine + (people[:, 3] - y) * sine
    aside = np.abs((people[:, 3] - y) * cosine - (people[:, 2] - x) * sine)
    forth = cosine_of(people[:, 4]) * cosine + sine_of(people[:, 4]) * sine
    walked = np.where(forth > 0.0, along, length - along)
    passed = np.where(forth > 0.0, foot.high_m, length - foot.low_m) + _CLEAR_M
    steps = (people[:, 5] > _STEPS_MPS) & (walked > _AT_KERB_M - KERB_M) & (np.abs(forth) > _ALIGNED)
    on = (walked > -0.25) & (walked < length)
    if foot.crossing.signal >= 0 and light(foot.crossing.signal, foot.crossing.link) in _STOPS:
        on &= (walked > _EDGE_M) | (people[:, 5] > _STEPS_MPS)
    if left_m < _THERE_M:
        on &= (people[:, 5] > _STEPS_MPS) | (walked > np.where(forth > 0.0, foot.low_m, length - foot.high_m))
    there = (aside < 0.5 * foot.crossing.width_m + _CLEAR_M) & (walked < passed)
    return bool((there & (steps | on)).any())


def _vehicle_first(
    entry: Entry, left_m: float, speed_mps: float, vehicles: Array, standing: Array, light: LightOf
) -> float | None:
    connection = entry.connection
    own_light = SignalState.UNAVAILABLE if connection.signal < 0 else light(connection.signal, connection.link)
    if own_light in _STOPS and not entry.inside:
        return None
    protected = own_light == SignalState.PROTECTED_MOVEMENT_ALLOWED
    reaches_s = max(left_m, 0.0) / max(speed_mps, _SLOWEST_MPS)
    hindered_s = None
    way = entry.watched
    found = _on_ways(way, vehicles)
    leaving = {user for user, place in found if way.ring[place] > 0.0 and vehicles[user, 10] < 0.0}
    for user, place in found:
        speed, half = float(vehicles[user, 5]), 0.5 * float(vehicles[user, 6])
        inside = way.inside[place] > 0.0
        goes_first = way.first[place] > 0.0 and not protected
        left = float(way.to_m[place]) - half
        if inside:
            held = connection.signal >= 0 and standing[user] and vehicles[user, 10] > 0.0 and left > 0.0
        else:
            held = standing[user] or _is_held(way, place, left, speed, light)
        if held or user in leaving or not (goes_first or inside):
            continue
        comes_s = max(left, 0.0) / max(speed, _SETS_OFF_MPS)
        leaves_s = (float(way.past_m[place]) + half) / max(speed, 1.0)
        if leaves_s > reaches_s and comes_s < reaches_s + (entry.critical_s if goes_first else _INSIDE_S):
            in_way_s = max(left, 0.0) / max(speed, 0.1) if goes_first else FAR
            hindered_s = in_way_s if hindered_s is None else min(hindered_s, in_way_s)
    return hindered_s


def _on_ways(watched: Watched, vehicles: Array) -> list[list[int]]:
    """Return (vehicle, point) for each that is on one of the ways: on each way the point that is nearest to it."""
    reach = np.hypot(np.ptp(watched.x_m), np.ptp(watched.y_m)) + _BESIDE_M
    far = np.hypot(vehicles[:, 2] - watched.x_m[0], vehicles[:, 3] - watched.y_m[0]) > reach
    if far.all():
        return []
    dx = vehicles[:, None, 2] - watched.x_m[None, :]
    dy = vehicles[:, None, 3] - watched.y_m[None, :]
    along = dx * watched.cosine + dy * watched.sine
    aside = np.abs(dy * watched.cosine - dx * watched.sine)
    aligned = cosine_of(vehicles[:, None, 4]) * watched.cosine + sine_of(vehicles[:, None, 4]) * watched.sine
    on = (np.abs(along) <= 0.5) & (aside < _BESIDE_M) & (aligned > _ALIGNED)
    return np.argwhere(on).tolist()


def _is_held(way: Watched, place: int, left_m: float, speed_mps: float, light: LightOf) -> bool:
    """Return whether a light stops who is `left_m` before the meeting; at amber not who is too near to its line."""
    signal = int(way.signal[place])
    state = light(signal, int(way.link[place])) if signal >= 0 else SignalState.UNAVAILABLE
    if state in _AMBER:
        return speed_mps * speed_mps <= 2.0 * EXCUSED_MPS2 * max(left_m - float(way.line_m[place]), 0.0)
    return state in _STOPS
