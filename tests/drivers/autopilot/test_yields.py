"""Where the autopilot stops for others, from what it was told."""

import numpy as np
import pytest

from simconsole.drivers.autopilot.others import OLD_S
from simconsole.drivers.autopilot.yields import HARDEST_MPS2, Yields, yields
from simconsole.drivers.path_tracker.signal_stops import GAP_M, GENTLE_MPS2
from simconsole.drivers.path_tracker.speed_control import SpeedControl
from simconsole.drivers.path_tracker.tracker_settings import COMFORT
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.files.world_files import load_world
from simconsole.world.kinds.worlds import open_world
from simconsole.world.traffic.road_users import NOBODY
from tests.world.rules.test_right_of_way import crossing, somebody, urban

FRONT_M, PERIOD_S = 3.0, 0.02


def test_stop_lies_before_the_crossing_while_somebody_is_on_it() -> None:
    foot, others = crossing(), Yields(urban(), FRONT_M, None)
    s_m = foot.line_m - FRONT_M - 60.0
    others.see(somebody(foot, 0.5), 10.0)
    stop = others.stop(s_m, 10.0, 10.05)
    assert stop == (pytest.approx(foot.line_m - FRONT_M - GAP_M), GENTLE_MPS2)
    assert others.stop(s_m + 0.2, 10.0, 10.07) == stop, "it is kept until the next message"
    others.see(NOBODY, 10.1)
    assert others.stop(s_m + 1.0, 10.0, 10.15) is not None
    others.see(NOBODY, 10.7)
    assert others.stop(s_m + 6.0, 10.0, 10.75) is None


def test_who_steps_out_late_is_braked_for_hard() -> None:
    foot, others = crossing(), Yields(urban(), FRONT_M, None)
    others.see(somebody(foot, 0.5), 10.0)
    stop = others.stop(foot.line_m - FRONT_M - 12.0, 10.0, 10.0)
    assert stop is not None
    assert stop.brake_mps2 == HARDEST_MPS2


def test_old_messages_stop_nobody() -> None:
    foot, others = crossing(), Yields(urban(), FRONT_M, None)
    others.see(somebody(foot, 0.5), 10.0)
    assert others.stop(foot.line_m - 60.0, 8.0, 10.0 + 2.0 * OLD_S) is None


def test_course_has_nobody_to_yield_to() -> None:
    assert yields(open_world(load_world("urban")), load_vehicle("hatchback"), None) is None
    assert yields(open_world(load_world("urban_signals")), load_vehicle("hatchback"), None) is not None


@pytest.mark.parametrize(("beyond_m", "stops"), [(0.5 * GAP_M, True), (1.5 * GAP_M, False)])
def test_a_front_that_comes_a_little_beyond_the_line_stops_and_one_that_is_through_goes_on(
    beyond_m: float, stops: bool
) -> None:
    foot, others = crossing(), Yields(urban(), FRONT_M, None)
    others.see(somebody(foot, 0.5), 10.0)
    assert others.stop(foot.line_m - FRONT_M - 4.0, 4.0, 10.0) is not None
    others.see(somebody(foot, 0.7), 10.1)
    assert (others.stop(foot.line_m - FRONT_M + beyond_m, 1.0, 10.1) is not None) == stops


@pytest.mark.parametrize(
    ("told_m", "speed_mps", "hardest_mps2"), [(60.0, 8.0, 2.0), (16.0, 8.0, 3.2), (12.0, 8.0, 3.6), (8.0, 5.0, 3.0)]
)
def test_the_brake_is_never_released_on_the_way_to_a_stop_and_no_harder_than_it_takes(
    told_m: float, speed_mps: float, hardest_mps2: float
) -> None:
    """Somebody is seen on the crossing when the car's front is `told_m` before the line."""
    foot, others = crossing(), Yields(urban(), FRONT_M, None)
    control = SpeedControl(open_world(load_world("urban_signals")).route, COMFORT, PERIOD_S)
    s_m, time_s, asked = foot.line_m - FRONT_M - told_m, 10.0, [0.0]
    while speed_mps > 0.05:
        others.see(somebody(foot, 0.5), time_s)
        control.stop = others.stop(s_m, speed_mps, time_s)
        asked.append(control.step(s_m, speed_mps).accel_mps2)
        speed_mps += asked[-1] * PERIOD_S
        s_m, time_s = s_m + speed_mps * PERIOD_S, time_s + PERIOD_S
    assert 0.0 < foot.line_m - FRONT_M - s_m < 2.0 * GAP_M
    hardest = int(np.argmin(asked))
    assert -hardest_mps2 <= asked[hardest]
    assert (np.diff(asked[: hardest + 1]) < 0.05).all()
