"""One step of people on foot: they walk, wait at the kerb until vehicles have passed or can stop, and cross.

Nobody steps onto a crossing in front of a vehicle that could not stop with comfort. Who is on it stands still before a
lane whose vehicle cannot stop any more.
"""

import math
from typing import Final, NamedTuple

from simconsole.values.kernels import Row, approach, kernel
from simconsole.world.people.footways import Footways
from simconsole.world.traffic_columns import (
    ALONG,
    BOX,
    COSINE,
    COUNT,
    LANE,
    LANES,
    LENGTH,
    SINE,
    SPEED,
    S,
    X,
    Y,
)

# Rows of float64, one a person. The first BOX values are those of any box on the road.
WALK: Final = BOX  # number of the way
WAY: Final = BOX + 1  # along it, m
PACE: Final = BOX + 2  # at which the person walks
ASIDE: Final = BOX + 3  # from the way's line, to the left on the crossing, m
STEPPED: Final = BOX + 4  # 1: has decided to cross
RESTS: Final = BOX + 5  # of who is not there: until somebody comes, s
PERSON: Final = BOX + 6

SIZE_M: Final = 0.5
"""Length and width of the footprint of a person who walks."""
TALLEST_M: Final = 1.0
"""A box that is shorter than this is a person, not a vehicle."""
_GAIN_MPS2: Final = 2.0
_REACTION_S: Final = 2.0  # that people expect of drivers, from their decision on: it shows only with the first step
_BRAKING_MPS2: Final = 2.0  # likewise
_SPARE_M: Final = 2.0
_HARDEST_MPS2: Final = 6.0
_BEFORE_M: Final = 0.2  # so far before a lane stands who lets a vehicle pass there
_STANDS_MPS: Final = 0.3


class Crowd(NamedTuple):
    """Work arrays of one step."""

    walks: Row  # int64 [crossings]: 1: people may cross as far as lights are concerned
    occupied: Row  # int64 [strips]: 1: somebody is on the crossing and has not passed this strip


class Others(NamedTuple):
    """Everybody who is not on foot."""

    boxes: Row  # float64 [boxes, BOX]
    values: Row  # of the vehicles of traffic, whose boxes come first
    paths: Row
    lengths_m: Row  # of all lanes


class Walkers(NamedTuple):
    """The arrays that each step works on, the same from step to step."""

    ways: Footways
    people: Row
    crowd: Crowd
    others: Others


@kernel
def step_people(all_of: Walkers, period_s: float) -> None:
    """Move all people on by one period; write `people` and `crowd.occupied`."""
    ways, people, crowd, others = all_of.ways, all_of.people, all_of.crowd, all_of.others
    crowd.occupied[:] = 0
    for own in range(len(people)):
        if people[own, LENGTH] > 0.0:
            _walk(ways, people[own], crowd, others, period_s)
    for own in range(len(people)):
        if people[own, LENGTH] > 0.0 and people[own, STEPPED] > 0.0:
            way = int(people[own, WALK])
            for place in range(ways.strip_starts[way], ways.strip_starts[way + 1]):
                if people[own, WAY] < ways.highs_m[place] + SIZE_M:
                    crowd.occupied[ways.strips[place]] = 1


@kernel
def _walk(ways: Footways, person: Row, crowd: Crowd, others: Others, period_s: float) -> None:
    way, s, speed = int(person[WALK]), person[WAY], person[SPEED]
    stopping = speed * speed / (2.0 * _GAIN_MPS2)
    kerb = ways.kerbs_m[way]
    if person[STEPPED] == 0.0 and kerb - s <= stopping + 0.3 and _may_step(ways, way, crowd, others):
        person[STEPPED] = 1.0
    stop = 1e9 if person[STEPPED] > 0.0 else kerb
    if s > ways.ons_m[way] - 0.5 * SIZE_M - 0.3:
        for place in range(ways.strip_starts[way], ways.strip_starts[way + 1]):
            before = ways.lows_m[place] - 0.5 * SIZE_M - _BEFORE_M
            near = s <= before + 0.05 and before - s < stopping + 0.3
            if near and not _free(ways, ways.strips[place], others, 0.0, _HARDEST_MPS2, 0.0):
                stop = before
                break
    wanted = person[PACE]
    left = stop - s
    if left < 0.0:
        left = 0.0
    if 2.0 * _GAIN_MPS2 * left < wanted * wanted:
        wanted = math.sqrt(2.0 * _GAIN_MPS2 * left)
    speed = approach(speed, wanted, _GAIN_MPS2 * period_s)
    if speed * period_s >= left:
        speed, s = 0.0, s + left
    else:
        s += speed * period_s
    person[SPEED], person[WAY] = speed, s
    if s >= ways.points[ways.point_starts[way + 1] - 1, 2]:
        person[LENGTH] = 0.0
    put_on_way(ways, person)


@kernel
def put_on_way(ways: Footways, person: Row) -> None:
    """Write place and heading of a person, `WAY` along their way."""
    way, s = int(person[WALK]), person[WAY]
    row, end = ways.point_starts[way], ways.point_starts[way + 1] - 2
    while row < end and s > ways.points[row + 1, 2]:
        row += 1
    x, y = ways.points[row, 0], ways.points[row, 1]
    dx, dy = ways.points[row + 1, 0] - x, ways.points[row + 1, 1] - y
    length = math.sqrt(dx * dx + dy * dy)
    cosine, sine = (1.0, 0.0) if length < 1e-9 else (dx / length, dy / length)
    along = s - ways.points[row, 2]
    person[X] = x + along * cosine + person[ASIDE] * ways.left[way, 0]
    person[Y] = y + along * sine + person[ASIDE] * ways.left[way, 1]
    person[COSINE], person[SINE] = cosine, sine


@kernel
def _may_step(ways: Footways, way: int, crowd: Crowd, others: Others) -> bool:
    """Return whether lights and vehicles let somebody step onto the crossing of a way."""
    if crowd.walks[ways.crossings[way]] == 0:
        return False
    for place in range(ways.strip_starts[way], ways.strip_starts[way + 1]):
        if not _free(ways, ways.strips[place], others, _REACTION_S, _BRAKING_MPS2, _SPARE_M):
            return False
    return True


@kernel
def _free(ways: Footways, strip: int, others: Others, reaction_s: float, braking_mps2: float, spare_m: float) -> bool:
    """Return whether no vehicle is on a strip, and each that comes can stop before it."""
    first, end = ways.reach_starts[strip], ways.reach_starts[strip + 1]
    for row in range(len(others.boxes)):
        length = others.boxes[row, LENGTH]
        if length < TALLEST_M:
            continue
        lane, along = int(others.boxes[row, LANE]), others.boxes[row, ALONG]
        if row < len(others.values):
            slot, along = 0, others.values[row, S]
            while slot < others.paths[row, COUNT] - 1 and along > others.lengths_m[others.paths[row, LANES + slot]]:
                along -= others.lengths_m[others.paths[row, LANES + slot]]
                slot += 1
            lane = others.paths[row, LANES + slot]
        if lane < 0:
            continue
        speed = others.boxes[row, SPEED]
        for place in range(first, end):
            if ways.reach_lanes[place] != lane:
                continue
            front = ways.reach_m[place] - along - 0.5 * length
            if front + length + ways.over_m[strip] < 0.0:
                continue
            if front < 0.3:
                return False
            needed = speed * reaction_s + speed * speed / (2.0 * braking_mps2) + spare_m
            if speed > _STANDS_MPS and front < needed:
                return False
    return True
