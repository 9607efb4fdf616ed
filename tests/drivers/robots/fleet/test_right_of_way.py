import math

from simconsole.drivers.robots.fleet.right_of_way import APART_M, NEAR_M, TURN_S, Place, RightOfWay
from simconsole.values.platform import Pose


def at(x_m: float, is_under_way: bool = True) -> Place:
    return Place(Pose(x_m, 0.0, 0.0), is_under_way)


def test_apart_both_drive() -> None:
    way = RightOfWay()
    places = [at(0.0), at(NEAR_M + 0.01)]
    assert not way.yields(0, 0.0, places)
    assert not way.yields(1, 0.0, places)


def test_near_each_other_one_of_them_stands_and_after_a_while_the_other_one() -> None:
    way, places = RightOfWay(), [at(0.0), at(0.4)]
    for time_s in (0.0, 0.5 * TURN_S, TURN_S + 0.1, 1.9 * TURN_S, 2.0 * TURN_S + 0.1):
        stands = [way.yields(number, time_s, places) for number in (0, 1)]
        assert sorted(stands) == [False, True]
        assert stands[1] == (int(time_s / TURN_S) % 2 == 0)


def test_a_robot_without_a_goal_is_no_reason_to_stand() -> None:
    way = RightOfWay()
    assert not way.yields(1, 0.0, [at(0.0, False), at(0.4)])


def test_they_are_near_until_they_are_well_apart() -> None:
    way = RightOfWay()
    assert way.yields(1, 0.0, [at(0.0), at(0.5)])
    between = 0.5 * (NEAR_M + APART_M)
    assert way.yields(1, 1.0, [at(0.0), at(between)])
    assert not way.yields(1, 2.0, [at(0.0), at(APART_M + 0.01)])
    assert not way.yields(1, 3.0, [at(0.0), at(between)])


def test_of_three_never_two_that_are_near_each_other_drive() -> None:
    way = RightOfWay()
    places = [Place(Pose(0.3 * math.cos(angle), 0.3 * math.sin(angle), 0.0), True) for angle in (0.0, 2.1, 4.2)]
    for step in range(200):
        drives = [number for number in range(3) if not way.yields(number, 0.1 * step, places)]
        assert len(drives) <= 1


def test_who_is_not_known_yet_is_waited_for_by_nobody() -> None:
    way = RightOfWay()
    assert not way.yields(0, 0.0, [at(0.0), None])
    assert not way.yields(1, 0.0, [at(0.0), None])
