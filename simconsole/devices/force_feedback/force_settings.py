"""A profile's force feedback as plain numbers for the kernels. Pure."""

import math
from typing import Final, NamedTuple

from simconsole.profiles.device import CockpitProfile
from simconsole.values.platform import NO_STIFFNESS, RimStiffness
from simconsole.values.units import MPS_PER_KMH, RAD_PER_DEG

PIPE_CELLS: Final = 6
RATE_PHASE: Final = 2.0
"""Damping over inertia, times all delay of the motor, up to which the prediction holds where figures are 10 % off."""
ALIGNING_DAMPING: Final = 2.3
"""Damping of a wheel that is let go of, in shares of the root of the car's stiffness times the wheel's inertia."""
RETURN_S: Final = 0.14
"""Time by which the wheel follows its middle later than the car's own weaving, which steers it, at 40 m/s."""
YAW_DAMPING_S: Final = 0.12
"""Road-wheel angle by which the rim's torque is asked to steer against a quick change of the yaw rate, at 40 m/s."""
YAW_SLOW_S: Final = 0.1
"""Changes of the yaw rate that are slower are driving, not weaving."""
OBSERVER_RADPS: Final = 50.0
"""Bandwidth of the torque estimate: settles in about 3 / 50 s, well above what arms do (5 Hz)."""


class ForceSettings(NamedTuple):
    """The settings of the wheel's motor; `max_torque_nm` 0: there is none."""

    max_torque_nm: float
    inertia_kgm2: float
    motor_damping_nms: float
    motor_friction_nm: float
    motor_lag_share: float  # of the way to the commanded torque that the motor comes in one tick
    pipe_cells: float  # of its delay; 0: torque acts at once
    pipe_share: float  # of the way from cell to cell in one tick
    pipe_cell_s: float
    car_share: float
    centring_spring_nm_per_rad: float  # 0 where the car's own tyres pull the wheel to the middle
    centring_spring_most_nm: float
    damping_nms: float
    friction_nm: float
    standstill_friction_nm: float
    fade_mps: float
    texture_nm: float
    end_stop_rad: float
    end_stop_nm_per_rad: float
    servo_nm_per_rad: float
    servo_damping_nms: float
    guide_support: float
    guide_feedback: float
    guide_authority_nm_per_rad: float
    guide_stiffness_nm_per_rad: float
    guide_damping_nms: float
    guide_slow_s: float
    guide_most_nm: float
    hand_wheel_per_road_wheel: float
    ramp_per_tick: float
    slew_nm: float  # per tick
    soft_clip_from: float
    observer_angle: float
    observer_rate_per_s: float
    observer_accel_per_s2: float
    resting_hands_nm: float
    hands_on_nm: float
    rim_0mps_nm_per_rad: float  # stiffness about the middle, at the hand wheel, by speed: the car's, or the spring's
    rim_12mps_nm_per_rad: float
    rim_24mps_nm_per_rad: float
    rim_36mps_nm_per_rad: float
    rim_48mps_nm_per_rad: float
    relaxation_m: float  # of its tyres
    rate_loop_per_s: float  # damping over inertia that this motor's delay bears
    aligning_damping: float  # times the root of stiffness times inertia
    return_s: float
    yaw_damping_s: float
    yaw_slow_s: float


NO_FORCE: Final = ForceSettings(*(0.0,) * len(ForceSettings._fields))
"""A wheel without a motor."""


def force_settings(
    profile: CockpitProfile,
    steering_ratio: float,
    max_road_wheel_rad: float,
    tick_hz: int,
    rim: RimStiffness = NO_STIFFNESS,
) -> ForceSettings:
    """Return the force feedback of a cockpit on a vehicle; `NO_FORCE` where the profile has none."""
    force = profile.force_feedback
    if force is None:
        return NO_FORCE
    tick_s = 1.0 / tick_hz
    own_lock_rad = (0.5 * profile.wheel.lock_to_lock_deg - force.end_stop_margin_deg) * RAD_PER_DEG
    # Critically damped tracking filter of three states (fading memory, three equal poles): Zarchan, Musoff,
    # Fundamentals of Kalman Filtering, chapter 3.
    delay_s = force.motor.delay_s + max(0.0, 0.5 * (1.0 / force.update_hz - tick_s))
    cells = min(PIPE_CELLS, round(delay_s * tick_hz))
    pole = math.exp(-OBSERVER_RADPS * tick_s)
    spring = 0.0 if rim.pulls else force.centring_spring_nm_per_rad
    weaves = 0.0 if spring else 1.0  # the middle of a spring stands still, however the car turns
    return ForceSettings(
        max_torque_nm=force.max_torque_nm,
        inertia_kgm2=force.motor.inertia_kgm2,
        motor_damping_nms=force.motor.damping_nms,
        motor_friction_nm=force.motor.friction_nm,
        motor_lag_share=tick_s / (tick_s + force.motor.delay_s),
        pipe_cells=float(cells),
        pipe_share=cells * tick_s / delay_s if cells else 1.0,
        pipe_cell_s=delay_s / cells if cells else 0.0,
        car_share=force.car_share,
        centring_spring_nm_per_rad=spring,
        centring_spring_most_nm=force.centring_spring_most_nm,
        damping_nms=force.damping_nms,
        friction_nm=force.friction_nm,
        standstill_friction_nm=force.standstill_friction_nm,
        fade_mps=force.fade_kmh * MPS_PER_KMH,
        texture_nm=force.road_texture_nm,
        end_stop_rad=min(own_lock_rad, max_road_wheel_rad * steering_ratio),
        end_stop_nm_per_rad=force.end_stop_nm_per_rad,
        servo_nm_per_rad=force.servo_nm_per_rad,
        servo_damping_nms=force.servo_damping_nms,
        guide_support=force.guidance.support,
        guide_feedback=force.guidance.feedback,
        guide_authority_nm_per_rad=force.guidance.authority_nm_per_rad,
        guide_stiffness_nm_per_rad=force.guidance.stiffness_nm_per_rad,
        guide_damping_nms=force.guidance.damping_nms,
        guide_slow_s=force.guidance.slow_s,
        guide_most_nm=force.guidance.most_nm,
        hand_wheel_per_road_wheel=steering_ratio,
        ramp_per_tick=tick_s / force.ramp_s,
        slew_nm=force.slew_nmps * tick_s,
        soft_clip_from=force.soft_clip_from,
        observer_angle=1.0 - pole * pole * pole,
        observer_rate_per_s=1.5 * (1.0 - pole) * (1.0 - pole) * (1.0 + pole) / tick_s,
        observer_accel_per_s2=(1.0 - pole) * (1.0 - pole) * (1.0 - pole) / (tick_s * tick_s),
        resting_hands_nm=force.resting_hands_nm,
        hands_on_nm=force.hands_on_nm,
        rim_0mps_nm_per_rad=rim.at_0mps + spring,
        rim_12mps_nm_per_rad=rim.at_12mps + spring,
        rim_24mps_nm_per_rad=rim.at_24mps + spring,
        rim_36mps_nm_per_rad=rim.at_36mps + spring,
        rim_48mps_nm_per_rad=rim.at_48mps + spring,
        relaxation_m=rim.relaxation_m,
        rate_loop_per_s=RATE_PHASE / (delay_s + tick_s),
        aligning_damping=ALIGNING_DAMPING,
        return_s=weaves * RETURN_S,
        yaw_damping_s=weaves * YAW_DAMPING_S,
        yaw_slow_s=YAW_SLOW_S,
    )
