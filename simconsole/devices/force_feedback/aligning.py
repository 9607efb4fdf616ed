"""The car's torque at the rim, closed over the person's hands and the motor's delay so that a free wheel comes to rest.

Pure kernels. Between the hand wheel and the torque that it causes lie the rack, the tyres' relaxation and the motor.
That lag turns the car's stiffness about the middle into negative damping. So the torque is led by what the car does
not know yet: its own stiffness, times the way of the wheel since the tyres last answered, with the wheel as it will be
when the torque arrives. Damping in proportion to the root of stiffness times inertia then keeps swings short at every
speed. A wheel whose delay is too long for its inertia gets a share of the car's torque only.
"""

from math import sqrt
from typing import Final

from simconsole.devices.force_feedback.force_settings import ForceSettings
from simconsole.values.kernels import clip, kernel
from simconsole.values.units import MPS_PER_KMH

NODE_MPS: Final = 12.0
"""Speed from one figure of the stiffness to the next."""
FAST_MPS: Final = 40.0
"""Speed at which the damping of the car's own weaving is in full force; it grows with speed, as its need does."""
SHARES_KMH: Final = (30.0, 60.0, 90.0, 120.0, 150.0, 180.0, 210.0)
"""Speeds for which people are told how much of the car's torque a wheel bears."""
SLOWEST_MPS: Final = 2.0
"""Below it the tyres' relaxation is taken as at this speed."""


@kernel
def stiffness(speed_mps: float, force: ForceSettings) -> float:
    """Return the car's stiffness about the middle in N m per rad of the hand wheel, straight between its figures."""
    at = clip(speed_mps / NODE_MPS, 0.0, 4.0)
    if at > 3.0:
        return force.rim_48mps_nm_per_rad + (at - 4.0) * (force.rim_48mps_nm_per_rad - force.rim_36mps_nm_per_rad)
    if at > 2.0:
        return force.rim_36mps_nm_per_rad + (at - 3.0) * (force.rim_36mps_nm_per_rad - force.rim_24mps_nm_per_rad)
    if at > 1.0:
        return force.rim_24mps_nm_per_rad + (at - 2.0) * (force.rim_24mps_nm_per_rad - force.rim_12mps_nm_per_rad)
    return force.rim_12mps_nm_per_rad + (at - 1.0) * (force.rim_12mps_nm_per_rad - force.rim_0mps_nm_per_rad)


@kernel
def share_of(stiff: float, fast: float, force: ForceSettings) -> float:
    """Return the share of the car's torque that this wheel can bear without swinging, 0 to 1.

    Damping over inertia, at the stiffness K that is in force, is a x + r x^2 with x = sqrt(K / J). It may be as high as
    the motor's delay allows, which gives the largest x.

    Args:
        stiff: The car's stiffness about the middle, in N m per rad.
        fast: The speed, in shares of FAST_MPS.
        force: Of this drive.
    """
    a = force.aligning_damping
    most = force.rate_loop_per_s
    x_per_s = 2.0 * most / (a + sqrt(a * a + 4.0 * fast * force.return_s * most))
    most_nm_per_rad = force.inertia_kgm2 * x_per_s * x_per_s
    return 1.0 if stiff <= most_nm_per_rad else most_nm_per_rad / stiff


def shares_by_speed(force: ForceSettings) -> tuple[tuple[float, float], ...]:
    """Return the speeds of SHARES_KMH and the share of the car's torque that this wheel bears at each of them."""

    def share(speed_mps: float) -> float:
        rolling = speed_mps / (speed_mps + force.fade_mps)
        return share_of(force.car_share * rolling * stiffness(speed_mps, force), speed_mps / FAST_MPS, force)

    return tuple((speed_kmh, share(speed_kmh * MPS_PER_KMH)) for speed_kmh in SHARES_KMH)


@kernel
def answered(before_rad: float, road_wheel_rad: float, speed_mps: float, force: ForceSettings, tick_s: float) -> float:
    """Return the angle of the hand wheel that the tyres have answered: the rack's, through their relaxation.

    Args:
        before_rad: Of the tick before.
        road_wheel_rad: What the hand wheel contributes to the road wheels' angle, as far as the rack has come.
        speed_mps: At least 0.
        force: Of this drive.
        tick_s: Length of a tick.
    """
    speed = clip(speed_mps, SLOWEST_MPS, 200.0)
    way = road_wheel_rad * force.hand_wheel_per_road_wheel - before_rad
    return before_rad + way * (tick_s / (tick_s + force.relaxation_m / speed))


@kernel
def aligning(
    car_nm: float,
    late_rad: float,
    swing_radps: float,
    rim_radps: float,
    stiff: float,
    fast: float,
    guided: float,
    force: ForceSettings,
) -> float:
    """Return the car's torque, led by what it has not answered yet, and damped, in N m.

    Args:
        car_nm: At the rim of the real car, left-positive.
        late_rad: How far the wheel, when this torque acts, is beyond the angle that caused it.
        swing_radps: The car's yaw rate, less its slow part.
        rim_radps: Rate of the wheel when this torque acts.
        stiff: The car's stiffness about the middle, with the share that is in force, in N m per rad.
        fast: The speed, in shares of FAST_MPS.
        guided: How much of the controller's guidance there is, 0 to 1: it leads the wheel, and damps it itself.
        force: Of this drive.
    """
    damping = force.aligning_damping * sqrt(stiff * force.inertia_kgm2) + fast * force.return_s * stiff
    against_nm = stiff * force.hand_wheel_per_road_wheel * fast * force.yaw_damping_s * swing_radps
    return car_nm - stiff * late_rad - (1.0 - guided) * (against_nm + damping * rim_radps)
