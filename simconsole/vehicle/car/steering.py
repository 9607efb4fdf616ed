"""Steering: the road wheels follow the command with lag and limits; the rim feels the front tyres."""

from simconsole.kernels import approach, clip, kernel
from simconsole.vehicle.car.parameters import BodyParameters

ROLLING_MPS = 0.5
"""Rolling speed around which the pneumatic trail gets its direction: behind the wheel's centre as it rolls."""


@kernel
def steer(p: BodyParameters, road_wheel_rad: float, command_rad: float, step_s: float) -> float:
    """Return the road-wheel angle after one step: a first-order lag (implicit), its rate and its angle limited."""
    target = clip(command_rad, -p.max_road_wheel_rad, p.max_road_wheel_rad)
    wanted = road_wheel_rad + (target - road_wheel_rad) * (step_s / (p.steering_lag_s + step_s))
    return approach(road_wheel_rad, wanted, p.steering_radps * step_s)


@kernel
def hand_wheel_torque(
    p: BodyParameters, force_y_n: float, grip: float, rolling_mps: float, road_wheel_radps: float
) -> float:
    """Return the torque at the rim in N m, left-positive, with assistance.

    Lateral force times trail. The pneumatic trail shrinks as the contact patch slides (brush model: to 0 at full
    sliding), which is what a driver feels before the front axle lets go, and lies on the other side when reversing.
    """
    pneumatic = p.pneumatic_trail_m * grip * rolling_mps / (abs(rolling_mps) + ROLLING_MPS)
    return -p.hand_torque_gain * force_y_n * (p.caster_trail_m + pneumatic) - p.hand_damping_nms * road_wheel_radps
