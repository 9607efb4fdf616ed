import math

import numpy as np
import pytest

from simconsole.hud.driver_view.motion import ShownVehicle, between, moved, shown_vehicle
from simconsole.values.signals import Mode
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot


def snapshot(tick: int, **vehicle: float) -> Snapshot:
    vector = np.zeros(PLATFORM_AT)
    for name, value in vehicle.items():
        vector[LAYOUT.vehicle.start + LAYOUT.vehicle.names.index(name)] = value
    return Snapshot(tick, 250, vector)


def test_the_picture_is_between_the_two_newest_ticks_and_never_beyond() -> None:
    older, newer = snapshot(10, x_m=4.0, yaw_rad=0.1), snapshot(11, x_m=4.2, yaw_rad=0.3)
    places = [moved(older, newer, age_s).x_m for age_s in (-1.0, 0.0, 0.002, 0.004, 9.0)]
    assert places == pytest.approx([4.0, 4.0, 4.1, 4.2, 4.2])
    assert moved(older, newer, 0.001).yaw_rad == pytest.approx(0.15)


def test_angles_take_the_short_way_round() -> None:
    one, other = ShownVehicle(yaw_rad=3.1), ShownVehicle(yaw_rad=-3.1)
    assert math.cos(between(one, other, 0.5).yaw_rad) == pytest.approx(-1.0)


def test_what_is_on_or_off_is_never_held_back() -> None:
    older, newer = ShownVehicle(), ShownVehicle(mode=float(Mode.MANUAL), brake=1.0, turn_indicators=-1.0)
    shown = between(older, newer, 0.0)
    assert (shown.mode, shown.brake, shown.turn_indicators) == (float(Mode.MANUAL), 1.0, -1.0)


def test_a_single_tick_stands() -> None:
    still = snapshot(3, x_m=7.0, distance_m=5.0)
    assert moved(still, still, 0.5) == shown_vehicle(still)
