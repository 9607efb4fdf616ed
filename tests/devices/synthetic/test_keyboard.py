"""Keys become axes at a person's speed, and a silent window goes stale."""

import math

import numpy as np
import pytest

from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.synthetic.keyboard import KeyboardSource
from simconsole.devices.synthetic.steering_assistance import Assistance, limit_rad
from simconsole.values.key_codes import Key
from simconsole.values.signals import Button, DriverInput
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from simconsole.values.units import RAD_PER_DEG
from simconsole.values.validity import LIVE, STALE
from tests.devices.calibration_run import CalibrationRun

ASSISTANCE = Assistance(lock_rad=450.0 * RAD_PER_DEG, half_at_mps=5.6, full_s=1.0)


class Board:
    """A keyboard and the person it makes."""

    def __init__(self, settings: CockpitSettings) -> None:
        self.held = Key(0)
        self.age = 0
        self.source = KeyboardSource(lambda: (int(self.held), self.age), settings, ASSISTANCE, tick_hz=250)
        self.calibration = CalibrationRun(settings)
        self.tick = 0

    def hold(self, held: Key, seconds: float) -> DriverInput:
        self.held = held
        for _ in range(round(seconds * 250)):
            self.tick += 1
            driver = self.calibration.calibrate(self.source.poll(self.tick))
        return driver


@pytest.fixture
def board(keyboard_settings: CockpitSettings) -> Board:
    opened = Board(keyboard_settings)
    opened.hold(Key(0), 0.1)
    return opened


def test_pedals_ramp_up_and_down(board: Board) -> None:
    assert 0.0 < board.hold(Key.THROTTLE, 0.1).throttle < 0.5
    assert board.hold(Key.THROTTLE, 1.0).throttle == 1.0
    assert board.hold(Key(0), 0.5).throttle == 0.0
    assert board.hold(Key.BRAKE | Key.HANDBRAKE, 1.0)[3:6] == (1.0, 0.0, 1.0)


def test_left_is_left_bounded_and_springs_back(board: Board) -> None:
    assert board.hold(Key.STEER_LEFT, 3.0).hand_wheel_rad == pytest.approx(ASSISTANCE.lock_rad)
    assert board.hold(Key.STEER_LEFT | Key.STEER_RIGHT, 1.0).hand_wheel_rad == pytest.approx(0.0)
    assert board.hold(Key.STEER_RIGHT, 0.2).hand_wheel_rad == pytest.approx(-math.radians(90.0), abs=0.04)
    assert board.hold(Key(0), 0.5).hand_wheel_rad == pytest.approx(0.0)


def test_a_fast_car_is_steered_less(board: Board) -> None:
    vector = np.zeros(PLATFORM_AT)
    vector[LAYOUT.vehicle.start + LAYOUT.vehicle.names.index("vx_mps")] = 25.0
    board.source.publish(Snapshot(1, 250, vector))
    assert board.hold(Key.STEER_RIGHT, 3.0).hand_wheel_rad == pytest.approx(-limit_rad(25.0, ASSISTANCE))


def test_gear_key_steps_once_and_works_the_clutch(board: Board) -> None:
    driver = board.hold(Key.GEAR_UP, 0.4)
    assert (driver.gear, driver.clutch) == (1.0, 1.0)
    driver = board.hold(Key(0), 0.5)
    assert (driver.gear, driver.clutch) == (1.0, pytest.approx(0.5, abs=0.01))
    assert board.hold(Key.GEAR_DOWN, 0.2).gear == 0.0


@pytest.mark.parametrize("button", [button for button in Button if button.name in Key.__members__])
def test_every_key_of_a_button_presses_it(button: Button, board: Board) -> None:
    assert board.hold(Key[str(button.name)], 0.02).pressed == float(button)
    assert board.hold(Key(0), 0.02).pressed == 0.0


def test_silent_window_holds_and_then_goes_stale(board: Board) -> None:
    pressed = board.hold(Key.THROTTLE, 0.2).throttle
    board.age = 60
    assert board.hold(Key.THROTTLE, 0.2).throttle == pressed
    board.age = 101
    driver = board.hold(Key.THROTTLE, 0.01)
    assert (driver.throttle, driver.throttle_validity) == (0.0, STALE)


def test_a_slow_frame_loses_no_key(board: Board) -> None:
    """Frames of 180 ms, as under load: the keyboard stays live, and the foot goes on pressing in between."""
    pressed = [0.0]
    for _ in range(8):
        for board.age in range(45):
            driver = board.hold(Key.THROTTLE, 0.004)
            assert driver.throttle_validity == LIVE
        pressed.append(driver.throttle)
    assert pressed[:3] == pytest.approx([0.0, 0.36, 0.72], abs=0.02)
    assert pressed[-1] == 1.0


def test_a_window_slower_than_the_tick_does_not_slow_the_hands(keyboard_settings: CockpitSettings) -> None:
    """Keys come at 60 frames a second, ticks at 250: a pedal rises by the clock, not by the frame."""
    framed = KeyboardSource(lambda: (int(Key.THROTTLE), next(ages)), keyboard_settings, ASSISTANCE, tick_hz=250)
    every_tick = KeyboardSource(lambda: (int(Key.THROTTLE), 0), keyboard_settings, ASSISTANCE, tick_hz=250)
    ages = iter(tick % 4 for tick in range(60))
    for tick in range(60):
        assert framed.poll(tick).throttle_axis == every_tick.poll(tick).throttle_axis
