import random

import numpy as np
import pytest

from simconsole.drivers.speed_holder import SpeedHolder, hold_speed
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot

VX = LAYOUT.vehicle.at("vx_mps")


def at(speed_mps: float) -> Snapshot:
    row = np.zeros(PLATFORM_AT)
    row[VX] = speed_mps
    return Snapshot(1, 250, row)


def test_throttle_stays_on_its_pedal_whatever_the_speed() -> None:
    dice, holder, integral = random.Random(20261122), SpeedHolder(20.0), 0.0
    for _ in range(5000):
        speed_mps = dice.choice([20.0, dice.uniform(17.0, 23.0), dice.uniform(-5.0, 60.0)])
        throttle, integral = hold_speed(20.0, speed_mps, integral, 0.004, 0.6)
        assert 0.0 <= throttle <= 0.6
        assert 0.0 <= integral <= 0.6
        assert 0.0 <= holder(at(speed_mps)) <= 1.0


def test_test_driver_says_when_the_speed_is_held() -> None:
    holder = SpeedHolder(20.0)
    for _ in range(249):
        holder(at(20.05))
        assert not holder.settled
    for _ in range(3):
        holder(at(20.05))
    assert holder.settled
    holder(at(20.2))
    assert not holder.settled


def test_integral_learns_what_holds_the_speed_against_drag() -> None:
    speed_mps, holder = 18.0, SpeedHolder(20.0)
    for _ in range(250 * 60):
        speed_mps += (4.0 * holder(at(speed_mps)) - 0.8) / 250
    assert speed_mps == pytest.approx(20.0, abs=0.01)
