"""Parts of a car: its body, its axles, its steering."""

from typing import Annotated

from msgspec import Meta, Struct

from simconsole.profiles.parts.ranges import Length, Seconds, Share, Torque


class BodyProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Mass and shape. Inertias are of the body on its springs, that of yaw of the whole car."""

    mass_kg: Annotated[float, Meta(ge=300.0, le=5000.0)]
    """Mass of the whole car with its driver."""
    yaw_inertia_kgm2: Annotated[float, Meta(ge=100.0, le=20000.0)]
    """Moment of inertia of the whole car about its upright axis."""
    roll_inertia_kgm2: Annotated[float, Meta(ge=50.0, le=10000.0)]
    """Moment of inertia of the body on its springs about the axis along the car."""
    pitch_inertia_kgm2: Annotated[float, Meta(ge=100.0, le=20000.0)]
    """Moment of inertia of the body on its springs about the axis across the car."""
    wheelbase_m: Annotated[float, Meta(ge=1.0, le=6.0)]
    """Distance between the axles."""
    front_mass_share: Annotated[float, Meta(ge=0.3, le=0.7)]
    """Share of the mass that the front axle carries at rest, 0 to 1."""
    cg_height_m: Annotated[float, Meta(ge=0.1, le=1.5)]
    """Height of the centre of gravity above the ground."""
    drag_area_m2: Annotated[float, Meta(ge=0.0, le=5.0)]
    """Drag coefficient times frontal area."""
    front_lift_area_m2: Annotated[float, Meta(ge=-3.0, le=3.0)]
    """Lift coefficient at the front axle times frontal area; positive lifts."""
    rear_lift_area_m2: Annotated[float, Meta(ge=-3.0, le=3.0)]
    """Lift coefficient at the rear axle times frontal area; positive lifts."""
    # Coefficients of side force and yaw moment per sine of the air's angle, as SAE J1594 refers them: to the frontal
    # area, the moment also to the wheelbase, at whose middle both act.
    side_area_m2: Annotated[float, Meta(ge=0.0, le=30.0)]
    """Coefficient of the side force of wind, per sine of the air's angle, times frontal area."""
    yaw_volume_m3: Annotated[float, Meta(ge=-30.0, le=30.0)]
    """Coefficient of the yaw moment of wind, per sine of the air's angle, times frontal area and wheelbase; positive
    turns the nose out of the wind."""
    length_m: Length
    """Length of the car, for contact with others, for what is drawn, and for gaps."""
    width_m: Length
    """Width of the car, for contact with others and for what is drawn."""
    height_m: Length
    """Height of the car, for what is drawn."""
    rear_overhang_m: Annotated[float, Meta(ge=0.0, le=3.0)]
    """How far the car reaches behind its rear axle."""


class AxleProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One axle. Inertia, tyre damping and brakes are of both wheels together; springs and dampers of one wheel."""

    track_m: Annotated[float, Meta(ge=0.5, le=3.0)]
    """Distance between the middles of the two wheels."""
    unsprung_kg: Annotated[float, Meta(ge=20.0, le=500.0)]
    """Mass of both wheels with brakes and half of the arms."""
    spring_npm: Annotated[float, Meta(ge=5000.0, le=200000.0)]
    """Stiffness of one wheel's spring, at the wheel."""
    damper_nspm: Annotated[float, Meta(ge=100.0, le=20000.0)]
    """Damping of one wheel's damper, at the wheel."""
    roll_bar_nmprad: Annotated[float, Meta(ge=0.0, le=200000.0)]
    """Roll stiffness of the anti-roll bar; 0 for none."""
    roll_centre_m: Annotated[float, Meta(ge=-0.2, le=0.5)]
    """Height of the axle's roll centre above the ground."""
    travel_m: Annotated[float, Meta(ge=0.02, le=0.3)]
    """Travel of a wheel from rest to either stop."""
    stop_npm: Annotated[float, Meta(ge=0.0, le=500000.0)]
    """Stiffness of the stops that is added beyond `travel_m`."""
    tyre_spring_npm: Annotated[float, Meta(ge=50000.0, le=800000.0)]
    """Vertical stiffness of one tyre."""
    tyre_damper_nspm: Annotated[float, Meta(ge=0.0, le=5000.0)]
    """Vertical damping of one tyre."""
    wheel_radius_m: Annotated[float, Meta(ge=0.1, le=0.8)]
    """Radius at which a wheel rolls."""
    wheel_inertia_kgm2: Annotated[float, Meta(ge=0.2, le=50.0)]
    """Moment of inertia of both wheels about their axis. Too light a wheel for its tyre is refused; the message says
    the least."""
    slip_stiffness: Annotated[float, Meta(ge=2.0, le=40.0)]
    """Force along the wheel over load, per unit of longitudinal slip."""
    cornering_stiffness_per_rad: Annotated[float, Meta(ge=2.0, le=40.0)]
    """Side force over load, per slip angle."""
    relaxation_x_m: Annotated[float, Meta(ge=0.02, le=2.0)]
    """Way that a tyre rolls until its force along the wheel has built up (relaxation length)."""
    relaxation_y_m: Annotated[float, Meta(ge=0.02, le=2.0)]
    """Way that a tyre rolls until its side force has built up (relaxation length)."""
    damping_nspm: Annotated[float, Meta(ge=0.0, le=3000.0)]
    """Damping of the carcasses of both rolling tyres along and across the wheel, at static load; it fades with grip."""
    locked_damping_nspm: Annotated[float, Meta(ge=0.0, le=50000.0)]
    """Damping of the carcasses of both tyres while the brake holds the wheels."""
    friction: Annotated[float, Meta(ge=0.05, le=2.0)]
    """Friction of the tyres at static load on a ground of friction 1."""
    sliding_share: Annotated[float, Meta(ge=0.5, le=0.99)]
    """Share of the friction that is left when a tyre slides fully."""
    friction_fall: Annotated[float, Meta(ge=0.0, le=0.5)]
    """Share of the friction that is lost per static load more."""
    stiffness_fall: Annotated[float, Meta(ge=0.0, le=0.5)]
    """Share of the tyre's stiffness that is lost per static load more."""
    camber_slip_per_rad: Annotated[float, Meta(ge=-0.5, le=0.5)]
    """Slip that does as much as a wheel's lean, per camber; positive pushes towards the lean."""
    camber_offset_slip: Annotated[float, Meta(ge=-0.01, le=0.01)]
    """Slip that any lean does as much as, however small it is."""
    camber_per_roll: Annotated[float, Meta(ge=-1.5, le=1.5)]
    """Camber that a wheel gains per roll of the body against the axle."""
    rolling_resistance: Annotated[float, Meta(ge=0.0, le=0.1)]
    """Rolling resistance over load."""
    support_deg: Annotated[float, Meta(ge=-10.0, le=45.0)] = 0.0
    """Slope of the line from contact patch to the links' pole, seen from the side: braking lifts the body in front and
    pulls it down at the rear."""
    brake_nm: Torque
    """Torque of both brakes together at full pedal."""
    brake_lag_s: Seconds = 0.05
    """Time constant with which the brake pressure follows the pedal."""
    handbrake_nm: Torque
    """Torque of the handbrake on both wheels together, pulled fully; 0 for none."""


class SteeringProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Hand wheel to road wheels and back."""

    ratio: Annotated[float, Meta(ge=5.0, le=30.0)]
    """Turning of the hand wheel per turning of the road wheels."""
    max_road_wheel_deg: Annotated[float, Meta(ge=5.0, le=65.0)]
    """Largest road-wheel angle to either side (steering lock)."""
    lag_s: Seconds
    """Time constant with which the road wheels follow the hand wheel."""
    max_road_wheel_degps: Annotated[float, Meta(ge=5.0, le=500.0)]
    """Fastest turning of the road wheels."""
    friction_deg: Annotated[float, Meta(ge=0.0, le=1.0)]
    """Deviation of the road wheels that the dry friction of rack and column holds."""
    compliance_deg_per_100nm: Annotated[float, Meta(ge=0.0, le=2.0)]
    """How far the road wheels give way per 100 N m of moment about the kingpins."""
    ackermann_share: Share
    """How much more the inner wheel turns than the outer one: 0 parallel, 1 full Ackermann geometry."""
    pneumatic_trail_m: Annotated[float, Meta(ge=0.0, le=0.2)]
    """How far behind the contact patch's middle the side force acts while it does not slide."""
    caster_trail_m: Annotated[float, Meta(ge=0.0, le=0.2)]
    """How far the contact patch trails the steering axis."""
    turn_slip_arm_m: Annotated[float, Meta(ge=0.0, le=0.15)] = 0.042
    """Moment of a wheel turned on the spot over friction and load: a third of the root of load over inflation
    (Gough)."""
    unassisted_share: Share
    """Share of a large torque of the tyres that the power steering leaves to the hands while the car stands."""
    unassisted_share_at_100kmh: Share
    """Share of a large torque of the tyres that the power steering leaves to the hands at 100 km/h."""
    assist_nm: Annotated[float, Meta(ge=0.1, le=50.0)] = 4.0
    """Torque without assistance around which the assistance comes in."""
    most_nm: Annotated[float, Meta(ge=1.0, le=50.0)]
    """Torque at the rim towards which the assistance bends what the hands feel."""
    damping_nms: Annotated[float, Meta(ge=0.0, le=10.0)]
    """Torque at the rim against the turning of the hand wheel."""
    rim_friction_nm: Annotated[float, Meta(ge=0.0, le=3.0)]
    """Dry friction of the steering, felt at the rim."""
