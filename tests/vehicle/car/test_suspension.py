"""Springs, bars and stops between body and wheels, by themselves and on the whole car."""

import math

import pytest

from simconsole.values.kernels import put
from simconsole.values.state_vector import PLATFORM_AT
from simconsole.vehicle.car.state import Wheel
from simconsole.vehicle.car.suspension import wheel_load
from tests.vehicle.altered import HATCHBACK, altered, loads, rolling_car
from tests.vehicle.driving import TICK_S
from tests.vehicle.parts import CAR


def test_wheel_loads_at_rest_carry_the_car_and_no_tyre_pulls() -> None:
    rest = Wheel(*(0.0,) * 6)
    loads = 2.0 * (wheel_load(CAR.front, rest) + wheel_load(CAR.rear, rest))
    assert loads == pytest.approx(CAR.body.mass_kg * 9.80665)
    assert wheel_load(CAR.front, rest) == pytest.approx(0.3 * CAR.body.mass_kg * 9.80665)
    assert wheel_load(CAR.front, rest._replace(lift_m=0.1)) == 0.0


def test_anti_roll_bars_take_roll_and_carry_load_to_their_axle() -> None:
    shares, rolls = [], []
    for front_nmprad in (0.0, 60000.0):
        profile = altered(front={"roll_bar_nmprad": front_nmprad})
        drive = rolling_car(profile, 20.0)
        seen = drive.hold(2.0, clutch=1.0, road_wheel_rad=0.03)
        on = loads(drive, profile)
        shares.append((on["fr"] - on["fl"]) / (on["fr"] - on["fl"] + on["rr"] - on["rl"]))
        rolls.append(seen.roll_rad / seen.ay_mps2)
    print(f"roll {[f'{math.degrees(r * 9.81):.2f}' for r in rolls]} deg/g, front's share of the transfer {shares}")
    assert rolls[1] < 0.7 * rolls[0]
    assert shares[1] > shares[0] + 0.15


def test_bump_stops_end_the_travel() -> None:
    heaves = []
    for stop_npm in (0.0, 90000.0):
        drive = rolling_car(altered(front={"stop_npm": stop_npm}, rear={"stop_npm": stop_npm}), 0.0)
        put(drive.row, PLATFORM_AT, drive.state._replace(heave_mps=-2.5))
        least = 0.0
        for _ in range(100):
            drive.hold(TICK_S)
            least = min(least, drive.state.heave_m)
        heaves.append(least)
    print(f"thrown down: {heaves[0]:.3f} m without, {heaves[1]:.3f} m with stops")
    assert heaves[0] < heaves[1] - 0.01
    assert heaves[1] < -HATCHBACK.front.travel_m
