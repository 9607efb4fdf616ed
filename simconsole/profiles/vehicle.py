"""Profiles of vehicles: what a person would read off a data sheet or set by hand, with bounds and units in the keys."""

from typing import Annotated, TypeAlias

import msgspec

Length: TypeAlias = Annotated[float, msgspec.Meta(ge=0.01, le=10.0)]
Share: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]
Seconds: TypeAlias = Annotated[float, msgspec.Meta(ge=0.001, le=5.0)]
Torque: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=20000.0)]
Rpm: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=20000.0)]
Ratio: TypeAlias = Annotated[float, msgspec.Meta(ge=0.3, le=8.0)]


class BodyProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Mass and shape."""

    mass_kg: Annotated[float, msgspec.Meta(ge=300.0, le=5000.0)]
    yaw_inertia_kgm2: Annotated[float, msgspec.Meta(ge=100.0, le=20000.0)]
    wheelbase_m: Annotated[float, msgspec.Meta(ge=1.0, le=6.0)]
    front_mass_share: Annotated[float, msgspec.Meta(ge=0.3, le=0.7)]
    cg_height_m: Annotated[float, msgspec.Meta(ge=0.1, le=1.5)]
    drag_area_m2: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)]  # drag coefficient times frontal area
    pitch_deg_per_mps2: Annotated[float, msgspec.Meta(ge=0.0, le=2.0)]
    roll_deg_per_mps2: Annotated[float, msgspec.Meta(ge=0.0, le=2.0)]
    sway_s: Annotated[float, msgspec.Meta(ge=0.02, le=1.0)]  # lag of load transfer, pitch and roll
    length_m: Length
    width_m: Length
    height_m: Length
    rear_overhang_m: Annotated[float, msgspec.Meta(ge=0.0, le=3.0)]


class AxleProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One axle: both tyres, wheels and brakes together."""

    wheel_radius_m: Annotated[float, msgspec.Meta(ge=0.1, le=0.8)]
    wheel_inertia_kgm2: Annotated[float, msgspec.Meta(ge=0.2, le=50.0)]
    slip_stiffness: Annotated[float, msgspec.Meta(ge=2.0, le=40.0)]  # force / load per unit of longitudinal slip
    cornering_stiffness_per_rad: Annotated[float, msgspec.Meta(ge=2.0, le=40.0)]  # force / load per slip angle
    relaxation_x_m: Annotated[float, msgspec.Meta(ge=0.1, le=2.0)]
    relaxation_y_m: Annotated[float, msgspec.Meta(ge=0.1, le=2.0)]
    damping_nspm: Annotated[float, msgspec.Meta(ge=0.0, le=3000.0)]
    locked_damping_nspm: Annotated[float, msgspec.Meta(ge=0.0, le=50000.0)]
    friction: Annotated[float, msgspec.Meta(ge=0.05, le=2.0)]  # on a ground of friction 1
    rolling_resistance: Annotated[float, msgspec.Meta(ge=0.0, le=0.1)]
    brake_nm: Torque
    handbrake_nm: Torque


class SteeringProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Hand wheel to road wheels and back."""

    ratio: Annotated[float, msgspec.Meta(ge=5.0, le=30.0)]
    max_road_wheel_deg: Annotated[float, msgspec.Meta(ge=5.0, le=60.0)]
    lag_s: Seconds
    max_road_wheel_degps: Annotated[float, msgspec.Meta(ge=5.0, le=500.0)]
    pneumatic_trail_m: Annotated[float, msgspec.Meta(ge=0.0, le=0.2)]
    caster_trail_m: Annotated[float, msgspec.Meta(ge=0.0, le=0.2)]
    unassisted_share: Share  # of the tyres' torque that the power steering leaves to the hands
    damping_nms: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)]


class TorquePoint(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One point of the full-throttle curve."""

    at_rpm: Rpm
    torque_nm: Annotated[float, msgspec.Meta(ge=0.0, le=2000.0)]


class EngineProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The engine. The curve rises from nothing at half its first speed and is level after its last point."""

    inertia_kgm2: Annotated[float, msgspec.Meta(ge=0.01, le=5.0)]
    curve: Annotated[tuple[TorquePoint, ...], msgspec.Meta(min_length=1, max_length=7)]  # speeds ascending
    drag_nm: Torque
    drag_nm_per_1000rpm: Annotated[float, msgspec.Meta(ge=0.0, le=100.0)]
    hold_nm: Torque  # more friction while nothing burns: compression
    idle_rpm: Annotated[float, msgspec.Meta(ge=300.0, le=3000.0)]
    idle_gain_nm_per_rpm: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)]
    idle_max_nm: Torque
    stall_rpm: Annotated[float, msgspec.Meta(ge=50.0, le=2000.0)]
    fire_rpm: Annotated[float, msgspec.Meta(ge=60.0, le=2500.0)]
    starter_nm: Torque
    limit_rpm: Annotated[float, msgspec.Meta(ge=1000.0, le=20000.0)]


class GearboxProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Clutch, gears and final drive."""

    forward: Annotated[tuple[Ratio, ...], msgspec.Meta(min_length=1, max_length=7)]
    reverse: Ratio
    final: Ratio
    synchro_rpm: Annotated[float, msgspec.Meta(ge=0.0, le=2000.0)]  # a gear goes in against this mismatch
    clutch_nm: Torque
    bite_closed: Share  # pedal position below which the clutch transmits everything
    bite_open: Share  # pedal position above which it transmits nothing


class AutomaticProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The automatic that works clutch and gears of the same car."""

    shift_s: Annotated[float, msgspec.Meta(ge=0.05, le=2.0)]
    shift_pause_s: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)]
    up_rpm: Rpm  # without throttle
    up_full_rpm: Rpm  # at full throttle
    down_rpm: Rpm
    down_full_rpm: Rpm
    launch_from_rpm: Rpm  # engine speed at which the clutch begins to bite
    launch_to_rpm: Rpm
    lock_from_rpm: Rpm  # gearbox speed at which it begins to close
    lock_to_rpm: Rpm
    clutch_opening_s: Seconds
    clutch_closing_s: Seconds


class CarProfile(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="platform", tag="car"
):
    """A front-wheel-drive car with a manual gearbox that can also work itself."""

    body: BodyProfile
    front: AxleProfile
    rear: AxleProfile
    steering: SteeringProfile
    engine: EngineProfile
    gearbox: GearboxProfile
    automatic: AutomaticProfile


class BallProfile(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="platform", tag="ball"
):
    """The ball of the roll-a-ball example."""

    radius_m: Annotated[float, msgspec.Meta(ge=0.02, le=5.0)]
    max_accel_mps2: Annotated[float, msgspec.Meta(ge=0.1, le=20.0)]
    brake_mps2: Annotated[float, msgspec.Meta(ge=0.1, le=20.0)]
    rolling_mps2: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)]  # deceleration when it rolls by itself
    approach_s: Annotated[float, msgspec.Meta(ge=0.02, le=5.0)]  # time constant of the last bit to the target
    turn_per_s: Annotated[float, msgspec.Meta(ge=0.0, le=20.0)]  # heading rate per road-wheel angle
    steering_ratio: Annotated[float, msgspec.Meta(ge=1.0, le=30.0)]
    max_road_wheel_deg: Annotated[float, msgspec.Meta(ge=5.0, le=60.0)]


VehicleProfile: TypeAlias = CarProfile | BallProfile
