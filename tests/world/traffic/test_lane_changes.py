import numpy as np
import pytest

from simconsole.world import traffic_columns as at
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.traffic.following import FAR_M, acceleration
from simconsole.world.traffic.lane_changes import consider, rested
from simconsole.world.traffic.network import Network, network
from tests.world.nets import generated_map
from tests.world.traffic.made import path_on, vehicle_on

LONG = ("--grid", "--grid.number", "2", "--grid.length", "400", "--default.lanenumber", "2")


def beside_each_other(road_map: RoadMap, net: Network) -> int:
    """A right lane of a long road with a lane on its left."""
    return next(lane for lane in range(len(road_map.lanes)) if net.left[lane] >= 0 and net.lengths_m[lane] > 300.0)


def considered(*others: tuple[bool, float, float], speed_mps: float = 12.0, s_m: float = 150.0) -> bool:
    """Whether a vehicle on the right lane moves over, with others (on the left lane?, s, speed) around it."""
    road_map = generated_map(*LONG)
    net = network(road_map)
    right = beside_each_other(road_map, net)
    left = int(net.left[right])
    paths = np.array([path_on(right), *(path_on(left if over else right) for over, _, _ in others)])
    placed = [(s_m, speed_mps), *((s, speed) for _, s, speed in others)]
    values = np.array([vehicle_on(net, path, *place) for path, place in zip(paths, placed, strict=True)])
    free = acceleration(speed_mps, float(net.limits_mps[right]), FAR_M, 0.0, 1.2)
    values[0, at.ACCELERATION] = -1.0 if others and not others[0][0] else free
    boxes = values[:, : at.BOX].copy()
    consider(net, paths, boxes, values, 0)
    moved = bool(paths[0, at.LANES] == left)
    if moved:
        width = 0.5 * float(net.widths_m[left] + net.widths_m[right])
        assert values[0, at.OFFSET] == pytest.approx(-width)
        assert values[0, at.CHANGED] == 0.0
        assert not rested(values[0])
    return moved


def test_behind_a_slow_leader_the_free_lane_is_worth_a_change() -> None:
    assert considered((False, 170.0, 4.0))


def test_on_a_free_road_nobody_changes() -> None:
    assert not considered()


def test_nobody_cuts_in_before_a_fast_follower_nor_beside_anybody() -> None:
    assert not considered((False, 170.0, 4.0), (True, 140.0, 16.0))
    assert not considered((False, 170.0, 4.0), (True, 151.0, 12.0))
    assert considered((False, 170.0, 4.0), (True, 60.0, 12.0))


def test_another_slow_leader_is_no_reason() -> None:
    assert not considered((False, 170.0, 4.0), (True, 168.0, 4.0))


@pytest.mark.parametrize("s_m", [10.0, 370.0])
def test_nobody_changes_near_a_junction(s_m: float) -> None:
    assert not considered((False, s_m + 20.0, 4.0), s_m=s_m)


def test_next_change_comes_after_a_rest() -> None:
    values = np.zeros(at.VALUES)
    values[at.CHANGED], values[at.SINCE_CHANGE] = 1.0, 3.0
    assert not rested(values)
    values[at.SINCE_CHANGE] = 7.0
    assert rested(values)
