"""The autopilot follows speed advice: a car that moves as it is asked to, towards a light at 300 m."""

import math

import numpy as np

from simconsole.drivers.autopilot.advised import Advised
from simconsole.drivers.path_tracker.signal_stops import GAP_M, Light, SignalStops
from simconsole.drivers.path_tracker.speed_control import SpeedControl
from simconsole.drivers.path_tracker.tracker_settings import COMFORT
from simconsole.values.platform import Pose
from simconsole.values.signals import SignalState
from simconsole.world.path_geometry import Piece
from simconsole.world.route import Route, Stretch
from simconsole.world.rules.approaches import StopLine
from simconsole.world.rules.speed_advice import LEAST_MPS, NO_ADVICE, rolling_mps
from simconsole.world.rules.speed_advice import Advised as Kind
from simconsole.world.rules.timetable import greens
from tests.samples import Sample

PERIOD_S = 0.02
FRONT_M, LINE_M, LIMIT_MPS = 3.4, 400.0, 13.89
RED, YELLOW, GREEN = (
    SignalState.STOP_AND_REMAIN,
    SignalState.PERMISSIVE_CLEARANCE,
    SignalState.PROTECTED_MOVEMENT_ALLOWED,
)
ROUTE = Route([Stretch(0.0, Pose(0.0, 0.0, 0.0), Piece(700.0, 0.0, 0.0), LIMIT_MPS)])


class Program:
    """Red, green, yellow, again and again."""

    def __init__(self, red_s: float, green_s: float, offset_s: float) -> None:
        self._phases = ((RED, red_s), (GREEN, green_s), (YELLOW, 3.0))
        self._offset_s = offset_s

    def told(self, now_s: float) -> Light:
        """What a message says."""
        at = (now_s + self._offset_s) % sum(length for _, length in self._phases)
        place = 0
        while at >= self._phases[place][1]:
            at, place = at - self._phases[place][1], place + 1
        later = [self._phases[(place + step) % 3] for step in (1, 2, 3)]
        left_s = self._phases[place][1] - at
        state = self._phases[place][0]
        return Light(state, later[0][0], left_s, now_s, tuple(greens(state, left_s, later)))


def driven(program: Program, advised: bool) -> tuple[int, float, float, float]:
    """Return what was shown at the line, how long the car stood, when it was 100 m beyond, and its hardest braking."""
    control = SpeedControl(ROUTE, COMFORT, PERIOD_S)
    stops = SignalStops([StopLine(LINE_M, 0, 2)], ["light"], FRONT_M)
    follower = Advised() if advised else None
    s_m, speed, passed, stood_s, hardest = 0.0, LIMIT_MPS - 1.0, -1, 0.0, 0.0
    for step in range(20_000):
        now_s = step * PERIOD_S
        light = program.told(now_s)
        if step % 5 == 0:
            stops.see({("light", 2): light})
        control.stop = stops.stop(s_m, speed, control.profile, now_s)
        if follower is not None:
            control.advised_mps = follower.target_mps(stops.approach(s_m), s_m, speed, control.profile, now_s)
        asked = control.step(s_m, speed)
        hardest = min(hardest, asked.accel_mps2)
        before = s_m + FRONT_M
        s_m, speed = s_m + PERIOD_S * speed, max(speed + PERIOD_S * asked.accel_mps2, 0.0)
        stood_s += PERIOD_S * (speed < 0.1)
        if before <= LINE_M < s_m + FRONT_M:
            passed = light.state
        if s_m > LINE_M + 100.0:
            return passed, stood_s, now_s, hardest
    raise AssertionError("never through")


def test_lights_are_passed_at_green_with_fewer_stops_and_no_later(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    programs = [
        Program(rng.uniform(15.0, 40.0), rng.uniform(10.0, 30.0), rng.uniform(0.0, 80.0))
        for _ in range(sample.of(25, 300))
    ]
    advised = np.array([driven(program, advised=True) for program in programs])
    plain = np.array([driven(program, advised=False) for program in programs])
    assert not (advised[:, 0] == RED).any()
    assert not (plain[:, 0] == RED).any()
    assert (advised[:, 1] > 0.0).sum() < (plain[:, 1] > 0.0).sum()
    assert advised[:, 1].mean() < plain[:, 1].mean()
    assert advised[:, 2].mean() < plain[:, 2].mean() + 0.5
    assert advised[:, 3].min() > -2.6
    print(
        f"{len(programs)} lights: stood at {(advised[:, 1] > 0.0).sum()} against {(plain[:, 1] > 0.0).sum()},"
        f" {advised[:, 1].mean():.1f} against {plain[:, 1].mean():.1f} s, through after {advised[:, 2].mean():.1f}"
        f" against {plain[:, 2].mean():.1f} s"
    )


def test_towards_a_stop_it_rolls_and_need_not_stand_where_green_comes() -> None:
    """Who rolls at the least speed from where advice begins is there after 59 s: a second before green."""
    passed, stood_s, _, hardest = driven(Program(60.0, 30.0, 0.0), advised=True)
    assert passed == GREEN
    assert stood_s == 0.0
    assert hardest > -1.5
    control, follower = SpeedControl(ROUTE, COMFORT, PERIOD_S), Advised()
    stops = SignalStops([StopLine(LINE_M, 0, 2)], ["light"], FRONT_M)
    stops.see({("light", 2): Light(RED, GREEN, 90.0, 0.0, ((90.0, 120.0),))})
    far, near = (
        follower.target_mps(stops.approach(s_m), s_m, LEAST_MPS, control.profile, 0.0)
        for s_m in (LINE_M - 100.0, LINE_M - FRONT_M - 3.0)
    )
    assert follower.advice.kind is Kind.STOP
    assert far == LEAST_MPS
    assert near == rolling_mps(3.0 - GAP_M)


def test_nothing_is_advised_where_no_light_is_ahead_or_nothing_was_told() -> None:
    control = SpeedControl(ROUTE, COMFORT, PERIOD_S)
    stops = SignalStops([StopLine(LINE_M, 0, 2)], ["light"], FRONT_M)
    follower = Advised()
    assert follower.target_mps(stops.approach(0.0), 200.0, 10.0, control.profile, 0.0) is None
    assert stops.approach(LINE_M) is None
    assert follower.target_mps(None, LINE_M, 10.0, control.profile, 0.0) is None
    stops.see({("light", 2): Light(GREEN, GREEN, -1.0, 0.0, ((0.0, math.inf),))})
    free = follower.target_mps(stops.approach(200.0), 200.0, 10.0, control.profile, 0.0)
    assert free is not None
    assert free > 0.9 * (LIMIT_MPS - COMFORT.margin_mps)
    bend = control.profile._replace(speed_mps=np.where(np.arange(len(control.profile.speed_mps)) == 600, 3.0, 10.0))
    assert follower.target_mps(stops.approach(200.0), 200.0, 10.0, bend, 0.0) is None, "nobody creeps to a bend"
    assert follower.advice == NO_ADVICE
