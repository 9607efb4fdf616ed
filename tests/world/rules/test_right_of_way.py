"""Whom a vehicle lets pass: people on the crossing until they are past its lane, and who comes on the ring."""

import math

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.values.signals import FAR, SignalState
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.lane_graph import Leg
from simconsole.world.roads.road_map import Array
from simconsole.world.roads.road_route import route_over
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.conflicts import Duties, Entry, Foot, duties
from simconsole.world.rules.right_of_way import NOTHING_OWED, Motion, RightOfWay
from simconsole.world.traffic.road_users import NOBODY, RoadUser, table


def urban() -> Duties:
    world = open_world(load_world("urban_signals"))
    roads = roads_of(world)
    assert roads is not None
    return duties(roads.road_map, roads.legs, world.route)


def dark(signal: int, link: int) -> int:
    return SignalState.UNAVAILABLE


def crossing() -> Foot:
    return next(foot for foot in urban().crossings if foot.crossing.signal < 0)


def ring() -> Entry:
    return next(one for one in urban().entries if one.critical_s == pytest.approx(5.19))


def somebody(foot: Foot, along_m: float, speed_mps: float = 1.3, forth: bool = True) -> Array:
    """A person `along_m` along a crossing, who walks its way or back."""
    (x, y), (to_x, to_y) = foot.crossing.line[[0, -1]].tolist()
    yaw = math.atan2(to_y - y, to_x - x)
    person = RoadUser(
        id=7.0,
        kind=3.0,
        x_m=x + along_m * math.cos(yaw),
        y_m=y + along_m * math.sin(yaw),
        yaw_rad=yaw if forth else yaw + math.pi,
        speed_mps=speed_mps,
        length_m=0.5,
        width_m=0.5,
        height_m=1.75,
    )
    return table([person])


def on_ring(entry: Entry, to_m: float, speed_mps: float) -> Array:
    """A car on the ring whose middle is `to_m` before it meets the route."""
    way = entry.watched
    place = int(np.argmin(np.where((way.first > 0.0) & (way.inside == 0.0), np.abs(way.to_m - to_m), FAR)))
    x, y = float(way.x_m[place]), float(way.y_m[place])
    yaw = math.atan2(float(way.sine[place]), float(way.cosine[place]))
    car = RoadUser(
        id=9.0,
        kind=1.0,
        x_m=x,
        y_m=y,
        yaw_rad=yaw,
        speed_mps=speed_mps,
        length_m=4.0,
        width_m=1.8,
        height_m=1.5,
    )
    return table([car])


def before(line_m: float, left_m: float, speed_mps: float = 5.0, time_s: float = 0.0) -> Motion:
    return Motion(line_m - left_m, speed_mps, time_s)


def test_who_is_on_the_crossing_is_let_pass_until_beyond_the_lane() -> None:
    foot = crossing()
    for along_m, forth, owes in (
        (-1.0, True, False),  # waits at the kerb
        (-0.5, True, True),
        (0.5, True, True),
        (foot.high_m + 0.6, True, False),
        (foot.crossing.length_m + 0.5, False, True),  # comes from the other side
        (foot.high_m - 0.5, False, True),
        (foot.low_m - 1.0, False, False),
    ):
        speed = 0.0 if along_m == -1.0 else 1.3
        owed = RightOfWay(urban()).owed(before(foot.line_m, 30.0), somebody(foot, along_m, speed, forth), dark)
        assert owed == (pytest.approx((30.0, 0.0)) if owes else NOTHING_OWED), (along_m, forth)


@pytest.mark.parametrize(
    ("along_m", "speed_mps", "shown", "owes"),
    [
        (-0.1, 0.0, SignalState.STOP_AND_REMAIN, False),  # where SUMO's people wait
        (-0.1, 0.0, SignalState.PERMISSIVE_CLEARANCE, False),
        (-0.1, 0.0, SignalState.PROTECTED_MOVEMENT_ALLOWED, True),
        (-0.1, 0.0, SignalState.UNAVAILABLE, True),
        (-0.1, 1.3, SignalState.STOP_AND_REMAIN, True),
        (1.0, 0.0, SignalState.STOP_AND_REMAIN, True),
    ],
)
def test_who_stands_at_the_edge_of_a_crossing_whose_light_says_so_waits(
    along_m: float, speed_mps: float, shown: SignalState, owes: bool
) -> None:
    foot = next(foot for foot in urban().crossings if foot.crossing.signal >= 0)
    crossing_s_own = (foot.crossing.signal, foot.crossing.link)

    def light(signal: int, link: int) -> int:
        return shown if (signal, link) == crossing_s_own else SignalState.UNAVAILABLE

    owed = RightOfWay(urban()).owed(before(foot.line_m, 20.0), somebody(foot, along_m, speed_mps), light)
    assert owed == (pytest.approx((20.0, 0.0)) if owes else NOTHING_OWED)


def test_far_crossings_are_nobody_s_business_yet() -> None:
    foot = crossing()
    assert RightOfWay(urban()).owed(before(foot.line_m, 120.0), somebody(foot, 1.0), dark) == NOTHING_OWED


def test_duty_that_comes_too_late_hinders_nobody_but_is_told() -> None:
    foot = crossing()
    owed = RightOfWay(urban()).owed(before(foot.line_m, 5.0, 13.0), somebody(foot, 0.5), dark)
    assert owed == pytest.approx((5.0, FAR))


def test_passed_line_is_told_for_a_moment() -> None:
    foot, right_of_way = crossing(), RightOfWay(urban())
    for left_m in (20.0, 0.2):
        owed = right_of_way.owed(before(foot.line_m, left_m), somebody(foot, 0.5), dark)
        assert owed == pytest.approx((left_m, 0.0))
    assert right_of_way.owed(before(foot.line_m, -0.2), somebody(foot, 0.6), dark) == pytest.approx((-0.2, 0.0))
    fresh = RightOfWay(urban())
    assert fresh.owed(before(foot.line_m, -0.2), somebody(foot, 0.6), dark) == NOTHING_OWED


@pytest.mark.parametrize(
    ("to_m", "speed_mps", "owes"),
    [(20.0, 8.0, True), (60.0, 8.0, False), (20.0, 2.0, False)],
)
def test_ring_goes_first_within_the_critical_headway(to_m: float, speed_mps: float, owes: bool) -> None:
    entry = ring()
    owed = RightOfWay(urban()).owed(before(entry.line_m, 1.0, 0.0), on_ring(entry, to_m, speed_mps), dark)
    assert (owed.yield_m < FAR) == owes
    if owes:
        assert owed.yield_s == pytest.approx((to_m - 2.0) / speed_mps, abs=0.2)


def test_who_indicates_to_leave_the_ring_is_not_waited_for() -> None:
    entry = ring()
    goes_on, leaves = on_ring(entry, 20.0, 8.0), on_ring(entry, 20.0, 8.0)
    leaves[:, 10] = -1.0
    there = before(entry.line_m, 1.0, 0.0)
    assert RightOfWay(urban()).owed(there, goes_on, dark) != NOTHING_OWED
    assert RightOfWay(urban()).owed(there, leaves, dark) == NOTHING_OWED


def test_who_has_stood_for_a_while_lets_others_go() -> None:
    entry, right_of_way = ring(), RightOfWay(urban())
    waiting = on_ring(entry, 20.0, 0.0)
    assert right_of_way.owed(before(entry.line_m, 15.0, 0.0, 0.0), waiting, dark).yield_m == pytest.approx(15.0)
    assert right_of_way.owed(before(entry.line_m, 15.0, 0.0, 3.0), waiting, dark) == NOTHING_OWED


def test_who_stands_inside_a_junction_with_lights_to_turn_left_waits_for_oncoming_traffic() -> None:
    entry = next(one for one in urban().entries if one.connection.signal >= 0)
    way = entry.watched
    inside = int(np.argmin(np.where((way.inside > 0.0) & (way.first > 0.0), np.abs(way.to_m - 5.0), FAR)))
    car = on_ring(ring(), 20.0, 0.0)
    car[0, 2:5] = way.x_m[inside], way.y_m[inside], math.atan2(float(way.sine[inside]), float(way.cosine[inside]))

    def owed_after(time_s: float, indicates: float) -> bool:
        car[0, 10] = indicates
        right_of_way = RightOfWay(urban())
        right_of_way.owed(before(entry.line_m, 15.0, 0.0, 0.0), car, dark)
        return right_of_way.owed(before(entry.line_m, 1.0, 0.0, time_s), car, dark) != NOTHING_OWED

    assert owed_after(1.0, 1.0), "it may be about to go"
    assert owed_after(3.0, 0.0), "it goes straight on, and is let out"
    assert not owed_after(3.0, 1.0)


def left_at_lights() -> tuple[Duties, Entry, Entry]:
    """The duties of a left turn at lights: at the junction's line, and inside it."""
    roads = roads_of(open_world(load_world("urban_signals")))
    assert roads is not None
    turn = next(one for one in roads.road_map.connections if one.signal >= 0 and one.direction == "l")
    legs = [Leg((turn.from_lane,), turn), Leg((turn.to_lane,), None)]
    found = duties(roads.road_map, legs, route_over(roads.road_map, legs))
    at_line, inside = found.entries
    return found, at_line, inside


def oncoming(inside: Entry, to_m: float, speed_mps: float) -> Array:
    """A car that comes from the other side of the junction."""
    way, car = inside.watched, on_ring(ring(), 20.0, speed_mps)
    place = int(np.argmin(np.abs(way.to_m - to_m)))
    car[0, 2:5] = way.x_m[place], way.y_m[place], math.atan2(float(way.sine[place]), float(way.cosine[place]))
    return car


def test_who_has_passed_the_line_to_turn_left_waits_inside_for_who_comes_then() -> None:
    found, at_line, inside = left_at_lights()
    car = oncoming(inside, 55.0, 14.0)
    right_of_way = RightOfWay(found)
    beyond = before(at_line.line_m, -0.5, 2.0)
    assert right_of_way.owed(before(at_line.line_m, 0.3, 1.5), NOBODY, dark) == NOTHING_OWED
    owed = right_of_way.owed(beyond, car, dark)
    assert owed.yield_m == pytest.approx(inside.line_m - beyond.front_m)
    late = RightOfWay(found)
    late.owed(before(at_line.line_m, 0.3, 1.5), car, dark)  # too late to stop before the line
    assert late.owed(beyond, car, dark).yield_m == pytest.approx(inside.line_m - beyond.front_m)
    assert RightOfWay(found).owed(before(inside.line_m, 0.5, 2.0), NOBODY, dark) == NOTHING_OWED


def test_who_waits_inside_goes_when_oncoming_vehicles_have_to_stop() -> None:
    found, _, inside = left_at_lights()
    waits = before(inside.line_m, 1.0, 0.0)

    def owes(state: SignalState, to_m: float, speed_mps: float) -> bool:
        owed = RightOfWay(found).owed(waits, oncoming(inside, to_m, speed_mps), lambda signal, link: state)
        return owed.yield_m < FAR

    assert owes(SignalState.PERMISSIVE_MOVEMENT_ALLOWED, 45.0, 12.0)
    assert not owes(SignalState.STOP_AND_REMAIN, 45.0, 12.0)
    assert not owes(SignalState.PERMISSIVE_CLEARANCE, 45.0, 12.0), "it can stop"
    assert owes(SignalState.PERMISSIVE_CLEARANCE, 25.0, 12.0), "it cannot, and goes on"


def test_duty_lasts_a_moment_after_it_was_seen() -> None:
    foot, right_of_way = crossing(), RightOfWay(urban())
    assert right_of_way.owed(before(foot.line_m, 20.0), somebody(foot, 0.5), dark).yield_m < FAR
    assert right_of_way.owed(before(foot.line_m, 19.0, 5.0, 0.2), NOBODY, dark).yield_m < FAR
    assert right_of_way.owed(before(foot.line_m, 18.0, 5.0, 0.7), NOBODY, dark) == NOTHING_OWED


def test_red_light_is_no_duty_to_yield() -> None:
    entry = next(one for one in urban().entries if one.connection.signal >= 0)

    def red(signal: int, link: int) -> int:
        return SignalState.STOP_AND_REMAIN

    inside = int(np.flatnonzero(entry.watched.inside > 0.0)[0])
    way = entry.watched
    car = on_ring(ring(), 20.0, 3.0)
    car[0, 2:5] = way.x_m[inside], way.y_m[inside], math.atan2(float(way.sine[inside]), float(way.cosine[inside]))
    assert RightOfWay(urban()).owed(before(entry.line_m, 1.0, 0.0), car, dark).yield_m < FAR
    assert RightOfWay(urban()).owed(before(entry.line_m, 1.0, 0.0), car, red) == NOTHING_OWED


def test_who_stands_before_the_lane_of_a_vehicle_at_the_crossing_lets_it_go() -> None:
    """They wait for it, as our own people do; else both would wait for ever. Who walks, or is in the lane, does not."""
    foot = crossing()
    before_lane, in_lane = foot.low_m - 0.3, 0.5 * (foot.low_m + foot.high_m)

    def is_owed(along_m: float, speed_mps: float, left_m: float) -> bool:
        watch = RightOfWay(urban())
        watch.owed(before(foot.line_m, 20.0), somebody(foot, along_m, 1.0), dark)
        own = before(foot.line_m, left_m, 0.0, time_s=1.0)
        return watch.owed(own, somebody(foot, along_m, speed_mps), dark).yield_m < FAR

    assert not is_owed(before_lane, 0.0, -0.5)
    assert is_owed(before_lane, 0.0, 1.0)
    assert is_owed(before_lane, 1.0, -0.5)
    assert is_owed(in_lane, 0.0, -0.5)
