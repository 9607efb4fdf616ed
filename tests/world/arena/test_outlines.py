import numpy as np
import pytest

from simconsole.profiles.world import ArenaPoint, ArenaProfile, Pillar, Spot, Wall
from simconsole.world.arena.outlines import bounds, outlines_of, wall_lines

CORNERS = tuple(ArenaPoint(x_m=x, y_m=y) for x, y in ((0.0, 0.0), (3.0, 0.0), (3.0, 2.0)))
ARENA = ArenaProfile(
    schema=1,
    title="t",
    walls=(Wall(points=CORNERS, closed=True), Wall(points=CORNERS[:2], height_m=1.0)),
    pillars=(Pillar(x_m=-1.0, y_m=4.0, radius_m=0.5),),
    starts=(Spot(name="a", x_m=1.0, y_m=5.0),),
)


def test_a_closed_wall_has_a_side_more_than_an_open_one() -> None:
    found = outlines_of(ARENA)
    assert found.segments.tolist() == [[0, 0, 3, 0], [3, 0, 3, 2], [3, 2, 0, 0], [0, 0, 3, 0]]
    assert found.circles.tolist() == [[-1.0, 4.0, 0.5]]
    assert bounds(found) == (-1.5, 0.0, 3.0, 4.5)


def test_walls_are_drawn_with_their_heights_and_pillars_round() -> None:
    closed, open_, pillar = wall_lines(ARENA)
    assert closed[:, :2].tolist() == [[0, 0], [3, 0], [3, 2], [0, 0]]
    assert open_[:, 2].tolist() == [1.0, 1.0]
    assert np.hypot(pillar[:, 0] + 1.0, pillar[:, 1] - 4.0) == pytest.approx(0.5)
    assert pillar[0] == pytest.approx(pillar[-1])
