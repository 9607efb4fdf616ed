"""What the simulated person is able to do: keep to a line, hold a speed, let the clutch bite. Pure."""

import math
from typing import Final, NamedTuple

from simconsole.profiles.person import Habits
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import RADPS_PER_RPM, RPM_PER_RADPS

SPEED_GAIN_PER_MPS: Final = 0.3
SPEED_INTEGRAL_PER_M: Final = 0.05
SPEED_NEAR_MPS: Final = 2.0
"""Only this near to the wanted speed does the foot learn what holds it."""

BITE_FROM: Final = 0.8
"""Clutch pedals transmit nothing above this: the foot may be quick until there."""
HOLD_RPM: Final = 1250.0
"""Where a foot stops letting the clutch up in a launch: faster engine, further up; slower engine, back down."""
SENSE_RPM: Final = 250.0
ALARM: Final = -6.0
"""How much quicker than up the foot goes down before the engine dies."""
LAUNCH_GAIN_S: Final = 0.006
LAUNCH_THROTTLE: Final = 0.2


class View(NamedTuple):
    """What the person sees and feels in one tick."""

    time_s: float
    x_m: float
    y_m: float
    yaw_rad: float
    speed_mps: float
    distance_m: float
    engine_radps: float
    engine_running: float
    gear: float  # in the gearbox
    mode: float


class Line(NamedTuple):
    """The lane a person keeps to: the straight through a pose."""

    x_m: float
    y_m: float
    yaw_rad: float


def view_of(snapshot: Snapshot) -> View:
    """Return what a snapshot shows."""
    vehicle = snapshot.vehicle
    return View(
        time_s=snapshot.t_s,
        x_m=vehicle.x_m,
        y_m=vehicle.y_m,
        yaw_rad=vehicle.yaw_rad,
        speed_mps=vehicle.vx_mps,
        distance_m=vehicle.distance_m,
        engine_radps=vehicle.engine_radps,
        engine_running=vehicle.engine_running,
        gear=vehicle.gear,
        mode=snapshot.arbitration.mode,
    )


def steer_along(line: Line, view: View, habits: Habits) -> float:
    """Return the hand-wheel angle in rad that leads back to the line.

    Pure pursuit: the arc from base_link to the point of the line a look-ahead distance on (Coulter, Implementation of
    the Pure Pursuit Path Tracking Algorithm, CMU-RI-TR-92-01), through the car's Ackermann angle.
    """
    dx, dy = view.x_m - line.x_m, view.y_m - line.y_m
    offset_m = dy * math.cos(line.yaw_rad) - dx * math.sin(line.yaw_rad)
    heading_rad = math.remainder(view.yaw_rad - line.yaw_rad, math.tau)
    ahead_m = max(habits.look_ahead_min_m, abs(view.speed_mps) * habits.look_ahead_s)
    angle_rad = math.atan2(-offset_m, ahead_m) - heading_rad
    curvature_per_m = 2.0 * math.sin(angle_rad) / math.hypot(ahead_m, offset_m)
    return math.atan(habits.wheelbase_m * curvature_per_m) * habits.steering_ratio


def hold_speed(target_mps: float, speed_mps: float, integral: float, tick_s: float, most: float) -> tuple[float, float]:
    """Return (throttle, integral) of a patient PI foot; the integral rests while the pedal is at an end."""
    missing_mps = target_mps - speed_mps
    throttle = SPEED_GAIN_PER_MPS * missing_mps + integral
    if 0.0 < throttle < most and abs(missing_mps) < SPEED_NEAR_MPS:
        integral += SPEED_INTEGRAL_PER_M * missing_mps * tick_s
    return min(most, max(0.0, throttle)), min(most, max(0.0, integral))


def launch_throttle(view: View, habits: Habits) -> float:
    """Return the throttle that keeps the engine near the launch speed while the clutch bites."""
    missing_radps = habits.launch_rpm * RADPS_PER_RPM - view.engine_radps
    return min(habits.throttle_max, max(0.0, LAUNCH_THROTTLE + LAUNCH_GAIN_S * missing_radps))


def clutch_through_bite(foot: float, view: View, habits: Habits, tick_s: float) -> float:
    """Return the clutch pedal one tick later: up while the engine runs freely, held or pressed when it labours."""
    ease = (view.engine_radps * RPM_PER_RADPS - HOLD_RPM) / SENSE_RPM
    if foot > BITE_FROM and ease > 0.0:
        return foot - habits.foot_per_s * tick_s
    up = habits.bite_release_per_s * min(1.0, max(ALARM, ease)) * tick_s
    return min(1.0, max(0.0, foot - up))
