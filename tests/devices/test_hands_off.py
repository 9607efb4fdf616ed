"""A wheel that is let go of in a bend comes to rest, whatever wheel it is; and nobody's torque is told from a push."""

from collections.abc import Callable
from itertools import pairwise

import msgspec
import numpy as np
import pytest

from simconsole.devices.force_feedback.simulated_wheel import HANDS_OFF, Arm
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.signals import Mode, Reason
from tests.devices.benched_wheel import found_force
from tests.devices.closed_loop import MODE_AT, Loop
from tests.devices.hands_off import (
    ENDS,
    SOME_ENDS,
    TICK_HZ,
    Draw,
    Released,
    bend,
    draws,
    let_go,
    session_of,
    swings,
    true_force,
    wheels,
)
from tests.samples import Sample
from tests.vehicle.shipped import SHIPPED

SPEEDS_KMH = (60, 80, 100, 120, 150)
BENDS = [(car, speed) for car in SHIPPED for speed in SPEEDS_KMH] + [("hatchback", 190), ("light_van", 160)]
"""Cars and speeds in km/h; two cars up to their top speed, too."""
SWING_DEG = 1.5
"""Smaller ways are within the friction of the wheel."""
PUSH = Arm(1000.0, 0.0, 0.0, 3.0, 0.0)
"""A push of 3 N m, wherever the wheel goes."""


@pytest.fixture(scope="module")
def shipped() -> ForceFeedback:
    force = session_of("hatchback").cockpit.force_feedback
    assert force is not None
    return force


def worst_ratio(released: Released) -> float:
    swings = released.swings_deg
    return max((late / early for early, late in pairwise(swings) if late > SWING_DEG), default=0.0)


@pytest.mark.parametrize(("vehicle", "speed_kmh"), BENDS)
@pytest.mark.parametrize("lateral_mps2", [2.0, 3.9])
def test_every_swing_is_at_most_half_the_last(
    vehicle: str,
    speed_kmh: int,
    lateral_mps2: float,
    shipped: ForceFeedback,
    sample: Sample,
    record_property: Callable[[str, object], None],
) -> None:
    start = bend(vehicle, speed_kmh, lateral_mps2)
    assert start is not None
    assert start.speed_mps >= 0.95 * speed_kmh / 3.6
    assert 0.95 * lateral_mps2 <= start.lateral_mps2 <= 4.0
    worst = share = 0.0
    for draw in wheels(sample):
        released = let_go(vehicle, start, true_force(shipped, draw), found_force(shipped, draw))
        worst = max(worst, worst_ratio(released))
        assert worst <= 0.5, (draw, released.swings_deg)
        end_deg = np.degrees(released.rad[-TICK_HZ:])
        assert np.ptp(end_deg) < 1.0, draw
        assert abs(end_deg[-1]) <= released.friction_band_deg + 5.0, draw
        if draw == Draw():
            share = released.share
    assert share >= (1.0 if speed_kmh <= 100 else 0.9), "the shipped figures bear the car's torque"
    record_property(f"hands off, {vehicle}, {speed_kmh} km/h, {lateral_mps2:g} m/s2", f"swings at most {worst:.2f}")


@pytest.mark.parametrize("speed_kmh", [210, 320])
def test_bmw_comes_to_rest_up_to_its_own_top_speed(speed_kmh: int, shipped: ForceFeedback) -> None:
    """324 km/h, an oversteering car that settles in no bend: released on the way, from at most 4 m/s2."""
    start = bend("commonroad_bmw320i", speed_kmh, 2.0)
    assert start is not None
    assert start.speed_mps >= 0.95 * speed_kmh / 3.6
    assert 1.5 <= start.lateral_mps2 <= 4.0
    for draw in (Draw(), ENDS[5], ENDS[10]):
        released = let_go("commonroad_bmw320i", start, true_force(shipped, draw), found_force(shipped, draw))
        assert worst_ratio(released) <= 0.5, (draw, released.swings_deg)
        end_deg = np.degrees(released.rad[-TICK_HZ:])
        assert np.ptp(end_deg) < 1.0, draw
        assert abs(end_deg[-1]) <= released.friction_band_deg + 5.0, draw


@pytest.mark.parametrize("vehicle", SHIPPED)
@pytest.mark.parametrize("speed_kmh", [30, 45])
def test_slow_car_never_swings_up(vehicle: str, speed_kmh: int, shipped: ForceFeedback, sample: Sample) -> None:
    start = bend(vehicle, speed_kmh, 3.9)
    assert start is not None
    for draw in wheels(sample):
        released = let_go(vehicle, start, true_force(shipped, draw), found_force(shipped, draw))
        ways_deg = swings(np.degrees(released.rad), SWING_DEG)  # a halt on the way back is no swing
        assert all(late <= early for early, late in pairwise(ways_deg)), (draw, ways_deg)


def test_steeper_rim_is_held_as_well(shipped: ForceFeedback) -> None:
    """Twice the car's torque: damping and share follow from the stiffness, not from one car."""
    steep = msgspec.structs.replace(shipped, car_share=2.0)
    start = bend("hatchback", 100, 2.0)
    assert start is not None
    for draw in (Draw(), ENDS[4], ENDS[5]):
        released = let_go("hatchback", start, true_force(steep, draw), found_force(steep, draw))
        assert worst_ratio(released) <= 0.5, (draw, released.swings_deg)


def test_autonomy_ends_by_a_push_and_by_nothing_else(
    shipped: ForceFeedback, sample: Sample, record_property: Callable[[str, object], None]
) -> None:
    slowest_s = 0.0
    some = draws(np.random.default_rng(sample.seed), sample.of(1, 200))
    for number, draw in enumerate((*(ENDS if sample.long else SOME_ENDS), *some)):
        loop = Loop(wheel=(true_force(shipped, draw), found_force(shipped, draw)))
        loop.engage()
        for _ in loop.seconds(60.0):
            if loop.tick(HANDS_OFF).vector[MODE_AT] != Mode.AUTONOMOUS:
                break
        assert loop.snapshot.arbitration.mode == Mode.AUTONOMOUS, (draw, loop.snapshot.t_s)
        began_s, side = loop.snapshot.t_s, 5.0 if number % 2 else -5.0
        while loop.snapshot.arbitration.mode == Mode.AUTONOMOUS and loop.snapshot.t_s < began_s + 1.0:
            loop.tick(PUSH, loop.wheel.state.rad + side)
        assert loop.snapshot.arbitration.reason == Reason.STEERING_OVERRIDE, draw
        slowest_s = max(slowest_s, loop.snapshot.t_s - began_s)
        assert slowest_s <= 0.3, draw
    record_property("push of 3 N m", f"taken over within {slowest_s:.2f} s")
