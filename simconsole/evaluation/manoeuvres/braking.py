"""Straight braking and coast-down: how they are driven, and their values."""

import numpy as np

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.manoeuvre_driver.run_up import RunUp, Steps, keep_line
from simconsole.evaluation.manoeuvres.attempt import Attempt, Driving, Line, Panel, Result, part, traces, undriven
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.profiles.manoeuvre import CoastDown, StraightBraking
from simconsole.values.platform import Platform
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS, MPS_PER_KMH, STANDARD_GRAVITY_MPS2

STOPPED_MPS = 0.05
WHEELS = ("fl", "fr", "rl", "rr")
LOCK_FROM_KMH = 10.0
"""Below this speed a locked wheel does not count as locked (as in UN R13-H, annex 6, at 15 km/h)."""


def straight_braking(spec: StraightBraking, car: Platform) -> Driving:
    """Brake from a speed to rest, with ABS and without it; `locked_` values are those without."""

    def brake(snapshot: Snapshot, time_s: float) -> Intent | None:
        if snapshot.vehicle.vx_mps < STOPPED_MPS:
            return None
        return Intent(hand_wheel_rad=keep_line(snapshot, car.steering_ratio), brake=spec.brake)

    values: dict[str, float] = {}
    panels: dict[str, tuple[Drive, Array]] = {}
    offsets: list[Line] = []
    for name, off, prefix in (("with ABS", (), ""), ("without ABS", ("anti_lock",), "locked_")):
        if off and not spec.without:
            break
        pilot = RunUp(spec.speed_kmh, car.steering_ratio, brake, most=0.5)
        driven = yield Attempt(name, pilot, 120.0, off)
        if pilot.began_tick is None:
            return undriven(name, spec.speed_kmh)
        braked = part(driven, pilot.began_tick - driven.first_tick)
        values |= {f"{prefix}{key}": value for key, value in _stop(braked, spec.speed_kmh).items()}
        panels[name] = braked, braked.column("vehicle.vx_mps") * KMH_PER_MPS
        x = braked.column("vehicle.x_m")
        offsets.append(Line(name, (x - x[0])[::5], braked.column("vehicle.y_m")[::5]))
    if spec.without:
        values["shortened_by_anti_lock_m"] = values["locked_stopping_distance_m"] - values["stopping_distance_m"]
    path = Panel("Way of base_link", "distance / m", "to the left / m", tuple(offsets))
    return Result(values, (traces("Speed", "speed / km/h", panels), path))


def _stop(drive: Drive, speed_kmh: float) -> dict[str, float]:
    """Return the values of one stop; the distance is corrected to the nominal speed by its square (ISO 21994)."""
    speed = drive.column("vehicle.vx_mps")
    way = drive.column("vehicle.distance_m") - drive.column("vehicle.distance_m")[0]
    nominal = speed_kmh * MPS_PER_KMH
    at_80, at_10 = (int(np.argmax(speed <= share * speed[0])) for share in (0.8, 0.1))
    developed = (speed[at_80] ** 2 - speed[at_10] ** 2) / (2.0 * (way[at_10] - way[at_80]))
    return {
        "stopping_distance_m": float(way[-1] * (nominal / speed[0]) ** 2),
        "stopping_time_s": drive.ticks / drive.tick_hz,
        "mean_fully_developed_deceleration_mps2": float(developed),
        "pitch_angle_gradient_deg_per_g": _pitch_gradient(drive, at_80, at_10),
        "lowest_wheel_speed_share": _wheel_share(drive),
        "largest_offset_m": float(np.abs(drive.column("vehicle.y_m")).max()),
        "largest_yaw_angle_deg": float(np.abs(drive.column("vehicle.yaw_rad")).max() * DEG_PER_RAD),
    }


def _pitch_gradient(drive: Drive, first: int, last: int) -> float:
    """Return the mean pitch, positive nose down, over the mean deceleration between two ticks."""
    pitch = drive.column("vehicle.pitch_rad")[first:last].mean() * DEG_PER_RAD
    return float(-pitch / drive.column("vehicle.ax_mps2")[first:last].mean() * STANDARD_GRAVITY_MPS2)


def _wheel_share(drive: Drive) -> float:
    """Return the slowest wheel's spin as a share of what it had in proportion when the brakes came on.

    0: a wheel locked above LOCK_FROM_KMH.
    """
    speed = drive.column("vehicle.vx_mps")
    fast = speed > LOCK_FROM_KMH * MPS_PER_KMH
    shares = []
    for wheel in WHEELS:
        spin = drive.column(f"platform.{wheel}_radps")
        shares.append((spin[fast] / spin[0] / (speed[fast] / speed[0])).min())
    return float(min(shares))


def coast_down(spec: CoastDown, car: Platform) -> Driving:
    """Roll out of gear from one speed to another."""
    end_mps = spec.to_kmh * MPS_PER_KMH

    def roll(snapshot: Snapshot, time_s: float) -> Intent | None:
        return None if snapshot.vehicle.vx_mps < end_mps else Intent(hand_wheel_rad=keep_line(snapshot, ratio))

    ratio = car.steering_ratio
    steps: Steps = roll
    pilot = RunUp(spec.from_kmh, ratio, steps)
    driven = yield Attempt("coast-down", pilot, 600.0)
    if pilot.began_tick is None:
        return undriven("coast-down", spec.from_kmh)
    rolled = part(driven, pilot.began_tick - driven.first_tick)
    speed = rolled.column("vehicle.vx_mps")
    time_s = rolled.time_s
    slope = np.gradient(speed, time_s)
    # F = c0 + c2 v^2 over mass: the road-load coefficients that a coast-down is driven for.
    quadratic, constant = np.polyfit(speed[50:-50] ** 2, -slope[50:-50], 1)
    values = {
        "coast_down_time_s": float(time_s[-1] - time_s[0]),
        "coast_down_distance_m": float(np.ptp(rolled.column("vehicle.distance_m"))),
        "road_load_constant_mps2": float(constant),
        "road_load_quadratic_per_m": float(quadratic),
    }
    return Result(values, (traces("Speed", "speed / km/h", {"coast-down": (rolled, speed * KMH_PER_MPS)}, 25),))
