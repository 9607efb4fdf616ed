"""Speed advice: arithmetic against the analytic window of green, and approaches that follow it."""

import math
from itertools import accumulate, pairwise
from typing import NamedTuple

import msgspec
import numpy as np
import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.cdr import deserialize, serialize
from simconsole.drivers.autopilot.lights import SIGNALS_TYPE, lights_of
from simconsole.world.rules.speed_advice import (
    DOWN_MPS2,
    HOLD_S,
    LEAST_MPS,
    NO_ADVICE,
    STOP,
    UP_MPS2,
    Advice,
    Advised,
    Greens,
    SpeedAdvisor,
    arrival_s,
    band_of,
    rolling_mps,
)
from tests.samples import Measured, Sample

LIMIT_MPS = 50.0 / 3.6
SHORT, FULL = 25, 1000
PERIOD_S, MESSAGES_S = 0.02, 0.1
SCANNED = 60
SETTLED_S, BESIDE_MPS = 0.5, 0.3


def test_band_is_that_of_the_analytic_window() -> None:
    """At 10 m/s, without reaction: 200 m in 20 to 25 s are 10 and 8 m/s, but for the time to slow down."""
    low, high = band_of(200.0, 10.0, LIMIT_MPS, (20.0, 25.0), reaction_s=0.0, spare_s=0.0) or (0.0, 0.0)
    assert high == pytest.approx(10.0, abs=1e-4)
    assert arrival_s(200.0, 10.0, low, 0.0) == pytest.approx(25.0, abs=1e-4)
    slowing_s = (10.0 - low) / DOWN_MPS2
    assert low * (25.0 - slowing_s) + 0.5 * (10.0 + low) * slowing_s == pytest.approx(200.0, abs=1e-3)


@pytest.mark.parametrize("reaction_s", [0.0, 1.0])
@pytest.mark.parametrize(("left_m", "from_mps", "to_mps"), [(200, 5, 12), (200, 12, 5), (20, 5, 13), (30, 13, 7)])
def test_arrival_is_that_of_a_vehicle_that_does_so(
    left_m: float, from_mps: float, to_mps: float, reaction_s: float
) -> None:
    step_s, speed, at_m, at_s = 1e-4, from_mps, 0.0, 0.0
    while at_m < left_m:
        if at_s >= reaction_s:
            speed += max(-DOWN_MPS2 * step_s, min(UP_MPS2 * step_s, to_mps - speed))
        at_m, at_s = at_m + speed * step_s, at_s + step_s
    assert arrival_s(left_m, from_mps, to_mps, reaction_s) == pytest.approx(at_s, abs=0.01)


def test_nothing_legal_is_prepare_to_stop() -> None:
    advisor = SpeedAdvisor()
    assert advisor.advise(100.0, 12.0, LIMIT_MPS, Greens(((100.0 / LEAST_MPS + 20.0, 90.0),), 0.0), 0.0) == STOP
    assert advisor.advise(100.0, 12.0, LIMIT_MPS, Greens(((0.0, 5.0),), 0.0), 0.1) == STOP
    found = advisor.advise(100.0, 12.0, LIMIT_MPS, Greens(((0.0, 5.0), (10.0, 40.0)), 0.2), 0.2)
    assert found.kind is Advised.SPEED, "the green after that which ends too soon"
    assert LEAST_MPS <= found.low_mps <= found.target_mps <= found.high_mps <= LIMIT_MPS


def test_who_prepares_to_stop_rolls_and_brakes_gently_all_the_way() -> None:
    assert rolling_mps(200.0) == LEAST_MPS
    assert rolling_mps(0.0) == rolling_mps(-1.0) == 0.0
    speed, left, now_s = LEAST_MPS, 20.0, 0.0
    while speed > 0.5:
        after = rolling_mps(left)
        assert speed - after <= 1.1 * DOWN_MPS2 * PERIOD_S
        speed, left, now_s = after, left - after * PERIOD_S, now_s + PERIOD_S
    way_m = 0.5 * LEAST_MPS**2 / DOWN_MPS2
    assert now_s == pytest.approx((20.0 - way_m) / LEAST_MPS + LEAST_MPS / DOWN_MPS2, abs=0.6)


@pytest.mark.parametrize("limit_mps", [4.0, 5.0 / 3.6])
def test_where_less_is_allowed_than_anybody_is_told_to_drive_that_is_advised(limit_mps: float) -> None:
    for end_s in (60.0, math.inf):
        found = SpeedAdvisor().advise(40.0, limit_mps, limit_mps, Greens(((0.0, end_s),), 0.0), 0.0)
        assert found == Advice(Advised.SPEED, limit_mps, limit_mps, limit_mps)
    assert SpeedAdvisor().advise(40.0, limit_mps, limit_mps, Greens(((60.0, 90.0),), 0.0), 0.0) == STOP
    assert SpeedAdvisor().advise(40.0, limit_mps, 0.0, Greens(((0.0, math.inf),), 0.0), 0.0) == STOP


def test_nothing_is_advised_without_news_far_away_and_to_who_stands() -> None:
    greens = Greens(((20.0, 40.0),), 0.0)
    advisor = SpeedAdvisor()
    assert advisor.advise(200.0, 12.0, LIMIT_MPS, greens, 0.0).kind is Advised.SPEED
    assert advisor.advise(200.0, 12.0, LIMIT_MPS, greens, 1.1) is NO_ADVICE
    assert advisor.advise(200.0, 12.0, LIMIT_MPS, None, 0.0) == NO_ADVICE
    assert advisor.advise(301.0, 12.0, LIMIT_MPS, greens, 0.0) == NO_ADVICE
    assert advisor.advise(-1.0, 12.0, LIMIT_MPS, greens, 0.0) == NO_ADVICE
    assert advisor.advise(3.0, 0.0, LIMIT_MPS, greens, 0.0) == NO_ADVICE
    assert advisor.advise(3.0, 0.0, LIMIT_MPS, Greens(((0.0, math.inf),), 0.0), 0.0).high_mps == LIMIT_MPS


def test_advice_ends_with_its_line() -> None:
    """What is kept in front of a line, where nobody reads any more, is not kept for the next one that is as near."""
    advisor = SpeedAdvisor()
    green = advisor.advise(10.0, 12.0, LIMIT_MPS, Greens(((0.0, 30.0),), 0.0), 0.0, line="first")
    assert green.kind is Advised.SPEED
    red = Greens(((20.0, 40.0),), 0.1)
    assert advisor.advise(9.0, 12.0, LIMIT_MPS, red, 0.1, line="first") == green
    assert advisor.advise(15.0, 12.0, LIMIT_MPS, red, 0.2, line="second") == STOP
    advisor.reset()
    assert advisor.advise(9.0, 12.0, LIMIT_MPS, Greens(((0.0, 30.0),), 0.2), 0.3, line="second") == green


class Approach(NamedTuple):
    """A drive to a light."""

    left_m: float
    speed_mps: float
    limit_mps: float
    phases: tuple[tuple[bool, float], ...]  # green or not, and for how long (s)
    offset_s: float
    reaction_s: float
    delay_s: float  # of messages
    lost: float  # share of messages

    def windows(self, now_s: float) -> tuple[tuple[float, float], ...]:
        """The next times of green."""
        cycle = sum(length for _, length in self.phases)
        first = math.floor((now_s + self.offset_s) / cycle) * cycle - self.offset_s
        found = []
        for number in range(4):
            ends = list(accumulate((length for _, length in self.phases), initial=first + number * cycle))
            for (green, _), (begin, end) in zip(self.phases, pairwise(ends), strict=True):
                if green and end > now_s:
                    found.append((max(begin - now_s, 0.0), end - now_s))
        return tuple(found)

    def is_green(self, now_s: float) -> bool:
        """Whether it is green now."""
        left_s = (now_s + self.offset_s) % sum(length for _, length in self.phases)
        for green, length in self.phases:
            if left_s < length:
                return green
            left_s -= length
        return self.phases[0][0]

    def legal(self) -> bool:
        """Whether some legal speed, kept all the way, passes the line at green: each is driven, in small steps."""
        speeds = np.linspace(min(LEAST_MPS, self.limit_mps), self.limit_mps, SCANNED)
        now, left, arrived = np.full(SCANNED, self.speed_mps), np.full(SCANNED, self.left_m), np.full(SCANNED, np.nan)
        for step in range(round(120.0 / PERIOD_S)):
            if step * PERIOD_S >= self.reaction_s:
                now += np.clip(speeds - now, -DOWN_MPS2 * PERIOD_S, UP_MPS2 * PERIOD_S)
            left -= now * PERIOD_S
            arrived[(left <= 0.0) & np.isnan(arrived)] = step * PERIOD_S
            if (left <= 0.0).all():
                break
        return any(((begin < arrived) & (arrived < end)).any() for begin, end in self.windows(0.0))


class Wire:
    """Times of green as /traffic_signals tells them: through the bytes of its message and back."""

    def __init__(self) -> None:
        self._registry = standard_registry()
        self._message, self._light = map(self._registry.struct, (SIGNALS_TYPE, "simconsole_msgs/TrafficSignal"))

    def told(self, windows: tuple[tuple[float, float], ...], now_s: float) -> Greens:
        message = self._message()
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(now_s * 1e9), 10**9)
        (begin, end), (later, last) = windows[:2]
        state, following, change_s = (6, 3, end) if begin <= 0.0 else (3, 6, begin)
        message.signals = [self._light("light", [state], [following], [change_s], [begin], [end], [later], [last])]
        sent = serialize(self._registry, SIGNALS_TYPE, message)
        light = lights_of(msgspec.convert(deserialize(self._registry, SIGNALS_TYPE, sent), self._message))["light", 0]
        return Greens(light.greens_s, light.stamp_s)


WIRE = Wire()


class Result(NamedTuple):
    """How an approach went."""

    advised: bool  # a speed was advised at some time
    followed: bool  # and wherever one was, and there was time to come to it, the speed was in the band
    at_green: bool
    stood: bool
    waited_s: float
    changes: int  # of what was shown


def drawn(rng: np.random.Generator) -> Approach:
    limit = float(rng.choice((30.0, 50.0, 70.0))) / 3.6
    green, red = rng.uniform(8.0, 45.0), rng.uniform(10.0, 60.0)
    return Approach(
        left_m=rng.uniform(120.0, 300.0),
        speed_mps=rng.uniform(0.55, 1.0) * limit,
        limit_mps=limit,
        phases=((True, green), (False, 3.0 + red)),
        offset_s=rng.uniform(0.0, green + red),
        reaction_s=rng.uniform(0.3, 1.0),
        delay_s=rng.uniform(0.0, 0.3),
        lost=0.1,
    )


def driven(approach: Approach, rng: np.random.Generator, advised: bool = True) -> Result:
    """Drive as advised, or at the limit; stop for a light that is not green."""
    advisor = SpeedAdvisor()
    left, speed, now_s, step = approach.left_m, approach.speed_mps, 0.0, 0
    shown, followed, changed_s, stood_s, changes = NO_ADVICE, approach.speed_mps, -1e9, 0.0, 0
    told: list[tuple[float, Greens]] = []
    greens: Greens | None = None
    ever, obeyed, settled_s = False, True, 0.0
    while left > 0.0:
        if step % round(MESSAGES_S / PERIOD_S) == 0 and rng.random() >= approach.lost:
            told.append((now_s + approach.delay_s, WIRE.told(approach.windows(now_s), now_s)))
        while told and told[0][0] <= now_s:
            greens = told.pop(0)[1]
        advice = advisor.advise(left, speed, approach.limit_mps, greens, now_s) if advised else NO_ADVICE
        ever |= advice.kind is Advised.SPEED
        if advice != shown:
            shown, changed_s, changes = advice, now_s, changes + 1
            settled_s = now_s + approach.reaction_s + abs(shown.target_mps - speed) / DOWN_MPS2 + SETTLED_S
        if shown.kind is Advised.SPEED and now_s >= settled_s:
            obeyed &= shown.low_mps - BESIDE_MPS <= speed <= shown.high_mps + BESIDE_MPS
        if shown.kind is Advised.SPEED and now_s - changed_s >= approach.reaction_s:
            followed = shown.target_mps
        elif shown.kind is not Advised.SPEED:
            followed = approach.limit_mps if shown is NO_ADVICE else rolling_mps(left - 1.0)
        accel = min(max(-DOWN_MPS2, (followed - speed) / 0.1), UP_MPS2)
        if (
            not approach.is_green(now_s) and shown.kind is not Advised.SPEED and speed**2 < 2.0 * 4.0 * left
        ):  # else it is too late to stop
            accel = min(accel, max(-4.0, (math.sqrt(2.0 * 1.5 * max(left - 1.0, 0.0)) - speed) / 0.1))
        stood_s += PERIOD_S * (speed < 0.1)
        speed = max(0.0, speed + PERIOD_S * accel)
        left, now_s, step = left - PERIOD_S * speed, now_s + PERIOD_S, step + 1
        assert now_s < 600.0
    at_green = approach.windows(now_s)[0][0] <= 0.0
    return Result(ever, ever and obeyed, at_green, stood_s > 0.0, stood_s, changes)


def test_approaches_that_follow_advice_cross_at_green(sample: Sample, measured: Measured) -> None:
    """The bars: at green in 100 % where followed; advice in at least 95 % of those with a legal speed."""
    rng = np.random.default_rng(sample.seed)
    approaches = [drawn(rng) for _ in range(sample.of(SHORT, FULL))]
    results = [driven(one, rng) for one in approaches]
    plain = [driven(one, rng, advised=False) for one in approaches]
    followed = [one for one in results if one.followed]
    legal = [one for approach, one in zip(approaches, results, strict=True) if approach.legal()]
    assert all(one.at_green for one in followed)
    given = sum(one.advised for one in legal) / len(legal)
    assert given >= 0.95
    assert len(followed) > 0.5 * len(approaches)
    waits = np.array([after.waited_s - before.waited_s for after, before in zip(results, plain, strict=True)])
    assert waits.mean() < 0.0
    assert sum(one.stood for one in results) < sum(one.stood for one in plain)
    assert max(one.changes for one in followed) < 60
    print(
        f"{len(approaches)} approaches, {len(legal)} with a legal speed: advised in {100 * given:.1f} %, followed"
        f" {len(followed)}, all at green; stood {sum(one.stood for one in results)} against"
        f" {sum(one.stood for one in plain)}, waiting {waits.mean():+.1f} s a drive"
    )


def test_nobody_is_left_to_creep_towards_a_green() -> None:
    """A lower limit held at first: once it is passed, the faster band is shown after a second."""
    advisor, greens = SpeedAdvisor(), Greens(((0.0, 60.0),), 0.0)
    slow = advisor.advise(200.0, 6.0, 9.0, greens, 0.0)
    assert slow.target_mps == 9.0
    assert advisor.advise(197.0, 6.0, LIMIT_MPS, greens, 0.5) == slow
    assert advisor.advise(190.0, 6.0, LIMIT_MPS, Greens(((0.0, 59.0),), 1.0), 1.1).target_mps == LIMIT_MPS


def test_a_band_does_not_flicker() -> None:
    """Shown for a second at least, while speeds and messages wander about."""
    rng = np.random.default_rng(5)
    advisor, shown = SpeedAdvisor(), list[tuple[float, Advice]]()
    left = 250.0
    for step in range(600):
        now_s = 0.02 * step
        stamp_s = 0.1 * (step // 5)
        greens = Greens(((30.0 - stamp_s + rng.normal(0.0, 0.02), 60.0 - stamp_s),), stamp_s)
        advice = advisor.advise(left, 9.0 + rng.normal(0.0, 0.2), LIMIT_MPS, greens, now_s)
        if not shown or shown[-1][1] != advice:
            shown.append((now_s, advice))
        left -= 9.0 * 0.02
    assert {advice.kind for _, advice in shown} == {Advised.SPEED}
    assert min(after[0] - before[0] for before, after in pairwise(shown)) >= HOLD_S
