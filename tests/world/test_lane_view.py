"""The place that is followed beside a path, against the projection that is searched for."""

import math

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import holding
from simconsole.values.layout import write
from simconsole.values.platform import Pose
from simconsole.values.signals import Mode
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from simconsole.world.kinds.worlds import open_world
from simconsole.world.lane_view import AHEAD_M, LaneView, lane_view, path_of, place_at
from simconsole.world.path_geometry import Piece
from simconsole.world.route import Route, Stretch

ROUTE = open_world(load_world("urban")).route


def vector_at(x_m: float, y_m: float, yaw_rad: float, mode: Mode = Mode.AUTONOMOUS) -> np.ndarray:
    vector = np.zeros(PLATFORM_AT)
    blank = Snapshot(1, 250, vector)
    write(vector, LAYOUT.vehicle, blank.vehicle._replace(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad, vx_mps=7.0))
    write(vector, LAYOUT.arbitration, blank.arbitration._replace(mode=float(mode)))
    return vector


@pytest.mark.parametrize("lateral_m", [-1.5, 0.0, 1.5])
def test_a_lap_is_seen_as_the_projection_sees_it(lateral_m: float) -> None:
    path, seen = path_of(ROUTE), np.zeros(len(LaneView._fields))
    look = holding(compiled(lane_view), path)
    place, turned = place_at(path, 0.0), 0.05
    for s_m in np.arange(0.0, 1.2 * ROUTE.length_m, 0.7).tolist():
        at = ROUTE.at(s_m)
        x_m, y_m = at.x_m - lateral_m * math.sin(at.yaw_rad), at.y_m + lateral_m * math.cos(at.yaw_rad)
        assert look(vector_at(x_m, y_m, at.yaw_rad + turned), place, seen)
        view = LaneView(*seen.tolist())
        assert view.lateral_m == place[3] == pytest.approx(lateral_m, abs=0.02)
        assert view.heading_rad == pytest.approx(turned, abs=0.03)
        assert place[2] == pytest.approx(s_m, abs=0.2)
        ahead = [view.curvature_5m_1pm, view.curvature_10m_1pm, view.curvature_20m_1pm]
        for distance_m, curvature in zip(AHEAD_M, ahead, strict=True):
            near = [ROUTE.curvature_at(s_m + distance_m + off_m) for off_m in np.arange(-0.9, 1.0, 0.1)]
            assert min(near) - 1e-9 <= curvature <= max(near) + 1e-9
    assert place[1] == 1.0


def test_backwards_over_the_start_is_the_lap_before() -> None:
    path, seen = path_of(ROUTE), np.zeros(len(LaneView._fields))
    place = place_at(path, 0.0)
    at = ROUTE.at(-3.0)
    lane_view(path, vector_at(at.x_m, at.y_m, at.yaw_rad), place, seen)
    assert place[2] == pytest.approx(-3.0, abs=0.01)


def test_beyond_an_open_path_it_goes_straight_on() -> None:
    route = Route([Stretch(0.0, Pose(0.0, 0.0, 0.0), Piece(50.0, 0.0, 0.0), 10.0)])
    path, seen = path_of(route), np.zeros(len(LaneView._fields))
    place = place_at(path, 49.0)
    lane_view(path, vector_at(53.0, 0.5, 0.0), place, seen)
    assert (place[2], seen[1]) == (pytest.approx(53.0), pytest.approx(0.5))
    lane_view(path, vector_at(-2.0, -0.5, 0.0), place, seen)
    assert (place[2], seen[1]) == (pytest.approx(-2.0), pytest.approx(-0.5))


def test_it_tells_whether_automation_drives() -> None:
    path, seen = path_of(ROUTE), np.zeros(len(LaneView._fields))
    at = ROUTE.at(0.0)
    for mode in Mode:
        driven = lane_view(path, vector_at(at.x_m, at.y_m, at.yaw_rad, mode), place_at(path, 0.0), seen)
        assert driven is (mode == Mode.AUTONOMOUS)
