"""A plant of its own for the tracker: nonlinear single-track car, saturating tyres, lags and delay."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.drivers.path_tracker.tracker import Tracker
from simconsole.drivers.path_tracker.tracker_settings import HATCHBACK, CarModel
from simconsole.profiles.files.loader import load
from simconsole.profiles.world import CourseProfile
from simconsole.world.course import Course
from tests.devices.conftest import sdl, t500

__all__ = ["sdl", "t500"]  # fixtures: who sits in a cockpit needs one

STEP_S = 0.002


class Plant(NamedTuple):
    car: CarModel = HATCHBACK
    friction: float = 1.0
    steering_lag_s: float = 0.05
    along_lag_s: float = 0.2
    delay_ms: int = 20


class Trace(NamedTuple):
    """One entry per control period."""

    time_s: NDArray[np.float64]
    s_m: NDArray[np.float64]
    lateral_m: NDArray[np.float64]
    speed_mps: NDArray[np.float64]
    accel_mps2: NDArray[np.float64]
    lateral_mps2: NDArray[np.float64]


def axle_n(stiffness: float, slip: float, limit: float) -> float:
    return limit * math.tanh(stiffness * slip / limit)


def drive(
    tracker: Tracker, plant: Plant, distance_m: float, start: VehicleMotion | None = None, time_s: float = 400.0
) -> Trace:
    car, h = plant.car, STEP_S
    x, y, yaw, vx, vy, r = start or (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    wheel = accel = wanted_wheel = wanted_accel = 0.0
    grip = plant.friction * car.mass_kg * 9.81 / car.wheelbase_m
    pending: list[tuple[int, float, float]] = []
    rows: list[tuple[float, ...]] = []
    for t_ms in range(0, round(1000 * time_s), round(1000 * h)):
        if t_ms % 20 == 0:
            answer = tracker.step(VehicleMotion(x, y, yaw, vx, vy, r))
            pending.append((t_ms + plant.delay_ms, answer.road_wheel_rad, answer.accel_mps2))
            assert tracker.s_m is not None
            rows.append((t_ms / 1000, tracker.s_m, tracker.lateral_m, vx, accel, vx * r))
            if tracker.s_m > distance_m or abs(tracker.lateral_m) > 3.0:
                break
        while pending and pending[0][0] <= t_ms:
            _, wanted_wheel, wanted_accel = pending.pop(0)
        wheel += h * (wanted_wheel - wheel) / plant.steering_lag_s
        accel += h * (wanted_accel - accel) / plant.along_lag_s
        if vx < 1.0:
            r, vy, vx = vx * math.tan(wheel) / car.wheelbase_m, 0.0, max(0.0, vx + h * accel)
        else:
            front = axle_n(
                car.front_stiffness_nprad, wheel - math.atan2(vy + car.wheelbase_m * r, vx), grip * car.rear_m
            )
            rear = axle_n(car.rear_stiffness_nprad, -math.atan2(vy, vx), grip * car.front_m)
            across = front * math.cos(wheel)
            middle = vy + car.rear_m * r + h * ((across + rear) / car.mass_kg - vx * r)
            r += h * (car.front_m * across - car.rear_m * rear) / car.yaw_inertia_kgm2
            vy = middle - car.rear_m * r
            vx += h * (accel + middle * r)
        yaw += h * r
        x += h * (vx * math.cos(yaw) - vy * math.sin(yaw))
        y += h * (vx * math.sin(yaw) + vy * math.cos(yaw))
    return Trace(*np.array(rows).T)


@pytest.fixture(scope="session")
def course() -> Course:
    return Course(load("worlds", "urban", CourseProfile))


@pytest.fixture(scope="session")
def laps() -> Callable[[Tracker, Plant, float], Trace]:
    return drive


@pytest.fixture(scope="session")
def nominal() -> Plant:
    return Plant()
