"""Characteristic values of a scripted drive: launch, stall, hill start, reverse, parking."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.manoeuvres.attempt import Attempt, Driving, Result, part, traces
from simconsole.profiles.manoeuvre import Observed
from simconsole.values.platform import Platform
from simconsole.values.signals import GearFault
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS, RPM_PER_RADPS

JERK_WINDOW_S: Final = 0.05
"""Over which accelerations are averaged before their change counts as a jerk: 20 Hz, more than a body feels."""


def jerks(accel_mps2: NDArray[np.float64], tick_hz: float) -> NDArray[np.float64]:
    """Return the changes of an averaged acceleration per second, m/s3; a single 0 where the drive is too short."""
    count = max(1, round(JERK_WINDOW_S * tick_hz))
    if len(accel_mps2) < count + 1:
        return np.zeros(1)
    return np.diff(np.convolve(accel_mps2, np.full(count, 1.0 / count), "valid")) * tick_hz


def longest(holds: NDArray[np.bool_], tick_hz: float) -> float:
    """Return the time for which something holds without a break, the longest one, in s."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], holds.astype(np.int8), [0]))))
    return float(np.max(edges[1::2] - edges[::2], initial=0) / tick_hz)


def observed(spec: Observed, car: Platform, duration_s: float) -> Driving:
    """Drive the scenario's script and describe the part of it that counts."""
    driven = yield Attempt("script", None, duration_s)
    last = None if spec.until_s is None else round(spec.until_s * driven.tick_hz)
    seen = part(driven, round(spec.from_s * driven.tick_hz), last)
    speed = seen.column("vehicle.vx_mps")
    x = seen.column("vehicle.x_m") - seen.column("vehicle.x_m")[0]
    y = seen.column("vehicle.y_m") - seen.column("vehicle.y_m")[0]
    ax = seen.column("vehicle.ax_mps2")
    engine = seen.column("vehicle.engine_radps") * RPM_PER_RADPS
    running = seen.column("vehicle.engine_running")
    neutral = (seen.column("vehicle.gear") == 0.0) & (seen.column("command.gear") != 0.0)
    values = {
        "highest_speed_mps": float(speed.max()),
        "lowest_speed_mps": float(speed.min()),
        "end_speed_mps": float(speed[-1]),
        "distance_m": float(np.ptp(seen.column("vehicle.distance_m"))),
        "end_displacement_m": float(np.hypot(x[-1], y[-1])),
        "rolled_back_m": float(max(0.0, -x.min())),
        "end_yaw_angle_deg": float(
            (seen.column("vehicle.yaw_rad")[-1] - seen.column("vehicle.yaw_rad")[0]) * DEG_PER_RAD
        ),
        "highest_acceleration_mps2": float(ax.max()),
        "lowest_acceleration_mps2": float(ax.min()),
        "highest_jerk_mps3": float(np.abs(jerks(ax, driven.tick_hz)).max()),
        "lowest_engine_speed_rpm": float(engine.min()),
        "highest_engine_speed_rpm": float(engine.max()),
        "engine_stalled": float((running == 0.0).any()),
        "end_engine_running": float(running[-1]),
        "longest_neutral_s": longest(neutral, driven.tick_hz),  # though a gear is asked for; a shift takes its pause
        "clutch_overheated": float((seen.column("vehicle.gear_fault") >= GearFault.CLUTCH_HOT).any()),
    }
    panels = (
        traces("Speed", "speed / km/h", {"": (seen, speed * KMH_PER_MPS)}),
        traces("Engine", "engine speed / rpm", {"": (seen, engine)}),
        traces("Acceleration along the body", "acceleration / m/s²", {"": (seen, ax)}),
    )
    return Result(values, panels)
