"""From a car's profile to a platform: units, derived figures, and the checks that need more than one value."""

import math
from typing import Final

import numpy as np

from simconsole.profiles.vehicle import AutomaticProfile, AxleProfile, CarProfile, EngineProfile, GearboxProfile
from simconsole.trigonometry import wrap_angle
from simconsole.units import RAD_PER_DEG, RADPS_PER_RPM, STANDARD_GRAVITY_MPS2
from simconsole.vehicle.car.outputs import vehicle_state
from simconsole.vehicle.car.parameters import (
    AxleParameters,
    BodyParameters,
    CarParameters,
    EngineParameters,
    GearParameters,
)
from simconsole.vehicle.car.state import CAR_WIDTH, CarState
from simconsole.vehicle.car.step import step
from simconsole.vehicle.platform import Ground, Platform, Pose

AIR_KGPM3: Final = 1.225
"""Density of air, ISO 2533 standard atmosphere at sea level."""

LEAST_FRICTION: Final = 0.01
"""Slipperier than wet ice; with none at all a tyre would have no limit to divide by."""

RAMPS: Final = 8
LIMIT_BAND_RPM: Final = 100.0
"""Over which the limiter takes the torque away; wide enough that it does not chatter at 1 ms."""


def build_car(profile: CarProfile, pose: Pose, ground: Ground) -> Platform:
    """Return the car at rest with its engine idling, in neutral."""
    car = car_parameters(profile, ground)
    initial = CarState(*(0.0,) * CAR_WIDTH)._replace(
        x_m=pose.x_m,
        y_m=pose.y_m,
        yaw_rad=wrap_angle(pose.yaw_rad),
        engine_radps=car.engine.idle_radps,
        engine_running=1.0,
        lever_adopted=1.0,
    )
    body = profile.body
    return Platform(
        name="car",
        state=CarState,
        initial_state=tuple(initial),
        initial_vehicle=vehicle_state(initial, car, 0.0),
        parameters=np.array([value for group in car for value in group], dtype=np.float64),
        step=step,
        steering_ratio=profile.steering.ratio,
        max_road_wheel_rad=car.body.max_road_wheel_rad,
        wheelbase_m=body.wheelbase_m,
        length_m=body.length_m,
        width_m=body.width_m,
        height_m=body.height_m,
        rear_overhang_m=body.rear_overhang_m,
    )


def car_parameters(profile: CarProfile, ground: Ground) -> CarParameters:
    """Return the parameters of the kernels, in SI."""
    return CarParameters(
        body=_body(profile, ground),
        engine=_engine(profile.engine),
        gears=_gears(profile.gearbox, profile.automatic, profile.engine, profile.front.wheel_radius_m),
        front=_axle(profile.front, ground),
        rear=_axle(profile.rear, ground),
    )


def _body(profile: CarProfile, ground: Ground) -> BodyParameters:
    body, steering = profile.body, profile.steering
    return BodyParameters(
        mass_kg=body.mass_kg,
        yaw_inertia_kgm2=body.yaw_inertia_kgm2,
        cg_to_front_m=body.wheelbase_m * (1.0 - body.front_mass_share),
        cg_to_rear_m=body.wheelbase_m * body.front_mass_share,
        cg_height_m=body.cg_height_m,
        drag_nsspmm=0.5 * AIR_KGPM3 * body.drag_area_m2,
        sway_s=body.sway_s,
        pitch_rad_per_mps2=body.pitch_deg_per_mps2 * RAD_PER_DEG,
        roll_rad_per_mps2=body.roll_deg_per_mps2 * RAD_PER_DEG,
        slope_x=ground.slope_x,
        slope_y=ground.slope_y,
        gravity_plane_mps2=STANDARD_GRAVITY_MPS2 / math.sqrt(1.0 + ground.slope_x**2 + ground.slope_y**2),
        steering_lag_s=steering.lag_s,
        steering_radps=steering.max_road_wheel_degps * RAD_PER_DEG,
        max_road_wheel_rad=steering.max_road_wheel_deg * RAD_PER_DEG,
        pneumatic_trail_m=steering.pneumatic_trail_m,
        caster_trail_m=steering.caster_trail_m,
        hand_torque_gain=steering.unassisted_share / steering.ratio,
        hand_damping_nms=steering.damping_nms,
    )


def _axle(axle: AxleProfile, ground: Ground) -> AxleParameters:
    return AxleParameters(
        wheel_inertia_kgm2=axle.wheel_inertia_kgm2,
        radius_m=axle.wheel_radius_m,
        stiffness_x_per_m=axle.slip_stiffness / axle.relaxation_x_m,
        stiffness_y_per_m=axle.cornering_stiffness_per_rad / axle.relaxation_y_m,
        decay_x_per_m=1.0 / axle.relaxation_x_m,
        decay_y_per_m=1.0 / axle.relaxation_y_m,
        damping_nspm=axle.damping_nspm,
        locked_damping_nspm=axle.locked_damping_nspm,
        friction=axle.friction * max(ground.friction, LEAST_FRICTION),
        rolling_resistance=axle.rolling_resistance,
        brake_nm=axle.brake_nm,
        handbrake_nm=axle.handbrake_nm,
    )


def _engine(engine: EngineProfile) -> EngineParameters:
    return EngineParameters(
        engine.inertia_kgm2,
        engine.drag_nm,
        engine.drag_nm_per_1000rpm / (1000.0 * RADPS_PER_RPM),
        engine.hold_nm,
        engine.idle_rpm * RADPS_PER_RPM,
        engine.idle_gain_nm_per_rpm / RADPS_PER_RPM,
        engine.idle_max_nm,
        engine.stall_rpm * RADPS_PER_RPM,
        engine.fire_rpm * RADPS_PER_RPM,
        engine.starter_nm,
        engine.limit_rpm * RADPS_PER_RPM,
        LIMIT_BAND_RPM * RADPS_PER_RPM,
        *_ramps(engine),
    )


def _ramps(engine: EngineProfile) -> tuple[float, ...]:
    """Return (speed, change of slope) of each corner of the curve, filled up to RAMPS with nothing."""
    first = engine.curve[0]
    points = [(0.5 * first.at_rpm, 0.0)] + [(point.at_rpm, point.torque_nm) for point in engine.curve]
    corners: list[float] = []
    slope = 0.0
    for index, (rpm, torque) in enumerate(points):
        new = 0.0
        if index + 1 < len(points):
            after_rpm, after_torque = points[index + 1]
            new = (after_torque - torque) / ((after_rpm - rpm) * RADPS_PER_RPM)
        corners += [rpm * RADPS_PER_RPM, new - slope]
        slope = new
    return (*corners, *(0.0,) * (2 * RAMPS - len(corners)))


def _gears(box: GearboxProfile, auto: AutomaticProfile, engine: EngineProfile, radius_m: float) -> GearParameters:
    forward = (*(ratio * box.final for ratio in box.forward), *(0.0,) * 7)
    return GearParameters(
        clutch_nm=box.clutch_nm,
        bite_closed=box.bite_closed,
        bite_open=box.bite_open,
        ratio_reverse=-box.reverse * box.final,
        ratio_1=forward[0],
        ratio_2=forward[1],
        ratio_3=forward[2],
        ratio_4=forward[3],
        ratio_5=forward[4],
        ratio_6=forward[5],
        ratio_7=forward[6],
        gears=float(len(box.forward)),
        synchro_radps=box.synchro_rpm * RADPS_PER_RPM,
        limit_radps=engine.limit_rpm * RADPS_PER_RPM,
        wheel_radius_m=radius_m,
        shift_s=auto.shift_s,
        shift_pause_s=auto.shift_pause_s,
        up_radps=auto.up_rpm * RADPS_PER_RPM,
        up_per_throttle_radps=(auto.up_full_rpm - auto.up_rpm) * RADPS_PER_RPM,
        down_radps=auto.down_rpm * RADPS_PER_RPM,
        down_per_throttle_radps=(auto.down_full_rpm - auto.down_rpm) * RADPS_PER_RPM,
        launch_from_radps=auto.launch_from_rpm * RADPS_PER_RPM,
        launch_to_radps=auto.launch_to_rpm * RADPS_PER_RPM,
        lock_from_radps=auto.lock_from_rpm * RADPS_PER_RPM,
        lock_to_radps=auto.lock_to_rpm * RADPS_PER_RPM,
        clutch_opening_per_s=1.0 / auto.clutch_opening_s,
        clutch_closing_per_s=1.0 / auto.clutch_closing_s,
    )
