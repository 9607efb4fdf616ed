"""Anti-lock brakes of the shipped cars: never longer than locked wheels, at a real system's pace, and steerable."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from simconsole.values.platform import Ground
from simconsole.values.units import KMH_PER_MPS
from tests.vehicle.driving import TICK_S
from tests.vehicle.shipped import SHIPPED, shipped

CYCLING_FROM_MPS = 5.0
SETTLED_S = 0.5
FRICTIONS = [0.3, 0.6, 1.0]


def stopped(car: str, friction: float, anti_lock: bool) -> tuple[float, NDArray[np.float64]]:
    """Brake fully from 100 km/h; return the distance in m, and speeds and torques of a front brake while it lasts."""
    drive = shipped(car, Ground(friction, 0.0, 0.0), 100.0 / KMH_PER_MPS, anti_lock=anti_lock)
    rows: list[tuple[float, float]] = []
    while drive.seen.vx_mps > 0.05:
        seen = drive.hold(TICK_S, brake=1.0, clutch=1.0)
        rows.append((seen.vx_mps, drive.state.fl_brake_nm))
    return drive.seen.x_m, np.array(rows)


def cycles_hz(rows: NDArray[Any]) -> float:
    """Return how often per second a brake begins to be released."""
    part = rows[round(SETTLED_S / TICK_S) :]
    torque = part[part[:, 0] > CYCLING_FROM_MPS, 1]
    falling = np.diff(torque) < 0.0
    return float((falling[1:] & ~falling[:-1]).sum() / (len(torque) * TICK_S))


@pytest.mark.parametrize("car", SHIPPED)
@pytest.mark.parametrize("friction", FRICTIONS)
def test_stops_no_later_than_with_locked_wheels_at_3_to_10_hz(car: str, friction: float) -> None:
    distance, rows = stopped(car, friction, True)
    locked, _ = stopped(car, friction, False)
    pace = cycles_hz(rows)
    print(f"{distance:.1f} m at {pace:.1f} Hz, locked {locked:.1f} m")
    assert distance < locked
    assert 3.0 <= pace <= 10.0


@pytest.mark.parametrize("car", SHIPPED)
@pytest.mark.parametrize("friction", FRICTIONS)
def test_evades_while_it_brakes_fully_where_locked_wheels_go_straight(car: str, friction: float) -> None:
    aside = []
    for on in (True, False):
        drive = shipped(car, Ground(friction, 0.0, 0.0), 80.0 / KMH_PER_MPS, anti_lock=on)
        drive.hold(0.5, brake=1.0, clutch=1.0)
        aside.append(drive.hold(1.5, brake=1.0, clutch=1.0, road_wheel_rad=0.08).y_m)
    print(f"{aside[0]:.2f} m aside, {aside[1]:.2f} m with locked wheels")
    assert aside[0] > 0.8
    assert abs(aside[1]) < 0.25 * aside[0]


@pytest.mark.parametrize("car", SHIPPED)
def test_the_pressure_lags_behind_the_pedal(car: str) -> None:
    """90 % of the torque after about 0.1 to 0.15 s, as booster and lines of cars take."""
    drive = shipped(car, speed_mps=30.0)
    full = drive.hold(1.0, brake=0.3, clutch=1.0) and drive.state.fl_brake_nm
    drive = shipped(car, speed_mps=30.0)
    ticks = 0
    while drive.state.fl_brake_nm < 0.9 * full:
        drive.hold(TICK_S, brake=0.3, clutch=1.0)
        ticks += 1
    print(f"{ticks * TICK_S:.3f} s")
    assert 0.08 <= ticks * TICK_S <= 0.18
    drive.hold(1.0, clutch=1.0)
    assert drive.state.fl_brake_nm == 0.0, "released altogether"
