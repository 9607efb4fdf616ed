"""Shafts as friction constraints: by themselves and in plain Python."""

import pytest

from simconsole.vehicle.car.powertrain import Capacity, Inertia, Shafts, braked, solve_shafts


def inertia(kgm2: float) -> Inertia:
    return Inertia(kgm2, 1.0 / kgm2)


def shafts(
    engine: float, left: float, right: float, ratio: float, capacities: tuple[float, float, float], lock: float = 0.0
) -> Shafts:
    friction, clutch, brake = capacities
    before = Shafts(engine, left, right, 0.0, 0.0, 0.0, 0.0, 0.0)
    return solve_shafts(before, ratio, inertia(0.2), inertia(1.0), Capacity(friction, clutch, brake, brake, lock, 0.0))


def test_slipping_clutch_conserves_momentum_and_serves_both_wheels() -> None:
    after = shafts(200.0, 0.0, 3.0, 10.0, (0.0, 0.3, 0.0))
    assert after.clutch_impulse_nms == 0.3
    assert 0.2 * (200.0 - after.engine_radps) == pytest.approx(0.3)
    assert after.left_radps == pytest.approx(5.0 * 0.3)
    assert after.right_radps - 3.0 == pytest.approx(5.0 * 0.3), "the open differential halves the torque"


def test_closed_clutch_brings_engine_and_mean_wheel_to_one_speed() -> None:
    after = shafts(200.0, 8.0, 12.0, 10.0, (0.0, 1e6, 0.0))
    assert after.engine_radps == pytest.approx(5.0 * (after.left_radps + after.right_radps), rel=1e-12)
    assert after.right_radps - after.left_radps == pytest.approx(4.0)
    momentum = 0.2 * after.engine_radps * 10.0 + after.left_radps + after.right_radps
    assert momentum == pytest.approx(0.2 * 200.0 * 10.0 + 20.0)


def test_lock_brings_both_wheels_together_as_far_as_it_can() -> None:
    slipping = shafts(0.0, 2.0, 6.0, 0.0, (0.0, 0.0, 0.0), lock=0.5)
    assert (slipping.left_radps, slipping.right_radps) == pytest.approx((2.5, 5.5))
    locked = shafts(0.0, 2.0, 6.0, 0.0, (0.0, 0.0, 0.0), lock=50.0)
    assert (locked.left_radps, locked.right_radps) == pytest.approx((4.0, 4.0))


def test_brake_stops_at_exactly_zero_and_never_turns_a_wheel_back() -> None:
    assert shafts(0.0, 0.5, -0.7, 0.0, (0.0, 0.0, 100.0))[1:3] == (0.0, 0.0)
    assert shafts(0.0, 0.5, 0.1, 0.0, (0.0, 0.0, 0.2)).left_radps == pytest.approx(0.3)
    assert braked(0.3, 0.5, 1.0) == 0.0
    assert braked(-5.0, 0.5, 1.0) == -4.5


def test_parked_in_gear_the_shafts_converge_to_rest_under_load() -> None:
    state = Shafts(*(0.0,) * 8)
    most = Capacity(0.05, 0.28, 0.0, 0.0, 0.0, 0.0)
    for _ in range(300):
        pushed = state._replace(left_radps=state.left_radps - 0.125, right_radps=state.right_radps - 0.125)
        state = solve_shafts(pushed, 14.0, inertia(0.16), inertia(1.1), most)
    assert abs(state.left_radps) < 1e-12
    assert state.clutch_impulse_nms == pytest.approx(0.25 * 1.1 / 14.0)
