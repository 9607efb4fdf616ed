import math
from itertools import pairwise

from simconsole.profiles.files.loader import MAX_DATA_BYTES, load
from simconsole.profiles.world import WorldProfile
from simconsole.world.route import route_of


def test_route_is_one_lap_of_the_course_and_nothing_without_one() -> None:
    route = route_of(load("worlds", "urban", WorldProfile, max_bytes=MAX_DATA_BYTES))
    steps = [math.dist(one[:2], other[:2]) for one, other in pairwise((*route, route[0]))]
    assert len(route) > 1000
    assert max(steps) <= 2.01
    assert route_of(None) == ()
