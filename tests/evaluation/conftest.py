"""A made-up drive: 30 s at 10 m/s along the course, swaying beside it, the autopilot from 5 s to 25 s."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from simconsole.profiles.files.loader import load
from simconsole.profiles.world import CourseProfile
from simconsole.values.signals import Mode, Reason
from simconsole.values.state_vector import columns
from simconsole.world.course import Course

TICK_HZ = 50
SPEED_MPS = 10.0


class Nothing(NamedTuple):
    nothing: float


class Known(NamedTuple):
    vectors: NDArray[np.float64]
    columns: tuple[str, ...]
    tick_hz: int


@pytest.fixture(scope="session")
def course() -> Course:
    return Course(load("worlds", "urban", CourseProfile))


@pytest.fixture(scope="session")
def known(course: Course) -> Known:
    names = columns(Nothing)
    rows = np.zeros((30 * TICK_HZ, len(names)))
    at = {name: index for index, name in enumerate(names)}
    for tick, row in enumerate(rows):
        time_s = tick / TICK_HZ
        s = 2590.0 + SPEED_MPS * time_s
        lateral = 0.02 * math.sin(s / 5.0) if 5.0 <= time_s < 25.0 else 0.3
        point = course.at(s)
        row[at["vehicle.x_m"]] = point.x_m - lateral * math.sin(point.yaw_rad)
        row[at["vehicle.y_m"]] = point.y_m + lateral * math.cos(point.yaw_rad)
        row[at["vehicle.vx_mps"]] = SPEED_MPS
        row[at["vehicle.ay_mps2"]] = -1.5 if tick == 700 else 0.1
        row[at["arbitration.mode"]] = Mode.AUTONOMOUS if 5.0 <= time_s < 25.0 else Mode.MANUAL
        row[at["arbitration.reason"]] = (
            Reason.START if time_s < 5.0 else Reason.PERSON_ASKED if time_s < 25.0 else Reason.STEERING_OVERRIDE
        )
        row[at["arbitration.refusal"]] = Reason.REFUSED_BRAKE_PRESSED if 4.0 <= time_s < 6.0 else 0.0
    return Known(rows, names, TICK_HZ)
