"""Steering: the rack follows the command, turned a little by its tyres; the rim feels them with assistance."""

from math import sqrt
from typing import NamedTuple

from simconsole.values.kernels import approach, clip, kernel
from simconsole.values.trigonometry import direction
from simconsole.vehicle.car.parameters import SteeringParameters
from simconsole.vehicle.car.state import SteeringState

ROLLING_MPS = 0.5
"""Rolling speed around which the pneumatic trail gets its direction: behind the wheel's centre as it rolls."""
SLOW_RADPS = 0.01
"""Road-wheel rate around which the friction at the rim gets its direction."""


class WheelDirections(NamedTuple):
    """Cosine and sine of both front wheels' angles."""

    left_cos: float
    left_sin: float
    right_cos: float
    right_sin: float


@kernel
def rack_rate(p: SteeringParameters, rack: SteeringState, command_rad: float, moment_nm: float) -> float:
    """Return the rate of the rack in road-wheel rad/s after one step.

    A critically damped second-order rack (implicit, stable at any stiffness) whose dry friction holds it exactly
    where it is as long as the deviation is below `friction_rad`. The tyres' moment turns it through its compliance.
    """
    target = clip(command_rad + p.compliance_rad_per_nm * moment_nm, -p.max_road_wheel_rad, p.max_road_wheel_rad)
    rate = (rack.road_wheel_radps + p.rack_pull_radps * (target - rack.road_wheel_rad)) * p.rack_ease
    held = p.rack_pull_radps * p.friction_rad * p.rack_ease
    return clip(approach(rate, 0.0, held), -p.rate_radps, p.rate_radps)


@kernel
def wheel_directions(p: SteeringParameters, mean_rad: float) -> WheelDirections:
    """Return where the front wheels point: the inner one further, cot(left) - cot(right) = -track / wheelbase."""
    mean = direction(mean_rad)
    c = mean.cos
    s = mean.sin
    left = c - p.ackermann * s
    right = c + p.ackermann * s
    per_left = 1.0 / sqrt(left * left + s * s)
    per_right = 1.0 / sqrt(right * right + s * s)
    return WheelDirections(left * per_left, s * per_left, right * per_right, s * per_right)


@kernel
def aligning_moment(p: SteeringParameters, force_y_n: float, demand: float, rolling_mps: float) -> float:
    """Return the moment about the kingpin in N m, left-positive, of one tyre's side force.

    The pneumatic trail shrinks as the contact patch slides, which is what a driver feels before the front axle lets
    go, and lies on the other side when reversing.
    """
    pneumatic = p.pneumatic_trail_m * clip(1.0 - demand * p.per_trail_end, 0.0, 1.0)
    return -force_y_n * (p.caster_trail_m + pneumatic * rolling_mps / (abs(rolling_mps) + ROLLING_MPS))


@kernel
def hand_wheel_torque(p: SteeringParameters, moment_nm: float, road_wheel_radps: float, speed_mps: float) -> float:
    """Return the torque at the rim in N m, left-positive: the more torque, the smaller the share that is left."""
    carried = (p.hand_torque_gain + p.hand_torque_gain_per_mps * clip(abs(speed_mps), 0.0, 50.0)) * moment_nm
    bent = carried / (1.0 + abs(carried) * p.per_hand_torque_most_nm)
    dry = p.hand_friction_nm * road_wheel_radps / (abs(road_wheel_radps) + SLOW_RADPS)
    return bent - p.hand_damping_nms * road_wheel_radps - dry
