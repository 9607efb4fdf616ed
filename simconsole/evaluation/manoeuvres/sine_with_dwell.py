"""Sine with dwell (FMVSS 126): stability and responsiveness from 1.5 A to 270 deg, with ESC and once without."""

import math
from collections.abc import Generator
from typing import NamedTuple

import numpy as np

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.manoeuvre_driver.run_up import RunUp, Steps
from simconsole.evaluation.manoeuvres.attempt import Attempt, Driving, Result, part, traces, undriven
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.profiles.manoeuvre import SineWithDwell
from simconsole.values.platform import Platform
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import DEG_PER_RAD, RAD_PER_DEG, STANDARD_GRAVITY_MPS2

SLOW_DEGPS = 13.5
A_MPS2 = 0.3 * STANDARD_GRAVITY_MPS2
WATCHED_S = 1.75
"""Time after completion of steer up to which the car is evaluated."""
DISPLACED_S = 1.07
RESPONSIVE_FROM = 5.0
"""Multiple of A from which on the displacement is evaluated."""


class Turn(NamedTuple):
    """The evaluated values of one sine."""

    ratio_100: float  # yaw rate 1.00 s after completion of steer, as a share of its second peak
    ratio_175: float
    displacement_m: float  # of the centre of gravity, 1.07 s after the beginning of steer


def sine_with_dwell(spec: SineWithDwell, car: Platform) -> Driving:
    """Find A by slowly increasing steer, then turn ever further, the last time without stability control."""
    pilot = RunUp(spec.speed_kmh, car.steering_ratio, _slowly)
    driven = yield Attempt("slowly increasing steer", pilot, 120.0)
    if pilot.began_tick is None:
        return undriven("slowly increasing steer", spec.speed_kmh)
    a_deg = _angle_for_a(part(driven, pilot.began_tick - driven.first_tick))
    # FMVSS 126 S7.9.4: up to 6.5 A, or 270 deg where 6.5 A is less, and no further than 300 deg.
    angles = [min(factor * a_deg, 300.0) for factor in spec.factors]
    angles += [spec.final_hand_wheel_deg] if angles[-1] < spec.final_hand_wheel_deg else []
    turns: list[Turn] = []
    shown: dict[str, tuple[Drive, Array]] = {}
    for angle in angles:
        turned = yield from _sine(spec, car, angle, ())
        if turned is None:
            return undriven(f"{angle:.0f} deg", spec.speed_kmh)
        turns.append(_judge(spec, turned))
        shown[f"{angle:.0f} deg"] = turned, turned.column("vehicle.yaw_rate_radps") * DEG_PER_RAD
    without = spec.without_factor * a_deg
    turned = yield from _sine(spec, car, without, ("stability_control",))
    if turned is None:
        return undriven(f"{without:.0f} deg", spec.speed_kmh)
    alone = _judge(spec, turned)
    name = f"{without:.0f} deg without ESC"
    far = [turn for turn, angle in zip(turns, angles, strict=True) if angle >= RESPONSIVE_FROM * a_deg]
    values = {
        "a_deg": a_deg,
        "largest_steering_wheel_angle_deg": angles[-1],
        "yaw_rate_ratio_100": max(turn.ratio_100 for turn in turns),
        "yaw_rate_ratio_175": max(turn.ratio_175 for turn in turns),
        "least_lateral_displacement_m": min(turn.displacement_m for turn in far),
        "without_esc_yaw_rate_ratio_100": alone.ratio_100,
        "without_esc_yaw_rate_ratio_175": alone.ratio_175,
    }
    shown = {label: shown[label] for label in list(shown)[-3:]} | {
        name: (turned, turned.column("vehicle.yaw_rate_radps") * DEG_PER_RAD)
    }
    hands = {label: (drive, drive.column("driver.hand_wheel_rad") * DEG_PER_RAD) for label, (drive, _) in shown.items()}
    return Result(values, (traces("Yaw rate", "deg/s", shown, 2), traces("Steering-wheel angle", "deg", hands, 2)))


def wave(spec: SineWithDwell, time_s: float) -> float:
    """Return the steering input -1 to 1: a sine whose second peak is held for the dwell."""
    held = 0.75 / spec.frequency_hz
    if time_s < held:
        return math.sin(math.tau * spec.frequency_hz * time_s)
    if time_s < held + spec.dwell_s:
        return -1.0
    return math.sin(math.tau * spec.frequency_hz * (time_s - spec.dwell_s)) if time_s < completion_s(spec) else 0.0


def completion_s(spec: SineWithDwell) -> float:
    """Return when the steering is back at the middle."""
    return 1.0 / spec.frequency_hz + spec.dwell_s


def _slowly(snapshot: Snapshot, time_s: float) -> Intent | None:
    if abs(snapshot.vehicle.ay_mps2) > 1.2 * A_MPS2:
        return None
    return Intent(hand_wheel_rad=SLOW_DEGPS * RAD_PER_DEG * time_s)


def _angle_for_a(drive: Drive) -> float:
    """Return the hand-wheel angle in deg that gives 0.3 g, by a line through 0.1 to 0.375 g (S7.6.1 of the rule)."""
    lateral = np.abs(drive.column("vehicle.ay_mps2"))
    hand = drive.column("driver.hand_wheel_rad") * DEG_PER_RAD
    used = (lateral > 0.1 * STANDARD_GRAVITY_MPS2) & (lateral < 0.375 * STANDARD_GRAVITY_MPS2)
    slope, start = np.polyfit(lateral[used], hand[used], 1)
    return float(slope * A_MPS2 + start)


def _sine(
    spec: SineWithDwell, car: Platform, hand_deg: float, off: tuple[str, ...]
) -> Generator[Attempt, Drive, Drive | None]:
    """Drive one sine; return it from the beginning of steer."""

    def steer(snapshot: Snapshot, time_s: float) -> Intent | None:
        if time_s > completion_s(spec) + WATCHED_S + 0.02:
            return None
        return Intent(hand_wheel_rad=hand_deg * RAD_PER_DEG * wave(spec, time_s))

    steps: Steps = steer
    pilot = RunUp(spec.speed_kmh, car.steering_ratio, steps)
    driven = yield Attempt(f"{hand_deg:.0f} deg", pilot, 120.0, off)
    return None if pilot.began_tick is None else part(driven, pilot.began_tick - driven.first_tick)


def _judge(spec: SineWithDwell, drive: Drive) -> Turn:
    """Return the evaluated values; the second peak is the largest yaw rate after the steering has changed its side."""
    yaw_rate = np.abs(drive.column("vehicle.yaw_rate_radps"))
    second = slice(round(0.5 / spec.frequency_hz * drive.tick_hz), round(completion_s(spec) * drive.tick_hz))
    peak = float(yaw_rate[second].max())
    at_100, at_175 = (round((completion_s(spec) + later) * drive.tick_hz) for later in (1.0, WATCHED_S))
    at = round(DISPLACED_S * drive.tick_hz)
    y, yaw = drive.column("vehicle.y_m"), drive.column("vehicle.yaw_rad")
    # The platform's own velocity is that of the centre of gravity, the vehicle's that of base_link.
    apart = drive.column("platform.vy_mps") - drive.column("vehicle.vy_mps")
    ahead = apart[at] / drive.column("vehicle.yaw_rate_radps")[at]
    moved = y[at] + ahead * math.sin(yaw[at]) - y[0] - ahead * math.sin(yaw[0])
    return Turn(float(yaw_rate[at_100]) / peak, float(yaw_rate[at_175]) / peak, abs(float(moved)))
