"""Estimate of the person's torque on the wheel: no wheel of this class measures torque. Pure kernels.

A model of the rim turns under the motor's torque and the estimate; where the real wheel deviates from it, the person
is the reason, and the estimate follows (a tracking filter of three states: angle, rate, torque).
"""

from typing import Final, NamedTuple

from simconsole.devices.force_feedback.force_settings import ForceSettings
from simconsole.devices.force_feedback.rim import Rim, turn
from simconsole.values.kernels import clip, kernel

HUMAN_LIMIT_NM: Final = 30.0
"""More than two arms can apply; keeps the estimate finite whatever the wheel reports."""
STUCK_S: Final = 0.3
"""In static friction any torque up to the friction fits: the estimate decays to the smallest that explains rest."""
HANDS_S: Final = 0.12
HANDS_OFF_SHARE: Final = 0.6


class WheelEstimate(NamedTuple):
    """The wheel as estimated after this tick."""

    rad: float
    radps: float
    human_nm: float
    hands_nm: float  # size of the person's torque, smoothed
    hands_on: float


@kernel
def at_rest(hand_wheel_rad: float) -> WheelEstimate:
    """Return the estimate to start with, where nothing is known but the angle."""
    return WheelEstimate(hand_wheel_rad, 0.0, 0.0, 0.0, 0.0)


@kernel
def observe(
    before: WheelEstimate, hand_wheel_rad: float, motor_nm: float, force: ForceSettings, tick_s: float
) -> WheelEstimate:
    """Return the estimate after a tick.

    Args:
        before: The estimate of the tick before.
        hand_wheel_rad: The angle read now.
        motor_nm: The motor's torque over the tick that has passed.
        force: Inertia, friction and the filter's gains; `max_torque_nm` > 0.
        tick_s: Length of a tick.
    """
    rim = turn(
        Rim(before.rad, before.radps),
        motor_nm + before.human_nm,
        force.inertia_kgm2,
        force.motor_damping_nms,
        force.motor_friction_nm,
        tick_s,
    )
    miss_rad = hand_wheel_rad - rim.rad
    human_nm = before.human_nm
    if rim.radps == 0.0:
        human_nm -= human_nm * (tick_s / (tick_s + STUCK_S))
    human_nm = clip(
        human_nm + force.inertia_kgm2 * force.observer_accel_per_s2 * miss_rad, -HUMAN_LIMIT_NM, HUMAN_LIMIT_NM
    )
    hands_nm = before.hands_nm + (abs(human_nm) - before.hands_nm) * (tick_s / (tick_s + HANDS_S))
    limit_nm = force.hands_on_nm * HANDS_OFF_SHARE if before.hands_on > 0.0 else force.hands_on_nm
    return WheelEstimate(
        rim.rad + force.observer_angle * miss_rad,
        rim.radps + force.observer_rate_per_s * miss_rad,
        human_nm,
        hands_nm,
        1.0 if hands_nm > limit_nm else 0.0,
    )
