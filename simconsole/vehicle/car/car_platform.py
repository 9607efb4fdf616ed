"""From a car's profile to a platform: units, derived figures, and the checks that need more than one value."""

import math
from typing import Final, NamedTuple

import numpy as np

from simconsole.profiles.parts.chassis import AxleProfile
from simconsole.profiles.parts.drivetrain import AutomaticProfile, EngineProfile, GearboxProfile
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.errors import ProfileError
from simconsole.values.ground import GROUND, Ground, ground_row
from simconsole.values.layout import Part, read, write
from simconsole.values.platform import Platform, Pose, Solid, Step
from simconsole.values.trigonometry import wrap_angle
from simconsole.values.units import MPS_PER_KMH, RAD_PER_DEG, RADPS_PER_RPM, STANDARD_GRAVITY_MPS2
from simconsole.vehicle.car.aid_parameters import aid_parameters, slip_stiffness
from simconsole.vehicle.car.car_step import STEP_S, field_step, step
from simconsole.vehicle.car.gearbox import SHIFT_RAMP_SHARE
from simconsole.vehicle.car.ground import on_field, on_plane
from simconsole.vehicle.car.outputs import vehicle_state
from simconsole.vehicle.car.parameters import (
    PARAMETERS,
    AxleParameters,
    BodyParameters,
    CarParameters,
    EngineParameters,
    GearParameters,
    SteeringParameters,
)
from simconsole.vehicle.car.state import CAR, Car, CarState
from simconsole.vehicle.car.tyre import PEAK_DEMAND

AIR_KGPM3: Final = 1.225
"""Density of air, ISO 2533 standard atmosphere at sea level."""

TRAIL_END: Final = 1.7
"""Demand at which the pneumatic trail is gone: before the side force has its maximum, as measured tyres show."""

LAUNCH_S: Final = 0.1
"""Time constant with which the automatic's slipping clutch brings the engine to the speed that it shall have."""

SYNC_SHARE: Final = 0.04
"""Share of the clutch's torque, beyond the engine's, with which the automatic ends a slip: felt as 0.2 m/s2."""

CREEP_FADE: Final = 0.1
"""Gearbox speed above idle, as share of it, at which nothing is left of creeping."""

LEAST_CLUTCH_NM: Final = 0.1
"""Of a clutch that transmits nothing."""

LEAST_CREEP_NM: Final = 0.1
"""Creeping torque below which any throttle lets the engine speed up: a car that does not creep."""

FRICTION_DEG: Final = 3.0
"""Angle of the hand wheel over which the steering's friction comes in: seals, mesh and column are elastic."""

RAMPS: Final = 8
LIMIT_BAND_RPM: Final = 100.0
"""Band over which the limiter reduces the torque to 0; wide enough that it does not chatter at 1 ms."""


def build_car(profile: CarProfile, pose: Pose, ground: Ground) -> Platform:
    """Return the car at rest with its engine idling, in neutral."""
    car = car_parameters(profile)
    under = ground_row(ground)
    rest = resting(car, profile, under[GROUND.plane.at("gravity_mps2")])
    initial = CarState(*(0.0,) * CAR.width)._replace(
        x_m=pose.x_m,
        y_m=pose.y_m,
        yaw_rad=wrap_angle(pose.yaw_rad),
        engine_radps=car.engine.idle_radps,
        heave_m=rest.heave_m,
        pitch_rad=rest.pitch_rad,
        fl_lift_m=rest.front_lift_m,
        fr_lift_m=rest.front_lift_m,
        rl_lift_m=rest.rear_lift_m,
        rr_lift_m=rest.rear_lift_m,
        engine_running=1.0,
        lever_adopted=1.0,
        throttle_share=1.0,
    )
    body = profile.body
    parameters = np.empty(PARAMETERS.width)
    write(parameters, PARAMETERS, car)
    return Platform(
        name="car",
        state=CarState,
        initial_state=tuple(initial),
        initial_vehicle=vehicle_state(
            read(np.array(initial), Part(Car)), car, under, on_plane if ground.field is None else on_field, 0.0
        ),
        parameters=parameters,
        ground=under,
        step=_step(profile, ground.field is not None),
        steering_ratio=profile.steering.ratio,
        max_road_wheel_rad=car.steering.max_road_wheel_rad,
        wheelbase_m=body.wheelbase_m,
        length_m=body.length_m,
        width_m=body.width_m,
        height_m=body.height_m,
        rear_overhang_m=body.rear_overhang_m,
        solid=Solid(body.mass_kg, body.yaw_inertia_kgm2, car.body.cg_to_rear_m),
    )


class Resting(NamedTuple):
    """How a car stands on a slope that takes load off its springs and tyres; all 0 on the level."""

    heave_m: float
    pitch_rad: float
    front_lift_m: float
    rear_lift_m: float


def resting(car: CarParameters, profile: CarProfile, gravity_mps2: float) -> Resting:
    """Return where springs and tyres hold a car at rest, with `gravity_mps2` of gravity normal to the ground."""
    missing = STANDARD_GRAVITY_MPS2 - gravity_mps2
    lifts, middles = [], []
    for axle, unsprung_kg in ((car.front, profile.front.unsprung_kg), (car.rear, profile.rear.unsprung_kg)):
        lift = axle.static_n * missing / (STANDARD_GRAVITY_MPS2 * axle.carcass_npm)
        sprung_n = (axle.static_n / STANDARD_GRAVITY_MPS2 - 0.5 * unsprung_kg) * missing
        lifts.append(lift)
        middles.append(lift + sprung_n / axle.spring_npm)
    pitch = (middles[1] - middles[0]) / (car.front.ahead_m - car.rear.ahead_m)
    return Resting(middles[0] + car.front.ahead_m * pitch, pitch, lifts[0], lifts[1])


def _step(profile: CarProfile, uneven: bool) -> Step:
    """Return the step on the tyre of the profile, over a plane or an uneven field.

    Raises:
        ProfileError: the tyre's file has not been read.
    """
    if profile.tyre is None:
        return field_step if uneven else step
    if not profile.tyre.coefficients:
        raise ProfileError(f"vehicle profile: tyre.coefficients: value missing: those of {profile.tyre.tir}")
    from simconsole.vehicle.car.pac2002 import coefficients
    from simconsole.vehicle.car.tir_tyre import step_on

    return step_on(coefficients(profile.tyre.coefficients), uneven)


def car_parameters(profile: CarProfile) -> CarParameters:
    """Return the parameters of the kernels, in SI."""
    front = _axle(profile, profile.front, True)
    rear = _axle(profile, profile.rear, False)
    driven = rear if profile.gearbox.driven == "rear" else front
    return CarParameters(
        body=_body(profile, front, rear, driven.radius_m),
        steering=_steering(profile),
        engine=_engine(profile.engine),
        gears=_gears(profile.gearbox, profile.automatic, profile.engine, driven),
        aids=aid_parameters(profile, front, rear),
        front=front,
        rear=rear,
    )


def _body(profile: CarProfile, front: AxleParameters, rear: AxleParameters, driven_radius_m: float) -> BodyParameters:
    body = profile.body
    sprung = body.mass_kg - profile.front.unsprung_kg - profile.rear.unsprung_kg
    arm = (front.roll_arm_m * rear.ahead_m - rear.roll_arm_m * front.ahead_m) / (rear.ahead_m - front.ahead_m)
    return BodyParameters(
        mass_kg=body.mass_kg,
        per_mass_kg=1.0 / body.mass_kg,
        moving_kg=body.mass_kg + 2.0 * (front.wheel_inertia_kgm2 + rear.wheel_inertia_kgm2) / driven_radius_m**2,
        per_sprung_kg=1.0 / sprung,
        per_roll_inertia_kgm2=1.0 / body.roll_inertia_kgm2,
        per_pitch_inertia_kgm2=1.0 / body.pitch_inertia_kgm2,
        per_yaw_inertia_kgm2=1.0 / body.yaw_inertia_kgm2,
        cg_to_front_m=body.wheelbase_m * (1.0 - body.front_mass_share),
        cg_to_rear_m=body.wheelbase_m * body.front_mass_share,
        cg_height_m=body.cg_height_m,
        drag_n_per_square_mps=0.5 * AIR_KGPM3 * body.drag_area_m2,
        front_lift_n_per_square_mps=0.5 * AIR_KGPM3 * body.front_lift_area_m2,
        rear_lift_n_per_square_mps=0.5 * AIR_KGPM3 * body.rear_lift_area_m2,
        side_n_per_square_mps=0.5 * AIR_KGPM3 * body.side_area_m2,
        yaw_nm_per_square_mps=0.5 * AIR_KGPM3 * body.yaw_volume_m3,
        sway_nm_per_rad=body.mass_kg * STANDARD_GRAVITY_MPS2 * arm,
        full_brake_n=2.0 * (front.brake_nm + rear.brake_nm) / driven_radius_m,
        unsprung_kgm=profile.front.unsprung_kg * front.ahead_m + profile.rear.unsprung_kg * rear.ahead_m,
    )


def _steering(profile: CarProfile) -> SteeringParameters:
    steering = profile.steering
    share = steering.unassisted_share
    per_mps = (steering.unassisted_share_at_100kmh - share) / (100.0 * MPS_PER_KMH)
    natural = 2.0 / steering.lag_s  # a critically damped rack lags behind a ramp by 2 / its natural frequency, rad/s
    return SteeringParameters(
        rack_pull_radps=STEP_S * natural**2,
        rack_ease=1.0 / (1.0 + STEP_S * natural) ** 2,
        rate_radps=steering.max_road_wheel_degps * RAD_PER_DEG,
        max_road_wheel_rad=steering.max_road_wheel_deg * RAD_PER_DEG,
        friction_rad=steering.friction_deg * RAD_PER_DEG,
        compliance_rad_per_nm=steering.compliance_deg_per_100nm * RAD_PER_DEG / 100.0,
        ackermann=steering.ackermann_share * 0.5 * profile.front.track_m / profile.body.wheelbase_m,
        pneumatic_trail_m=steering.pneumatic_trail_m,
        per_trail_end=1.0 / TRAIL_END,
        caster_trail_m=steering.caster_trail_m,
        turn_slip_arm_m=steering.turn_slip_arm_m,
        per_ratio=1.0 / steering.ratio,
        unassisted_share=share,
        unassisted_share_per_mps=per_mps,
        per_assist_nm=1.0 / steering.assist_nm,
        per_hand_torque_most_nm=1.0 / steering.most_nm,
        hand_damping_nms=steering.damping_nms,
        hand_friction_nm=steering.rim_friction_nm,
        per_friction_rad=steering.ratio / (FRICTION_DEG * RAD_PER_DEG),
    )


def _axle(profile: CarProfile, axle: AxleProfile, at_front: bool) -> AxleParameters:
    """Return one axle.

    The side force at the ground rolls the sprung mass alone, about the roll centre; what the roll centre's links and
    the wheels' own mass take goes to the wheels directly. Together both arms give the moment of the whole car.
    """
    body = profile.body
    share = body.front_mass_share if at_front else 1.0 - body.front_mass_share
    unsprung = profile.front.unsprung_kg + profile.rear.unsprung_kg
    sprung = body.mass_kg - unsprung
    sprung_height = (body.mass_kg * body.cg_height_m - unsprung * axle.wheel_radius_m) / sprung
    static = 0.5 * share * body.mass_kg * STANDARD_GRAVITY_MPS2
    return AxleParameters(
        ahead_m=body.wheelbase_m * (1.0 - share) * (1.0 if at_front else -1.0),
        half_track_m=0.5 * axle.track_m,
        roll_rad_per_m=1.0 / axle.track_m,
        wheel_inertia_kgm2=0.5 * axle.wheel_inertia_kgm2,
        per_wheel_inertia_kgm2=2.0 / axle.wheel_inertia_kgm2,
        spin_radps_per_newton_second=2.0 * axle.wheel_radius_m / axle.wheel_inertia_kgm2,
        per_wheel_mass_kg=2.0 / axle.unsprung_kg,
        radius_m=axle.wheel_radius_m,
        static_n=static,
        per_static_n=1.0 / static,
        stiffness_x_per_m=axle.slip_stiffness / axle.relaxation_x_m,
        stiffness_y_per_m=axle.cornering_stiffness_per_rad / axle.relaxation_y_m,
        decay_x_per_m=1.0 / axle.relaxation_x_m,
        decay_y_per_m=1.0 / axle.relaxation_y_m,
        damping_nspm=0.5 * axle.damping_nspm,
        locked_damping_nspm=0.5 * axle.locked_damping_nspm,
        friction=axle.friction,
        friction_fall=axle.friction_fall,
        stiffness_fall=axle.stiffness_fall,
        slide_demand=2.0 * (1.0 + math.sqrt(1.0 - axle.sliding_share**2)) / axle.sliding_share,
        camber_offset=axle.camber_offset_slip,
        camber_slip=axle.camber_slip_per_rad,
        camber_gain=axle.camber_per_roll,
        rolling_resistance=axle.rolling_resistance,
        spring_npm=axle.spring_npm,
        damper_nspm=axle.damper_nspm,
        bar_npm=axle.roll_bar_nmprad / axle.track_m**2,
        travel_m=axle.travel_m,
        stop_npm=axle.stop_npm,
        carcass_npm=axle.tyre_spring_npm,
        carcass_nspm=axle.tyre_damper_nspm,
        roll_arm_m=(sprung_height - axle.roll_centre_m) * sprung / body.mass_kg,
        link_arm_m=(axle.roll_centre_m * sprung + axle.wheel_radius_m * unsprung) / body.mass_kg,
        support_slope=math.tan(axle.support_deg * RAD_PER_DEG) * (1.0 if at_front else -1.0),
        brake_nm=0.5 * axle.brake_nm,
        brake_ease=STEP_S / (axle.brake_lag_s + STEP_S),
        handbrake_nm=0.5 * axle.handbrake_nm,
        peak_slip=PEAK_DEMAND / slip_stiffness(profile, axle),
    )


def _engine(engine: EngineProfile) -> EngineParameters:
    return EngineParameters(
        inertia_kgm2=engine.inertia_kgm2,
        per_inertia_kgm2=1.0 / engine.inertia_kgm2,
        drag_nm=engine.drag_nm,
        drag_nms=engine.drag_nm_per_1000rpm / (1000.0 * RADPS_PER_RPM),
        hold_nm=engine.hold_nm,
        idle_radps=engine.idle_rpm * RADPS_PER_RPM,
        per_idle_radps=1.0 / (engine.idle_rpm * RADPS_PER_RPM),
        idle_gain_nms=engine.idle_gain_nm_per_rpm / RADPS_PER_RPM,
        idle_max_nm=engine.idle_max_nm,
        stall_radps=engine.stall_rpm * RADPS_PER_RPM,
        fire_radps=engine.fire_rpm * RADPS_PER_RPM,
        starter_nm=engine.starter_nm,
        limit_radps=engine.limit_rpm * RADPS_PER_RPM,
        per_limit_band_radps=1.0 / (LIMIT_BAND_RPM * RADPS_PER_RPM),
        **_ramps(engine),
    )


def _ramps(engine: EngineProfile) -> dict[str, float]:
    """Return speed and change of slope of each corner of the curve, filled up to RAMPS with nothing."""
    first = engine.curve[0]
    points = [(0.5 * first.at_rpm, 0.0)] + [(point.at_rpm, point.torque_nm) for point in engine.curve]
    ramps: dict[str, float] = {}
    slope = 0.0
    for index in range(RAMPS):
        rpm = new = 0.0
        if index < len(points):
            rpm, torque = points[index]
            if index + 1 < len(points):
                after_rpm, after_torque = points[index + 1]
                new = (after_torque - torque) / ((after_rpm - rpm) * RADPS_PER_RPM)
        ramps |= {f"ramp_{index + 1}_radps": rpm * RADPS_PER_RPM, f"ramp_{index + 1}_nms": new - slope}
        slope = new
    return ramps


def _gears(
    box: GearboxProfile, auto: AutomaticProfile, engine: EngineProfile, driven: AxleParameters
) -> GearParameters:
    launch_nms = engine.inertia_kgm2 / LAUNCH_S
    governor_nms = engine.idle_gain_nm_per_rpm / RADPS_PER_RPM
    held_nm = min(auto.creep_nm * governor_nms / (governor_nms + launch_nms), engine.idle_max_nm)
    forward = (*(ratio * box.final for ratio in box.forward), *(0.0,) * 7)
    return GearParameters(
        clutch_nm=box.clutch_nm,
        per_clutch_nm=1.0 / max(box.clutch_nm, LEAST_CLUTCH_NM),
        heat_per_j=0.001 / box.clutch_heat_kj,
        cooling_per_s=1.0 / box.clutch_cooling_s,
        loss_share=1.0 - box.efficiency,
        bite_closed=box.bite_closed,
        bite_open=box.bite_open,
        per_bite=1.0 / (box.bite_open - box.bite_closed),
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
        per_wheel_radius_m=1.0 / driven.radius_m,
        shift_s=auto.shift_s,
        shift_pause_s=auto.shift_pause_s,
        per_ramp_s=1.0 / (SHIFT_RAMP_SHARE * auto.shift_s),
        up_radps=auto.up_rpm * RADPS_PER_RPM,
        up_per_throttle_radps=(auto.up_full_rpm - auto.up_rpm) * RADPS_PER_RPM,
        down_radps=auto.down_rpm * RADPS_PER_RPM,
        down_per_throttle_radps=(auto.down_full_rpm - auto.down_rpm) * RADPS_PER_RPM,
        launch_from_radps=auto.launch_from_rpm * RADPS_PER_RPM,
        launch_to_radps=auto.launch_to_rpm * RADPS_PER_RPM,
        launch_per_throttle_radps=(auto.launch_to_rpm - auto.launch_from_rpm) * RADPS_PER_RPM,
        launch_nms=launch_nms,
        sync_nm=SYNC_SHARE * box.clutch_nm,
        idle_radps=engine.idle_rpm * RADPS_PER_RPM,
        per_fade_radps=1.0 / (CREEP_FADE * engine.idle_rpm * RADPS_PER_RPM),
        creep_nm=auto.creep_nm,
        creep_held_nm=held_nm,
        per_creep_held_nm=1.0 / max(held_nm, LEAST_CREEP_NM),
        lock_from_radps=auto.lock_from_rpm * RADPS_PER_RPM,
        per_lock_radps=1.0 / ((auto.lock_to_rpm - auto.lock_from_rpm) * RADPS_PER_RPM),
        clutch_opening_per_s=1.0 / auto.clutch_opening_s,
        clutch_closing_per_s=1.0 / auto.clutch_closing_s,
        rear_driven=1.0 if box.driven == "rear" else 0.0,
        lock_nm=0.5 * box.lock_nm,
        lock_share=0.5 * box.lock_share,
    )
