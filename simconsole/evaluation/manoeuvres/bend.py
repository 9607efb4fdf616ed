"""Braking in a bend (ISO 7975) and power-off in a bend (ISO 9816): a steady circle, then the steering held."""

import math
from collections.abc import Generator

import numpy as np

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.manoeuvre_driver.run_up import RunUp
from simconsole.drivers.speed_holder import SpeedHolder
from simconsole.evaluation.manoeuvres.attempt import Attempt, Driving, Result, part, traces, undriven
from simconsole.evaluation.metrics.table import Drive
from simconsole.profiles.manoeuvre import BendBraking, LiftOff
from simconsole.values.platform import Platform
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import DEG_PER_RAD

SETTLING_S = 8.0
"""On the circle before the steering is held: five of the slowest time constants of driver and car."""
RADIUS_PER_S = 0.6
WATCHED_S = 1.5
JUDGED_S = 1.0
BRAKES = (0.08, 0.5)
"""Pedals between which that for the wanted deceleration is looked for, by halving."""
TRIES = 6


def bend_braking(spec: BendBraking, car: Platform) -> Driving:
    """Find the pedal for the deceleration by halving; the last drive is judged."""
    low, high = BRAKES
    driven = None
    for _ in range(TRIES):
        pedal = 0.5 * (low + high)
        driven = yield from _held(spec, car, pedal)
        if driven is None:
            return undriven("braking in a bend", _kmh(spec))
        if _deceleration(driven) < spec.deceleration_mps2:
            low = pedal
        else:
            high = pedal
    assert driven is not None
    return _judged(driven)


def lift_off(spec: LiftOff, car: Platform) -> Driving:
    """Release the throttle, in gear."""
    driven = yield from _held(spec, car, 0.0)
    return undriven("lift-off", _kmh(spec)) if driven is None else _judged(driven)


def _kmh(spec: BendBraking | LiftOff) -> float:
    return 3.6 * math.sqrt(spec.radius_m * spec.lateral_mps2)


def _deceleration(driven: Drive) -> float:
    speed = driven.column("vehicle.vx_mps")
    ends = round(0.3 * driven.tick_hz), round(JUDGED_S * driven.tick_hz)  # the pressure is there after 0.3 s
    return float((speed[ends[0]] - speed[ends[1]]) * driven.tick_hz / (ends[1] - ends[0]))


def _judged(driven: Drive) -> Result:
    """Return the values: the yaw rate over that of the same radius at the present speed."""
    speed = driven.column("vehicle.vx_mps")
    rate = driven.column("vehicle.yaw_rate_radps")
    ratio = rate / rate[0] * speed[0] / speed
    second = round(JUDGED_S * driven.tick_hz)
    slip = np.arctan2(driven.column("platform.vy_mps"), driven.column("platform.vx_mps")) * DEG_PER_RAD
    values = {
        "lateral_acceleration_before_mps2": float(driven.column("vehicle.ay_mps2")[0]),
        "mean_deceleration_mps2": _deceleration(driven),
        "yaw_rate_ratio_at_1_s": float(ratio[second]),
        "highest_yaw_rate_ratio": float(ratio[: second + 1].max()),
        "largest_change_of_sideslip_deg": float(np.abs(slip[: second + 1] - slip[0]).max()),
    }
    return Result(values, (traces("Yaw rate over that of the radius", "ratio", {"": (driven, ratio)}, 2),))


def _held(spec: BendBraking | LiftOff, car: Platform, pedal: float) -> Generator[Attempt, Drive, Drive | None]:
    """Return the drive from the moment on at which the steering is held; None: the car does not get to the speed."""
    speed_mps = math.sqrt(spec.radius_m * spec.lateral_mps2)
    hold = SpeedHolder(speed_mps)
    road_wheel = [car.wheelbase_m / spec.radius_m]

    def turn(snapshot: Snapshot, time_s: float) -> Intent | None:
        seen = snapshot.vehicle
        if time_s > SETTLING_S + WATCHED_S:
            return None
        if time_s >= SETTLING_S:
            return Intent(hand_wheel_rad=road_wheel[0] * car.steering_ratio, brake=pedal, gear=1.0)
        missing = seen.vx_mps / spec.radius_m - seen.yaw_rate_radps  # of the yaw rate that the radius needs
        eased = min(1.0, time_s)
        road_wheel[0] += eased * RADIUS_PER_S * missing / snapshot.tick_hz
        return Intent(hand_wheel_rad=eased * road_wheel[0] * car.steering_ratio, throttle=hold(snapshot), gear=1.0)

    pilot = RunUp(3.6 * speed_mps, car.steering_ratio, turn, rolling=False)
    driven = yield Attempt(f"bend, brake {pedal:.2f}", pilot, 120.0)
    if pilot.began_tick is None:
        return None
    return part(driven, pilot.began_tick - driven.first_tick + round(SETTLING_S * driven.tick_hz))
