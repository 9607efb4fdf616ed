"""Braking and lift-off in a bend, on drives whose answer is known."""

import numpy as np
import pytest

from simconsole.evaluation.manoeuvres.bend import bend_braking, lift_off
from simconsole.evaluation.metrics.table import Drive
from simconsole.profiles.manoeuvre import BendBraking, LiftOff
from tests.evaluation.manoeuvres.driven import CAR, HZ, drive

SPEED_MPS = 500.0**0.5


def bent(deceleration_mps2: float, tightened_per_s: float) -> Drive:
    """Return a steady circle of 8 s, then braking in which the yaw rate per speed grows steadily."""
    time_s = np.arange(9.5 * HZ) / HZ - 8.0
    after = np.clip(time_s, 0.0, None)
    speed = SPEED_MPS - deceleration_mps2 * after
    return drive(
        9.5,
        vehicle__vx_mps=speed,
        vehicle__yaw_rate_radps=speed / 100.0 * (1.0 + tightened_per_s * after),
        vehicle__ay_mps2=np.array(5.0),
        platform__vx_mps=np.array(20.0),
        platform__vy_mps=-20.0 * np.tan(np.radians(after)),
    )


def test_a_bend_that_tightens_is_told_by_its_ratio_after_a_second() -> None:
    at_work = lift_off(LiftOff(), CAR)
    next(at_work).pilot.began_tick = 0  # type: ignore[union-attr]
    with pytest.raises(StopIteration) as end:
        at_work.send(bent(1.0, 0.2))
    values = end.value.value.values
    assert values["yaw_rate_ratio_at_1_s"] == pytest.approx(1.2, rel=2e-3)
    assert values["highest_yaw_rate_ratio"] == pytest.approx(1.2, rel=2e-3)
    assert values["mean_deceleration_mps2"] == pytest.approx(1.0, rel=1e-3)
    assert values["largest_change_of_sideslip_deg"] == pytest.approx(1.0, rel=1e-2)
    assert values["lateral_acceleration_before_mps2"] == 5.0


def test_the_pedal_for_the_deceleration_is_found_by_halving() -> None:
    """A car that brakes with 10 m/s2 times the pedal: 3.4 m/s2 is at 0.34."""
    at_work = bend_braking(BendBraking(), CAR)
    attempt = next(at_work)
    pedals: list[float] = []
    values: dict[str, float] = {}
    while not values:
        pedals.append(float(attempt.name.rpartition(" ")[2]))
        attempt.pilot.began_tick = 0  # type: ignore[union-attr]
        try:
            attempt = at_work.send(bent(10.0 * pedals[-1], 0.1))
        except StopIteration as end:
            values = end.value.values
    assert pedals[0] == pytest.approx(0.29)
    assert pedals[-1] == pytest.approx(0.34, abs=0.01)
    assert values["yaw_rate_ratio_at_1_s"] == pytest.approx(1.1, rel=2e-3)


@pytest.mark.parametrize(
    ("at_work", "told"),
    [
        (bend_braking(BendBraking(), CAR), "braking in a bend: the car has not held 80.5 km/h"),
        (lift_off(LiftOff(), CAR), "lift-off: the car has not held 80.5 km/h"),
    ],
)
def test_a_car_that_does_not_get_there_is_told(at_work: object, told: str) -> None:
    next(at_work)  # type: ignore[call-overload]
    with pytest.raises(StopIteration) as end:
        at_work.send(bent(1.0, 0.0))  # type: ignore[attr-defined]
    assert end.value.value.problem.startswith(told[:30])
