import math
from random import Random

import pytest

from simconsole.hud.guidance import OFF_ROUTE_M, Guidance, ahead, guidance_of
from simconsole.profiles.files.world_files import load_world
from simconsole.values.platform import Pose
from simconsole.world.kinds.worlds import open_world
from simconsole.world.path_geometry import Piece
from simconsole.world.route import Route, Stretch, Turn
from tests.samples import Sample


def route_of(world: str) -> Route:
    return open_world(load_world(world)).route


def straight(*turns: Turn) -> Guidance:
    route = Route([Stretch(0.0, Pose(0.0, 0.0, 0.0), Piece(1000.0, 0.0, 0.0), 14.0)])
    route.turns = turns
    return guidance_of(route)


def test_the_next_turn_is_told_until_it_is_driven() -> None:
    guidance = straight(Turn(200.0, 220.0, 1.5), Turn(500.0, 510.0, -1.0, 2))
    before = None
    told = []
    for x in (0.0, 150.0, 205.0, 221.0, 505.0, 511.0, 990.0):
        found, before = ahead(guidance, x, 1.0, 0.05, before)
        assert found is not None
        told.append((round(found.distance_m, 6), found.angle_rad, found.exit, found.is_end))
    assert told == [
        (200.0, 1.5, 0, False), (50.0, 1.5, 0, False), (0.0, 1.5, 0, False), (279.0, -1.0, 2, False),
        (0.0, -1.0, 2, False), (489.0, 0.0, 0, True), (10.0, 0.0, 0, True),
    ]  # fmt: skip


def test_nobody_beside_the_route_or_against_it_is_told_to_turn() -> None:
    guidance = straight(Turn(200.0, 220.0, 1.5))
    assert ahead(guidance, 100.0, OFF_ROUTE_M + 1.0, 0.0, 90.0) == (None, None)
    assert ahead(guidance, 100.0, 0.0, math.pi, 90.0) == (None, None)
    back, _ = ahead(guidance, 100.0, 5.0, 0.1, None)
    assert back is not None
    assert back.distance_m == pytest.approx(100.0, abs=1e-6)


def test_a_loop_begins_anew() -> None:
    urban = route_of("urban")
    guidance = guidance_of(urban)
    (turn,) = urban.turns
    at = urban.at(2500.0)
    found, place = ahead(guidance, at.x_m, at.y_m, at.yaw_rad, 2495.0)
    assert found is not None
    assert found.distance_m == pytest.approx(turn.s_m + 100.0, abs=1.0)
    start = urban.at(1.0)
    again, _ = ahead(guidance, start.x_m, start.y_m, start.yaw_rad, place)
    assert again is not None
    assert again.distance_m == pytest.approx(turn.s_m - 1.0, abs=1.0)


@pytest.mark.parametrize("world", ["urban", "urban_signals"])
def test_distances_are_those_of_the_route(world: str, sample: Sample) -> None:
    route = route_of(world)
    guidance = guidance_of(route)
    assert len(guidance.points) < route.length_m / 10.0
    turn = route.turns[0]
    random = Random(sample.seed)
    for s in (random.uniform(0.0, turn.s_m) for _ in range(sample.of(200, 5000))):
        at = route.at(s)
        aside = random.uniform(-2.0, 2.0)
        x, y = at.x_m - aside * math.sin(at.yaw_rad), at.y_m + aside * math.cos(at.yaw_rad)
        found, _ = ahead(guidance, x, y, at.yaw_rad + random.uniform(-0.3, 0.3), None)
        assert found is not None
        assert found.distance_m == pytest.approx(turn.s_m - s, abs=3.0), s
        assert found.exit == turn.exit
