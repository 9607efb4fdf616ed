"""Frequency response (ISO 7401, continuous sinusoidal input): gain and lag of the yaw rate, sine by sine."""

import math
from collections.abc import Generator
from typing import NamedTuple

import numpy as np

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.manoeuvre_driver.run_up import RunUp
from simconsole.drivers.speed_holder import SpeedHolder
from simconsole.evaluation.manoeuvres.attempt import Attempt, Driving, Line, Panel, Result, part, undriven
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.profiles.manoeuvre import FrequencyResponse
from simconsole.values.platform import Platform
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import DEG_PER_RAD, MPS_PER_KMH, RAD_PER_DEG

SETTLED_CYCLES = 2
CYCLES = 3


class Response(NamedTuple):
    """Yaw rate over hand-wheel angle at one frequency."""

    gain_per_s: float
    lag_deg: float


def frequency_response(spec: FrequencyResponse, car: Platform) -> Driving:
    """Drive one sine for each frequency."""
    found: list[Response] = []
    for frequency_hz in spec.frequencies_hz:
        driven = yield from _sine(spec, car, frequency_hz)
        if driven is None:
            return undriven("frequency response", spec.speed_kmh)
        found.append(response(driven, frequency_hz))
    gains = np.array([one.gain_per_s for one in found])
    lags = np.array([one.lag_deg for one in found])
    frequencies = np.array(spec.frequencies_hz)
    values = {
        "steady_yaw_rate_gain_per_s": float(gains[0]),
        "yaw_rate_peak_ratio": float(gains.max() / gains[0]),
        "yaw_rate_peak_frequency_hz": float(frequencies[gains.argmax()]),
        "yaw_rate_lag_at_1_hz_deg": float(np.interp(1.0, frequencies, lags)),
    }
    panels = (
        Panel("Yaw rate over hand wheel", "frequency / Hz", "gain / 1/s", (Line("", frequencies, gains),)),
        Panel("Yaw rate behind hand wheel", "frequency / Hz", "lag / deg", (Line("", frequencies, lags),)),
    )
    return Result(values, panels)


def response(driven: Drive, frequency_hz: float) -> Response:
    """Return gain and lag of the first harmonic over whole cycles."""
    time_s = driven.time_s - driven.time_s[0]
    ticks = round(CYCLES / frequency_hz * driven.tick_hz)

    def harmonic(values: Array) -> complex:
        turning = np.exp(-2j * math.pi * frequency_hz * time_s[:ticks])
        return complex(((values[:ticks] - values[:ticks].mean()) * turning).sum())

    ratio = harmonic(driven.column("vehicle.yaw_rate_radps")) / harmonic(driven.column("driver.hand_wheel_rad"))
    return Response(abs(ratio), -math.atan2(ratio.imag, ratio.real) * DEG_PER_RAD)


def _sine(spec: FrequencyResponse, car: Platform, frequency_hz: float) -> Generator[Attempt, Drive, Drive | None]:
    """Return the settled cycles of one sine; None: the car does not get to the speed."""
    hold = SpeedHolder(spec.speed_kmh * MPS_PER_KMH)

    def turn(snapshot: Snapshot, time_s: float) -> Intent | None:
        if time_s * frequency_hz > SETTLED_CYCLES + CYCLES + 0.1:
            return None
        hand = spec.hand_wheel_deg * RAD_PER_DEG * math.sin(math.tau * frequency_hz * time_s)
        return Intent(hand_wheel_rad=hand, throttle=hold(snapshot), gear=1.0)

    pilot = RunUp(spec.speed_kmh, car.steering_ratio, turn, rolling=False)
    driven = yield Attempt(f"{frequency_hz:g} Hz", pilot, 120.0)
    if pilot.began_tick is None:
        return None
    settled = round(SETTLED_CYCLES / frequency_hz * driven.tick_hz)
    return part(driven, pilot.began_tick - driven.first_tick + settled)
