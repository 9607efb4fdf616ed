"""Handling of real cars of which a linear single track is published: ranges of docs/driven_cars.md rest on it.

The manoeuvres are those of the page (ISO 7401, at 100 km/h), their figures are computed as there. A single track has no
roll and no lag of its tyres: a real car answers some hundredths of a second later, and its peak lies a little higher.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.profiles.manoeuvre import FrequencyResponse, StepSteer
from simconsole.values.units import MPS_PER_KMH, RAD_PER_DEG, STANDARD_GRAVITY_MPS2

Array = NDArray[np.float64]

_STEP_S = 1e-4
_STEADY_S = 0.5


class SingleTrack(NamedTuple):
    """Stiffnesses are those of both wheels of an axle, steering and suspension included."""

    mass_kg: float
    yaw_inertia_kgm2: float
    front_m: float  # centre of gravity to front axle
    rear_m: float
    front_nprad: float
    rear_nprad: float
    steering_ratio: float


def by_compliance(car: SingleTrack, front_deg_per_g: float, rear_deg_per_g: float) -> SingleTrack:
    """Return a car with its cornering compliances: each axle's slip angle in deg at 1 g (Bundorf, SAE 760713)."""
    axle_n = car.mass_kg * STANDARD_GRAVITY_MPS2 / (car.front_m + car.rear_m)
    front, rear = front_deg_per_g * RAD_PER_DEG, rear_deg_per_g * RAD_PER_DEG
    return car._replace(front_nprad=axle_n * car.rear_m / front, rear_nprad=axle_n * car.front_m / rear)


def by_openpilot(stiffness: float) -> SingleTrack:
    """Return its reference, a compact car of 2.7 m, with a share of the reference's tyre stiffness."""
    return SingleTrack(1462.0, 2500.0, 1.08, 1.62, 192150.0 * stiffness, 202500.0 * stiffness, 15.4)


PUBLISHED = {
    "openpilot, softest compact car": by_openpilot(0.385),
    "openpilot, stiffest compact car": by_openpilot(0.82),
    "Acura TSX of 2007": by_compliance(SingleTrack(1619.0, 2746.0, 1.041, 1.629, 0.0, 0.0, 14.8), 6.7, 3.1),
    "Honda Civic Si of 2012": by_compliance(SingleTrack(1450.0, 2345.0, 0.996, 1.624, 0.0, 0.0, 16.08), 9.6, 4.1),
}
"""Where they were read: SOURCES of `driven`, the first two in its [3], the others in its [4] and [11]."""


def figures(car: SingleTrack) -> dict[str, float]:
    """Return the figures of step and sine under their names in the manoeuvres' results."""
    step, sine = StepSteer(), FrequencyResponse()
    system, steered = matrices(car, step.speed_kmh * MPS_PER_KMH)
    time_s = np.arange(0.0, step.hold_s, _STEP_S)
    hand_deg = np.minimum(step.hand_wheel_deg, step.hand_wheel_degps * time_s)
    state, rate = np.zeros(2), np.zeros(len(time_s))
    for at, wheel in enumerate(hand_deg * RAD_PER_DEG / car.steering_ratio):
        rate[at] = state[1]
        state = state + _STEP_S * (system @ state + steered * wheel)
    steady = rate[-round(_STEADY_S / _STEP_S) :].mean()
    half_s = 0.5 * step.hand_wheel_deg / step.hand_wheel_degps
    responses = np.array([_response(system, steered, frequency_hz) for frequency_hz in sine.frequencies_hz])
    gains = np.abs(responses)
    return {
        "yaw_rate_response_time_s": float(time_s[np.argmax(rate >= 0.9 * steady)]) - half_s,
        "yaw_rate_overshoot_percent": float(100.0 * (rate.max() / steady - 1.0)),
        "yaw_rate_peak_frequency_hz": float(sine.frequencies_hz[int(gains.argmax())]),
        "yaw_rate_peak_ratio": float(gains.max() / gains[0]),
        "yaw_rate_lag_at_1_hz_deg": -float(np.angle(_response(system, steered, 1.0), deg=True)),
    }


def _response(system: Array, steered: Array, frequency_hz: float) -> complex:
    """Return yaw rate over road-wheel angle."""
    return complex(np.linalg.solve(2j * math.pi * frequency_hz * np.eye(2) - system, steered)[1])


def matrices(car: SingleTrack, speed_mps: float) -> tuple[Array, Array]:
    """Return the equations of lateral speed and yaw rate (Riekert and Schunck, 1940)."""
    front, rear = car.front_nprad, car.rear_nprad
    turning = car.rear_m * rear - car.front_m * front
    damping = car.front_m**2 * front + car.rear_m**2 * rear
    across = [-(front + rear) / (car.mass_kg * speed_mps), turning / (car.mass_kg * speed_mps) - speed_mps]
    yaw = [turning / (car.yaw_inertia_kgm2 * speed_mps), -damping / (car.yaw_inertia_kgm2 * speed_mps)]
    return np.array([across, yaw]), np.array([front / car.mass_kg, car.front_m * front / car.yaw_inertia_kgm2])
