"""Steering: the rack follows the command, turned a little by its tyres; the rim feels them with assistance."""

from math import sqrt
from typing import NamedTuple

from simconsole.values.kernels import approach, clip, kernel
from simconsole.values.trigonometry import direction
from simconsole.vehicle.car.parameters import SteeringParameters
from simconsole.vehicle.car.state import SteeringState
from simconsole.vehicle.car.tyre import PEAK_DEMAND

ROLLING_MPS = 0.5
"""Rolling speed around which the pneumatic trail gets its direction: behind the wheel's centre as it rolls."""
FULL_TWIST_RAD = 0.2
"""Twist at which a contact patch slides around altogether: steered on the spot a tyre has most of its moment from some
8 deg on (Sharp and Granger, On car steering torques at parking speeds, Proc. IMechE D 217, 2003)."""
TWIST_LENGTH_M = 0.06
"""Way over which rolling replaces a twisted contact patch: half its length, the mean way since its rubber was laid."""


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
def patch_twist(twist_rad: float, turned_rad: float, rolled_m: float) -> float:
    """Return the twist of the front wheels against their contact patches after they turned over the ground and rolled.

    The same law as that of a tyre's deflection (tyre.py): a spring at rest that slides at its end, a relaxation in
    motion, where u / TWIST_LENGTH_M becomes the turn slip of Pacejka (Tyre and Vehicle Dynamics, chapter 9).
    """
    twist = (twist_rad + turned_rad) / (1.0 + rolled_m * (1.0 / TWIST_LENGTH_M))
    return clip(twist, -FULL_TWIST_RAD, FULL_TWIST_RAD)


@kernel
def turn_slip_moment(p: SteeringParameters, twist_rad: float, held_n: float, demand: float) -> float:
    """Return the moment about the kingpin in N m, left-positive, of one tyre's twisted contact patch.

    It grows to Gough's moment of a wheel turned on the spot, friction * load^1.5 / (3 * sqrt(inflation)), `held_n`
    being friction times load; a patch that slides along has no hold to twist against.
    """
    share = twist_rad * (1.0 / FULL_TWIST_RAD)
    held = clip(1.0 - demand * (1.0 / PEAK_DEMAND), 0.0, 1.0)
    return -p.turn_slip_arm_m * held_n * held * share * (2.0 - abs(share))


@kernel
def rim_friction(p: SteeringParameters, share: float, turned_rad: float) -> float:
    """Return the share of the dry friction after the rack turned: Dahl's model, exact at any step.

    It grows like a spring to the full friction and keeps what it has at rest: hysteresis at any speed of turning, as
    measured steerings have it (Pfeffer, Harrer, Johnston, Vehicle System Dynamics 46, 2008).
    """
    way = turned_rad * p.per_friction_rad
    return (share - way) / (1.0 + abs(way))


@kernel
def hand_wheel_torque(
    p: SteeringParameters, moment_nm: float, road_wheel_radps: float, speed_mps: float, friction_share: float
) -> float:
    """Return the torque at the rim in N m, left-positive.

    About the centre the assistance leaves the tyres' torque as it is; around `assist_nm` it comes in and leaves a share
    of what is more, a smaller one at low speed (the boost curves of Badawy et al., SAE 1999-01-0399); towards the most
    torque it takes nearly all.
    """
    torque = moment_nm * p.per_ratio
    left = p.unassisted_share + p.unassisted_share_per_mps * clip(abs(speed_mps), 0.0, 50.0)
    carried = torque * (left + (1.0 - left) / (1.0 + abs(torque) * p.per_assist_nm))
    bent = carried / (1.0 + abs(carried) * p.per_hand_torque_most_nm)
    return bent - p.hand_damping_nms * road_wheel_radps + p.hand_friction_nm * friction_share
