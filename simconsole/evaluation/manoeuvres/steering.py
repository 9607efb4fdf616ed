"""Steady-state circle and step steer: how they are driven, and their values by ISO 4138 and ISO 7401."""

import numpy as np

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.manoeuvre_driver.run_up import RunUp
from simconsole.drivers.speed_holder import SpeedHolder
from simconsole.evaluation.manoeuvres.attempt import Attempt, Driving, Line, Panel, Result, part, traces, undriven
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.profiles.manoeuvre import SteadyCircle, StepSteer
from simconsole.values.platform import Platform
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import DEG_PER_RAD, MPS_PER_KMH, RAD_PER_DEG

LONGEST_STEER_S = 25.0
SMOOTHED_S = 0.5
"""Window of the moving mean over the circle's signals: removes the throttle's ripple, steering is slower."""


def steady_circle(spec: SteadyCircle, car: Platform) -> Driving:
    """Turn the hand wheel slowly at constant speed until the car grips no more (or the wheel is at its stop)."""
    hold = SpeedHolder(spec.speed_kmh * MPS_PER_KMH)

    def turn(snapshot: Snapshot, time_s: float) -> Intent | None:
        hand = spec.hand_wheel_degps * RAD_PER_DEG * time_s
        if time_s > LONGEST_STEER_S or hand > car.max_road_wheel_rad * car.steering_ratio:
            return None
        return Intent(hand_wheel_rad=hand, throttle=hold(snapshot), gear=1.0)

    pilot = RunUp(spec.speed_kmh, car.steering_ratio, turn, rolling=False)
    driven = yield Attempt("steady-state circle", pilot, 120.0)
    if pilot.began_tick is None:
        return undriven("steady-state circle", spec.speed_kmh)
    turned = part(driven, pilot.began_tick - driven.first_tick)
    speed = _smooth(turned, "vehicle.vx_mps")
    lateral = _smooth(turned, "vehicle.ay_mps2")
    hand = _smooth(turned, "driver.hand_wheel_rad") * DEG_PER_RAD
    sideslip = np.arctan2(_smooth(turned, "platform.vy_mps"), _smooth(turned, "platform.vx_mps")) * DEG_PER_RAD
    roll = _smooth(turned, "vehicle.roll_rad") * DEG_PER_RAD
    torque = _smooth(turned, "vehicle.hand_wheel_torque_nm")
    first, last = (int(np.argmax(lateral >= edge)) for edge in (spec.fit_from_mps2, spec.fit_to_mps2))
    steering = _slope(lateral, hand, first, last)
    ackermann = car.wheelbase_m / float(speed[first:last].mean()) ** 2 * DEG_PER_RAD
    values = {
        "steering_wheel_angle_gradient_deg_per_mps2": steering,
        "understeer_gradient_deg_per_mps2": steering / car.steering_ratio - ackermann,
        "sideslip_angle_gradient_deg_per_mps2": _slope(lateral, sideslip, first, last),
        "roll_angle_gradient_deg_per_mps2": _slope(lateral, roll, first, last),
        "steering_wheel_torque_gradient_nm_per_mps2": -_slope(lateral, torque, first, last),
        "highest_lateral_acceleration_mps2": float(lateral.max()),
        "highest_steering_wheel_torque_nm": float(-torque.min()),
        # What a driver feels before the front axle lets go: the torque at the rim falls while grip still grows.
        "share_of_grip_at_highest_torque": float(lateral[int(torque.argmin())] / lateral.max()),
    }
    ends = slice(0, int(np.argmax(lateral)) + 1, 10)
    panels = tuple(
        Panel(title, "lateral acceleration / m/s²", label, (Line("", lateral[ends], signal[ends]),))
        for title, label, signal in (
            ("Steering-wheel angle", "angle / deg", hand),
            ("Sideslip angle", "angle / deg", sideslip),
            ("Roll angle", "angle / deg", roll),
            ("Torque at the rim, against the turn", "torque / N m", -torque),
        )
    )
    return Result(values, panels)


def _smooth(drive: Drive, column: str) -> Array:
    width = max(1, round(SMOOTHED_S * drive.tick_hz)) | 1
    padded = np.pad(drive.column(column), width // 2, mode="edge")
    return np.convolve(padded, np.full(width, 1.0 / width), mode="valid")


def _slope(x: Array, y: Array, first: int, last: int) -> float:
    return float(np.polyfit(x[first:last], y[first:last], 1)[0])


def step_steer(spec: StepSteer, car: Platform) -> Driving:
    """Turn the hand wheel fast, hold it and the throttle."""
    held: list[float] = []

    def step(snapshot: Snapshot, time_s: float) -> Intent | None:
        if not held:
            held.append(snapshot.driver.throttle)
        if time_s > spec.hold_s:
            return None
        hand_deg = min(spec.hand_wheel_deg, spec.hand_wheel_degps * time_s)
        return Intent(hand_wheel_rad=hand_deg * RAD_PER_DEG, throttle=held[0], gear=1.0)

    pilot = RunUp(spec.speed_kmh, car.steering_ratio, step, rolling=False)
    driven = yield Attempt("step steer", pilot, 120.0)
    if pilot.began_tick is None:
        return undriven("step steer", spec.speed_kmh)
    turned = part(driven, pilot.began_tick - driven.first_tick)
    yaw_rate = turned.column("vehicle.yaw_rate_radps")
    lateral = turned.column("vehicle.ay_mps2")
    hand = turned.column("driver.hand_wheel_rad")
    time_s = turned.time_s
    half = _crossing(time_s, hand, 0.5 * hand.max())  # ISO 7401 counts from the half of the step
    steady = slice(-turned.tick_hz // 2, None)
    values = {
        "steady_state_lateral_acceleration_mps2": float(lateral[steady].mean()),
        "steady_state_yaw_rate_gain_per_s": float(yaw_rate[steady].mean() / hand[steady].mean()),
        "yaw_rate_response_time_s": _crossing(time_s, yaw_rate, 0.9 * yaw_rate[steady].mean()) - half,
        "lateral_acceleration_response_time_s": _crossing(time_s, lateral, 0.9 * lateral[steady].mean()) - half,
        "yaw_rate_peak_response_time_s": float(time_s[int(yaw_rate.argmax())]) - half,
        "yaw_rate_overshoot_percent": float((yaw_rate.max() / yaw_rate[steady].mean() - 1.0) * 100.0),
    }
    panels = (
        traces("Steering-wheel angle", "angle / deg", {"": (turned, hand * DEG_PER_RAD)}, 2),
        traces("Yaw rate", "yaw rate / deg/s", {"": (turned, yaw_rate * DEG_PER_RAD)}, 2),
        traces("Lateral acceleration", "acceleration / m/s²", {"": (turned, lateral)}, 2),
    )
    return Result(values, panels)


def _crossing(time_s: Array, values: Array, level: float) -> float:
    """Return when `values` first reach `level`, straight between ticks."""
    at = int(np.argmax(values >= level))
    if at == 0:
        return float(time_s[0])
    share = (level - values[at - 1]) / (values[at] - values[at - 1])
    return float(time_s[at - 1] + share * (time_s[at] - time_s[at - 1]))
