"""The run-up: waits for the console, gets to the speed, and hands over once."""

import numpy as np
import pytest

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.manoeuvre_driver.run_up import SETTLE_S, SPARE_MPS, RunUp, keep_line
from simconsole.values.signals import Mode
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot

HZ = 250
SPEED_MPS = 20.0
BRAKE = Intent(brake=0.5)


def at(time_s: float, mode: Mode = Mode.MANUAL, **vehicle: float) -> Snapshot:
    row = np.zeros(PLATFORM_AT)
    row[LAYOUT.arbitration.at("mode")] = mode
    for name, value in vehicle.items():
        row[LAYOUT.vehicle.at(name)] = value
    return Snapshot(round(time_s * HZ), HZ, row)


class Steps:
    """A test of half a second that brakes."""

    def __init__(self) -> None:
        self.times: list[float] = []

    def __call__(self, snapshot: Snapshot, time_s: float) -> Intent | None:
        self.times.append(time_s)
        return BRAKE if time_s < 0.5 else None


def test_nothing_is_pressed_before_the_console_is_ready() -> None:
    pilot = RunUp(72.0, 15.0, Steps())
    assert pilot(at(SETTLE_S - 0.1)) == Intent()
    assert pilot(at(SETTLE_S + 1.0, Mode.PARKED)) == Intent()
    assert pilot(at(SETTLE_S + 1.0)).throttle == 1.0  # type: ignore[union-attr]


def test_it_rolls_down_to_the_speed_with_nothing_pressed_and_then_begins() -> None:
    steps = Steps()
    pilot = RunUp(72.0, 15.0, steps, most=0.5)
    pushed = pilot(at(5.0, vx_mps=SPEED_MPS + SPARE_MPS - 0.1))
    assert pushed == Intent(throttle=0.5, gear=1.0)
    assert pilot(at(6.0, vx_mps=SPEED_MPS + SPARE_MPS)) == Intent()
    assert pilot(at(6.1, vx_mps=SPEED_MPS - 0.1)) == Intent(), "the automatic is still leaving its gear"
    assert pilot(at(6.2, vx_mps=SPEED_MPS + 0.1)) == Intent(), "it does not press again"
    assert (pilot.began_tick, steps.times) == (None, [])
    assert pilot(at(7.0, vx_mps=SPEED_MPS)) == BRAKE
    assert pilot(at(7.2, vx_mps=1.0)) == BRAKE
    assert pilot(at(7.6)) is None
    assert pilot.began_tick == 7 * HZ
    assert steps.times == pytest.approx([0.0, 0.2, 0.6])


def test_with_the_speed_held_it_begins_in_gear_after_a_second() -> None:
    steps = Steps()
    pilot = RunUp(72.0, 15.0, steps, rolling=False, most=0.1)
    intent = pilot(at(5.0, vx_mps=10.0))
    assert intent == Intent(throttle=0.1, gear=1.0)
    for tick in range(3 * HZ):
        pilot(at(6.0 + tick / HZ, vx_mps=SPEED_MPS))
        if pilot.began_tick is not None:
            break
    assert pilot.began_tick == pytest.approx(7.0 * HZ, abs=3)


def test_the_hand_wheel_turns_back_to_the_line_by_the_steering_ratio() -> None:
    assert keep_line(at(1.0, y_m=0.5), 15.0) < 0.0 < keep_line(at(1.0, yaw_rad=-0.1), 15.0)
    assert keep_line(at(1.0, y_m=0.5), 30.0) == 2.0 * keep_line(at(1.0, y_m=0.5), 15.0)
    assert keep_line(at(1.0, x_m=100.0), 15.0) == 0.0
