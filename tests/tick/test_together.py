"""Platforms that drive together: none is a period ahead of another, and each is told where the others were."""

import math
from collections.abc import Iterator

import numpy as np
import pytest

from simconsole.tick.advance import ConsoleState
from simconsole.tick.together import Body, Whereabouts, run_together
from simconsole.values.kernels import Row
from simconsole.values.layout import write
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot


def state(tick: int, x_m: float, yaw_rad: float = 0.0) -> ConsoleState:
    vector: Row = np.zeros(PLATFORM_AT)
    vehicle = Snapshot(tick, 100, vector).vehicle._replace(x_m=x_m, y_m=1.0, yaw_rad=yaw_rad)
    write(vector, LAYOUT.vehicle, vehicle)
    return ConsoleState(tick, vector)


class Track:
    """What happened, in its order."""

    def __init__(self) -> None:
        self.ticks: list[tuple[int, int]] = []
        self.told: list[tuple[float, ...]] = []


def drive(track: Track, number: int, at_once: int, ticks: int, whereabouts: Whereabouts) -> Iterator[ConsoleState]:
    """Drives 1 m a tick, `at_once` ticks at a time."""
    others = whereabouts.seen_by(number)
    for tick in range(at_once, ticks + 1, at_once):
        track.told.append(others())
        track.ticks.append((number, tick))
        yield state(tick, float(tick))


def together(track: Track, at_once: tuple[int, int], ticks: tuple[int, int], most: int = 1000) -> list[int]:
    begin = [state(0, 0.0), state(0, 0.0)]
    whereabouts = Whereabouts([Body(0.0, 0.0, 0.1), Body(0.0, 0.0, 0.2)], begin)
    drives = [drive(track, number, at_once[number], ticks[number], whereabouts) for number in (0, 1)]
    states = run_together(drives, begin, whereabouts.renew, 4, lambda now: now[0].tick >= most)
    return [one.tick for one in states]


def test_all_make_a_period_before_any_goes_on() -> None:
    track = Track()
    assert together(track, (4, 2), (12, 12)) == [12, 12]
    assert track.ticks == [(0, 4), (1, 2), (1, 4), (0, 8), (1, 6), (1, 8), (0, 12), (1, 10), (1, 12)]


def test_each_is_told_where_the_others_were_at_the_end_of_the_period_before() -> None:
    track = Track()
    together(track, (2, 4), (8, 8))
    assert track.told == [
        (0.0, 1.0, 0.2),
        (0.0, 1.0, 0.2),
        (0.0, 1.0, 0.1),
        (4.0, 1.0, 0.2),
        (4.0, 1.0, 0.2),
        (4.0, 1.0, 0.1),
    ]


def test_they_end_at_one_tick() -> None:
    assert together(Track(), (1, 1), (100, 100), most=8) == [8, 8]


def test_the_end_of_one_is_the_end_of_all() -> None:
    assert together(Track(), (4, 4), (100, 8)) == [12, 8]


def test_the_middle_of_a_body_is_where_its_robot_looks_from_base_link() -> None:
    bodies = [Body(0.5, 0.5, 0.1), Body(0.0, 0.0, 0.2)]
    whereabouts = Whereabouts(bodies, [state(0, 2.0, math.pi / 2), state(0, 0.0)])
    assert whereabouts.seen_by(1)() == pytest.approx((2.0, 1.5, 0.1))


@pytest.mark.parametrize(("at_x_m", "told_x_m"), [(-9.0, 0.0), (1.2, 1.2), (9.0, 3.0)])
def test_of_a_long_body_the_circle_next_to_who_is_told(at_x_m: float, told_x_m: float) -> None:
    whereabouts = Whereabouts([Body(0.0, 3.0, 0.9), Body(0.0, 0.0, 0.2)], [state(0, 0.0), state(0, at_x_m)])
    assert whereabouts.seen_by(1)() == pytest.approx((told_x_m, 1.0, 0.9))
