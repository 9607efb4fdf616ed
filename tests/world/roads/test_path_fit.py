import math
from itertools import pairwise

import numpy as np
import pytest

from simconsole.world.path_geometry import travel
from simconsole.world.roads.path_fit import Corridor, FittedPiece, fit


def corridor(line: list[tuple[float, float]], room_m: float = 0.15) -> Corridor:
    return Corridor(np.array(line), np.full(len(line), room_m), np.full(len(line), 10.0))


def away_m(point: tuple[float, float], line: list[tuple[float, float]]) -> float:
    def from_segment(one: tuple[float, float], other: tuple[float, float]) -> float:
        start, step = np.array(one), np.array(other) - one
        share = float(np.clip((np.array(point) - start) @ step / (step @ step), 0.0, 1.0))
        return float(np.hypot(*(np.array(point) - start - share * step)))

    return min(from_segment(one, other) for one, other in pairwise(line))


def smooth(pieces: list[FittedPiece]) -> None:
    for one, other in pairwise(pieces):
        end = travel(one.start, one.piece)
        assert math.dist(end[:2], other.start[:2]) < 1e-9
        assert end.yaw_rad == pytest.approx(other.start.yaw_rad, abs=1e-9)
        assert one.piece.curvature_end_1pm == other.piece.curvature_start_1pm


@pytest.mark.parametrize("turn_deg", [10.0, -25.0, 40.0])
def test_corner_becomes_a_smooth_bend_inside_its_corridor(turn_deg: float) -> None:
    turn = math.radians(turn_deg)
    line = [(0.0, 0.0), (60.0, 0.0), (60.0 + 60.0 * math.cos(turn), 60.0 * math.sin(turn))]
    pieces = fit(corridor(line))
    smooth(pieces)
    assert max(away_m((piece.start.x_m, piece.start.y_m), line) for piece in pieces) <= 0.15
    assert sum(piece.piece.turn_rad for piece in pieces) == pytest.approx(turn, abs=0.01)


def test_straight_line_stays_straight() -> None:
    pieces = fit(corridor([(0.0, 0.0), (30.0, 40.0)]))
    assert max(abs(piece.piece.curvature_end_1pm) for piece in pieces) < 1e-9
    assert sum(piece.piece.length_m for piece in pieces) == pytest.approx(50.0, abs=0.01)


def test_wide_corridor_gives_a_wider_bend() -> None:
    line = [(0.0, 0.0), (30.0, 0.0), (30.0, 30.0)]
    tight, wide = (
        max(abs(piece.piece.curvature_end_1pm) for piece in fit(corridor(line, room))) for room in (0.15, 1.0)
    )
    assert wide < 0.7 * tight


def test_limits_hold_from_the_point_that_they_belong_to() -> None:
    line = np.array(((0.0, 0.0), (20.0, 0.0), (20.0, 0.0), (50.0, 0.0)))
    pieces = fit(Corridor(line, np.full(4, 0.2), np.array((20.0, 20.0, 5.0, 5.0))))
    assert {round(piece.start.x_m) for piece in pieces if piece.limit_mps == 5.0} >= {25, 40}
    assert all(
        (piece.limit_mps == 5.0) == (piece.start.x_m > 19.7) for piece in pieces if abs(piece.start.x_m - 20) > 1
    )
