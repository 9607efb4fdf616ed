"""Pushes and moves on wheels of which only half is known: bounded angle, bounded rate, right answer."""

from collections import deque
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest

from simconsole.devices.force_feedback.gentle_push import MOVED_RAD, PUSH_S, Gentle, gentle, move, push
from simconsole.devices.force_feedback.rim import Rim, turn
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.units import DEG_PER_RAD, RAD_PER_DEG
from tests.samples import Sample

TICK_HZ = 250
LAG_S = 0.002
COUNT_RAD = 0.0165 * RAD_PER_DEG
"""A step of the T500's axis."""
MOST_DEG = 15.0
MOST_DEGPS = 120.0


class Draw(NamedTuple):
    inertia: float  # of the profile's
    torque: float
    friction_nm: float
    delay_ms: int
    damping: float
    sign: float


class Bench:
    """A wheel in steps of 1 ms, seen and driven once a tick."""

    def __init__(self, force: ForceFeedback, draw: Draw) -> None:
        self.draw, self.motor = draw, force.motor
        self.wire = deque([0.0] * draw.delay_ms)
        self.rim = Rim(0.0, 0.0)
        self.motor_nm = 0.0
        self.furthest_deg = self.fastest_degps = 0.0

    def turn(self, torque_nm: float) -> float:
        for _ in range(1000 // TICK_HZ):
            self.wire.append(torque_nm * self.draw.torque * self.draw.sign)
            self.motor_nm += (self.wire.popleft() - self.motor_nm) * 0.001 / (0.001 + LAG_S)
            inertia, damping = self.motor.inertia_kgm2 * self.draw.inertia, self.motor.damping_nms * self.draw.damping
            self.rim = turn(self.rim, self.motor_nm, inertia, damping, self.draw.friction_nm, 0.001)
            self.furthest_deg = max(self.furthest_deg, abs(self.rim.rad) * DEG_PER_RAD)
            self.fastest_degps = max(self.fastest_degps, abs(self.rim.radps) * DEG_PER_RAD)
        return round(self.rim.rad / COUNT_RAD) * COUNT_RAD


def draws(rng: np.random.Generator, count: int) -> list[Draw]:
    ends = [
        Draw(inertia, torque, friction_nm, delay_ms, damping, sign)
        for inertia in (0.5, 2.0)
        for torque in (0.5, 2.0)
        for friction_nm in (0.03, 0.3)
        for delay_ms in (5, 32)
        for damping, sign in ((0.0, 1.0), (1.0, -1.0))
    ]
    return ends + [
        Draw(
            inertia=2.0 ** rng.uniform(-1.0, 1.0),
            torque=2.0 ** rng.uniform(-1.0, 1.0),
            friction_nm=rng.uniform(0.03, 0.3),
            delay_ms=int(rng.integers(5, 33)),
            damping=rng.uniform(0.0, 1.0),
            sign=rng.choice((1.0, -1.0)),
        )
        for _ in range(count)
    ]


def force_of(name: str) -> tuple[ForceFeedback, Gentle]:
    force = load("devices", name, CockpitProfile).force_feedback
    assert force is not None
    return force, gentle(force, 0.25, TICK_HZ)


def turns_rad(rules: Gentle, draw: Draw, force: ForceFeedback) -> float:
    """Return how far the largest torque that is allowed turns a wheel from rest in the time of a push."""
    beyond_nm = rules.limit_nm * draw.torque - draw.friction_nm
    return 0.5 * beyond_nm / (force.motor.inertia_kgm2 * draw.inertia) * PUSH_S * PUSH_S


@pytest.mark.parametrize("name", ["t500rs_th8rs", "t300rs_th8a", "g29"])
def test_no_push_and_no_move_is_far_or_fast_on_any_wheel(
    name: str, sample: Sample, record_property: Callable[[str, object], None]
) -> None:
    force, rules = force_of(name)
    rng = np.random.default_rng(sample.seed)
    furthest = fastest = 0.0
    for draw in draws(rng, sample.of(8, 1000)):
        bench = Bench(force, draw)
        for direction in (1.0, -1.0):
            pushed = push(bench.turn, rules, direction)
            if rules.limit_nm * draw.torque <= draw.friction_nm:  # no torque that is allowed turns this wheel
                assert pushed.sense == 0.0, draw
                break
            furthest, fastest = max(furthest, bench.furthest_deg), max(fastest, bench.fastest_degps)
            assert bench.furthest_deg <= MOST_DEG, draw
            assert bench.fastest_degps <= MOST_DEGPS, draw
            if turns_rad(rules, draw, force) < MOVED_RAD and pushed.sense == 0.0:
                break
            assert pushed.sense == draw.sign, draw
            assert pushed.turned_rad * direction * draw.sign >= MOVED_RAD, draw
            back_rad = move(bench.turn, rules, 0.0, pushed.sense)
            assert abs(back_rad) <= 3.0 * RAD_PER_DEG, draw
            assert bench.furthest_deg <= MOST_DEG, draw
            assert bench.fastest_degps <= MOST_DEGPS, draw
    record_property(f"push of an unknown wheel, {name}", f"{furthest:.1f} deg, {fastest:.0f} deg/s")


@pytest.mark.parametrize("name", ["t500rs_th8rs", "g29"])
def test_a_wheel_that_is_left_alone_under_way_stays_within_bounds(name: str, sample: Sample) -> None:
    """The torque that is on stays for another 200 ms, as an effect does that nobody starts again."""
    force, rules = force_of(name)
    for draw in draws(np.random.default_rng(sample.seed), sample.of(8, 1000)):
        bench = Bench(force, draw._replace(sign=1.0))
        last = [0.0]

        def noted(torque_nm: float, bench: Bench = bench, last: list[float] = last) -> float:
            last.append(torque_nm)
            return bench.turn(torque_nm)

        if rules.limit_nm * draw.torque <= draw.friction_nm:
            continue
        move(noted, rules, -6.0 * RAD_PER_DEG, 1.0)
        move(noted, rules, 6.0 * RAD_PER_DEG, 1.0, moving=True)
        for tick in range(round(0.35 * TICK_HZ)):
            bench.turn(last[-1] if tick < 0.2 * TICK_HZ else 0.0)
        move(bench.turn, rules, 0.0, 1.0)
        assert bench.furthest_deg <= MOST_DEG, draw
        assert bench.fastest_degps <= MOST_DEGPS, draw
