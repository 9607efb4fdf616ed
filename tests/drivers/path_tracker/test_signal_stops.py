"""Traffic lights obeyed: a car that moves as it is asked to, on a straight road of 50 km/h."""

from collections.abc import Callable

import numpy as np
import pytest

from simconsole.drivers.path_tracker.signal_stops import (
    FIRM_MPS2,
    GAP_M,
    OLD_S,
    OVERTAKEN_S,
    Light,
    SignalStops,
    arrival_s,
    needed_mps2,
)
from simconsole.drivers.path_tracker.speed_control import SpeedControl
from simconsole.drivers.path_tracker.tracker_settings import COMFORT
from simconsole.values.platform import Pose
from simconsole.values.signals import SignalState
from simconsole.world.path_geometry import Piece
from simconsole.world.route import Route, Stretch
from simconsole.world.rules.approaches import StopLine
from tests.samples import Sample

PERIOD_S = 0.02
FRONT_M = 3.4
LIMIT_MPS = 13.89
LINE_M = 300.0
RED, YELLOW, GREEN = (
    SignalState.STOP_AND_REMAIN,
    SignalState.PERMISSIVE_CLEARANCE,
    SignalState.PROTECTED_MOVEMENT_ALLOWED,
)
Program = Callable[[float], tuple[int, int, float]]
"""From time to state, next state and seconds until then."""


def cycle(*phases: tuple[int, float], from_s: float = 0.0) -> Program:
    """A program of (state, duration in s)."""
    whole = sum(duration for _, duration in phases)

    def at(time_s: float) -> tuple[int, int, float]:
        left = (time_s + from_s) % whole
        for place, (state, duration) in enumerate(phases):
            if left < duration:
                return state, phases[(place + 1) % len(phases)][0], duration - left
            left -= duration
        return phases[0][0], phases[1][0], phases[0][1]

    return at


class Drive:
    """One drive over 600 m with a light at 300 m; what is asked for is what is done."""

    def __init__(self, program: Program, start_mps: float = 0.0, start_m: float = 0.0, told_s: float = 1e9) -> None:
        route = Route([Stretch(0.0, Pose(0.0, 0.0, 0.0), Piece(600.0, 0.0, 0.0), LIMIT_MPS)])
        self.control = SpeedControl(route, COMFORT, PERIOD_S)
        stops = SignalStops([StopLine(LINE_M, 0, 2)], ["light"], FRONT_M)
        s_m, speed, self.passed, self.stood_at = start_m, start_mps, -1, []
        self.accel: list[float] = []
        for step in range(12_000):
            now_s = step * PERIOD_S
            state, following, change_s = program(now_s)
            if step % 5 == 0 and now_s <= told_s:
                stops.see({("light", 2): Light(state, following, change_s, now_s)})
            self.control.stop = stops.stop(s_m, speed, self.control.profile, now_s)
            asked = self.control.step(s_m, speed)
            self.accel.append(asked.accel_mps2)
            before = s_m + FRONT_M
            s_m, speed = s_m + PERIOD_S * speed, max(speed + PERIOD_S * asked.accel_mps2, 0.0)
            if before <= LINE_M < s_m + FRONT_M:
                self.passed, self.passed_s = state, now_s
            if speed == 0.0 and self.passed < 0:
                self.stood_at.append(s_m + FRONT_M)
            if s_m > 350.0:
                break

    def check_comfort(self) -> None:
        assert min(self.accel) >= -2.5
        assert float(np.abs(np.diff(self.accel)).max()) / PERIOD_S <= 3.0


def test_stops_before_the_line_at_red_and_goes_on_at_green() -> None:
    drive = Drive(cycle((RED, 60.0), (GREEN, 30.0), (YELLOW, 3.0)), start_mps=13.0)
    assert drive.passed == GREEN
    assert 60.0 < drive.passed_s < 66.0
    assert LINE_M - GAP_M - 0.5 < drive.stood_at[-1] <= LINE_M - GAP_M + 0.3
    drive.check_comfort()


def test_whatever_the_moment_nobody_passes_at_red_and_green_is_used(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    waited = 0
    for _ in range(sample.of(40, 1000)):
        program = cycle(
            (GREEN, rng.uniform(5, 40)), (YELLOW, 3.0), (RED, rng.uniform(5, 60)), from_s=rng.uniform(0, 99)
        )
        drive = Drive(program, start_mps=rng.uniform(0.0, 13.5), start_m=rng.uniform(0.0, 200.0))
        assert drive.passed in (GREEN, YELLOW)
        drive.check_comfort()
        waited += bool(drive.stood_at)
        assert drive.passed_s < 220.0
    assert 0 < waited < sample.of(40, 1000)


@pytest.mark.parametrize(("left_m", "passes"), [(25.0, True), (80.0, False)])
def test_yellow_that_nobody_foretold_stops_whom_it_can(left_m: float, passes: bool) -> None:
    def surprise(time_s: float) -> tuple[int, int, float]:
        if time_s < 1.0:
            return GREEN, GREEN, -1.0
        return (YELLOW, RED, -1.0) if time_s < 4.0 else (RED, RED, -1.0) if time_s < 40.0 else (GREEN, GREEN, -1.0)

    start_m = LINE_M - FRONT_M - left_m - 13.5
    drive = Drive(surprise, start_mps=13.5, start_m=start_m)
    assert drive.passed == (YELLOW if passes else GREEN)
    assert bool(drive.stood_at) != passes
    drive.check_comfort()


def test_light_that_falls_silent_counts_as_red() -> None:
    drive = Drive(cycle((GREEN, 1000.0), (YELLOW, 3.0)), start_mps=10.0, told_s=3.0)
    assert drive.passed == -1
    assert drive.stood_at
    assert OLD_S == 1.0


def test_console_that_tells_of_no_lights_is_driven_as_before() -> None:
    stops = SignalStops([StopLine(LINE_M, 0, 2)], ["light"], FRONT_M)
    control = Drive(cycle((GREEN, 9.0), (YELLOW, 3.0))).control
    assert stops.stop(LINE_M - 20.0, 10.0, control.profile, 0.0) is None


def test_lines_behind_and_far_ahead_ask_for_nothing() -> None:
    stops = SignalStops([StopLine(LINE_M, 0, 2)], ["light"], FRONT_M)
    plan = Drive(cycle((GREEN, 9.0), (YELLOW, 3.0))).control.profile
    stops.see({("light", 2): Light(RED, GREEN, 10.0, 0.0)})
    assert stops.stop(LINE_M - FRONT_M + 0.01, 5.0, plan, 0.0) is None
    assert stops.stop(LINE_M - 200.0, 5.0, plan, 0.0) is None
    found = stops.stop(LINE_M - 60.0, 10.0, plan, 0.0)
    assert found is not None
    assert found.s_m == LINE_M - FRONT_M - GAP_M


def test_times_and_decelerations() -> None:
    plan = Drive(cycle((GREEN, 9.0), (YELLOW, 3.0))).control.profile
    assert arrival_s(plan, 100.0, 200.0, 13.5) == pytest.approx(100.0 / plan.speed_mps[300], rel=0.02)
    assert arrival_s(plan, 200.0, 203.0, 0.0) == pytest.approx((2 * 3.0 / 1.2) ** 0.5)
    assert arrival_s(plan, 200.0, 199.0, 5.0) == 0.0
    assert needed_mps2(0.0, 0.0) == 0.0
    assert needed_mps2(5.0, 13.0) > FIRM_MPS2


def test_what_newer_messages_have_overtaken_tells_nothing_but_that_of_a_new_drive_does() -> None:
    stops = SignalStops([StopLine(LINE_M, 0, 2)], ["light"], FRONT_M)
    for state, stamp_s in ((RED, 10.0), (GREEN, 9.9)):
        stops.see({("light", 2): Light(state, YELLOW, 5.0, stamp_s)})
    assert stops.state(0, 2) == RED
    stops.see({("light", 2): Light(GREEN, YELLOW, 5.0, 10.0 - OVERTAKEN_S - 0.1)})
    assert stops.state(0, 2) == GREEN
