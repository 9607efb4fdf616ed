"""Full throttle from rest: time to 100 km/h and top speed."""

import numpy as np

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.manoeuvre_driver.run_up import SETTLE_S, keep_line
from simconsole.evaluation.manoeuvres.attempt import Attempt, Driving, Result, traces
from simconsole.profiles.manoeuvre import Acceleration
from simconsole.values.platform import Platform
from simconsole.values.signals import Mode
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import KMH_PER_MPS, MPS_PER_KMH

STEADY_MPS = 0.05
"""The top speed is reached where a car gains less than this in STEADY_S."""
STEADY_S = 5.0
LONGEST_S = 240.0


def acceleration(spec: Acceleration, car: Platform) -> Driving:
    """Drive off with the pedal down until the car gains no more."""
    marks: list[tuple[float, float]] = []

    def push(snapshot: Snapshot) -> Intent | None:
        if snapshot.t_s < SETTLE_S or snapshot.arbitration.mode != Mode.MANUAL:
            return Intent()
        speed = snapshot.vehicle.vx_mps
        if not marks or snapshot.t_s >= marks[-1][0] + STEADY_S:
            if marks and speed > 5.0 and speed < marks[-1][1] + STEADY_MPS:
                return None
            marks.append((snapshot.t_s, speed))
        return Intent(hand_wheel_rad=keep_line(snapshot, car.steering_ratio), throttle=1.0, gear=1.0)

    driven = yield Attempt("full throttle", push, LONGEST_S)
    speed = driven.column("vehicle.vx_mps")
    time_s = driven.time_s
    begun = int(np.argmax(speed > 0.1))
    there = np.flatnonzero(speed >= spec.to_kmh * MPS_PER_KMH)
    values = {"top_speed_kmh": float(speed.max() * KMH_PER_MPS)}
    if there.size:
        values["time_s"] = float(time_s[there[0]] - time_s[begun])
    return Result(values, (traces("Speed", "speed / km/h", {"": (driven, speed * KMH_PER_MPS)}, 25),))
