"""Profiles of vehicles: values from a data sheet or set by hand, with bounds and units in the keys."""

from itertools import pairwise
from typing import Annotated, Literal, TypeAlias

import msgspec

from simconsole.profiles.robots.depth_camera_profile import DepthCameraProfile
from simconsole.profiles.tyre import TirTyre
from simconsole.values.units import STANDARD_GRAVITY_MPS2

Length: TypeAlias = Annotated[float, msgspec.Meta(ge=0.01, le=10.0)]
Share: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]
Seconds: TypeAlias = Annotated[float, msgspec.Meta(ge=0.001, le=5.0)]
Torque: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=20000.0)]
Rpm: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=20000.0)]
Ratio: TypeAlias = Annotated[float, msgspec.Meta(ge=0.3, le=8.0)]


def require(good: bool, what: str) -> None:
    """Refuse a profile whose values are each in bounds but contradict each other.

    Raises:
        ValueError: not `good`; `what` names the key, its value and what it must be. The reader adds file and path.
    """
    if not good:
        raise ValueError(what)


class BodyProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Mass and shape. Inertias are of the body on its springs, that of yaw of the whole car."""

    mass_kg: Annotated[float, msgspec.Meta(ge=300.0, le=5000.0)]
    yaw_inertia_kgm2: Annotated[float, msgspec.Meta(ge=100.0, le=20000.0)]
    roll_inertia_kgm2: Annotated[float, msgspec.Meta(ge=50.0, le=10000.0)]
    pitch_inertia_kgm2: Annotated[float, msgspec.Meta(ge=100.0, le=20000.0)]
    wheelbase_m: Annotated[float, msgspec.Meta(ge=1.0, le=6.0)]
    front_mass_share: Annotated[float, msgspec.Meta(ge=0.3, le=0.7)]
    cg_height_m: Annotated[float, msgspec.Meta(ge=0.1, le=1.5)]
    drag_area_m2: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)]  # drag coefficient times frontal area
    front_lift_area_m2: Annotated[float, msgspec.Meta(ge=-3.0, le=3.0)]  # positive: up
    rear_lift_area_m2: Annotated[float, msgspec.Meta(ge=-3.0, le=3.0)]
    # Coefficients of side force and yaw moment per sine of the air's angle, as SAE J1594 refers them: to the frontal
    # area, the moment also to the wheelbase, at whose middle both act.
    side_area_m2: Annotated[float, msgspec.Meta(ge=0.0, le=30.0)]
    yaw_volume_m3: Annotated[float, msgspec.Meta(ge=-30.0, le=30.0)]  # positive: turns the nose out of the wind
    length_m: Length
    width_m: Length
    height_m: Length
    rear_overhang_m: Annotated[float, msgspec.Meta(ge=0.0, le=3.0)]


class AxleProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One axle. Inertia, tyre damping and brakes are of both wheels together; springs and dampers of one wheel."""

    track_m: Annotated[float, msgspec.Meta(ge=0.5, le=3.0)]
    unsprung_kg: Annotated[float, msgspec.Meta(ge=20.0, le=500.0)]  # both wheels with brakes and half of the arms
    spring_npm: Annotated[float, msgspec.Meta(ge=5000.0, le=200000.0)]
    damper_nspm: Annotated[float, msgspec.Meta(ge=100.0, le=20000.0)]
    roll_bar_nmprad: Annotated[float, msgspec.Meta(ge=0.0, le=200000.0)]
    roll_centre_m: Annotated[float, msgspec.Meta(ge=-0.2, le=0.5)]  # height
    travel_m: Annotated[float, msgspec.Meta(ge=0.02, le=0.3)]  # from rest to either stop
    stop_npm: Annotated[float, msgspec.Meta(ge=0.0, le=500000.0)]
    tyre_spring_npm: Annotated[float, msgspec.Meta(ge=50000.0, le=800000.0)]  # vertical
    tyre_damper_nspm: Annotated[float, msgspec.Meta(ge=0.0, le=5000.0)]
    wheel_radius_m: Annotated[float, msgspec.Meta(ge=0.1, le=0.8)]
    wheel_inertia_kgm2: Annotated[float, msgspec.Meta(ge=0.2, le=50.0)]
    slip_stiffness: Annotated[float, msgspec.Meta(ge=2.0, le=40.0)]  # force / load per unit of longitudinal slip
    cornering_stiffness_per_rad: Annotated[float, msgspec.Meta(ge=2.0, le=40.0)]  # force / load per slip angle
    relaxation_x_m: Annotated[float, msgspec.Meta(ge=0.02, le=2.0)]
    relaxation_y_m: Annotated[float, msgspec.Meta(ge=0.02, le=2.0)]
    damping_nspm: Annotated[float, msgspec.Meta(ge=0.0, le=3000.0)]
    locked_damping_nspm: Annotated[float, msgspec.Meta(ge=0.0, le=50000.0)]
    friction: Annotated[float, msgspec.Meta(ge=0.05, le=2.0)]  # on a ground of friction 1
    sliding_share: Annotated[float, msgspec.Meta(ge=0.5, le=0.99)]  # of the friction, fully sliding
    friction_fall: Annotated[float, msgspec.Meta(ge=0.0, le=0.5)]  # share lost per static load more
    stiffness_fall: Annotated[float, msgspec.Meta(ge=0.0, le=0.5)]
    camber_slip_per_rad: Annotated[float, msgspec.Meta(ge=-0.5, le=0.5)]  # positive: towards the lean
    camber_offset_slip: Annotated[float, msgspec.Meta(ge=-0.01, le=0.01)]  # of any camber, however small
    camber_per_roll: Annotated[float, msgspec.Meta(ge=-1.5, le=1.5)]  # camber gained per roll against the axle
    rolling_resistance: Annotated[float, msgspec.Meta(ge=0.0, le=0.1)]
    # Of the links seen from the side: slope of the line from contact patch to pole. Braking lifts the body in front
    # and pulls it down at the rear by its tangent times the force.
    support_deg: Annotated[float, msgspec.Meta(ge=-10.0, le=45.0)] = 0.0
    brake_nm: Torque
    brake_lag_s: Seconds = 0.05  # time constant of the pressure
    handbrake_nm: Torque


class SteeringProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Hand wheel to road wheels and back."""

    ratio: Annotated[float, msgspec.Meta(ge=5.0, le=30.0)]
    max_road_wheel_deg: Annotated[float, msgspec.Meta(ge=5.0, le=65.0)]
    lag_s: Seconds
    max_road_wheel_degps: Annotated[float, msgspec.Meta(ge=5.0, le=500.0)]
    friction_deg: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]  # road-wheel deviation that rack and column hold
    compliance_deg_per_100nm: Annotated[float, msgspec.Meta(ge=0.0, le=2.0)]
    ackermann_share: Share
    pneumatic_trail_m: Annotated[float, msgspec.Meta(ge=0.0, le=0.2)]
    caster_trail_m: Annotated[float, msgspec.Meta(ge=0.0, le=0.2)]
    # Moment of a wheel turned on the spot over friction and load: a third of the root of load over inflation (Gough).
    turn_slip_arm_m: Annotated[float, msgspec.Meta(ge=0.0, le=0.15)] = 0.042
    unassisted_share: Share  # of a large torque of the tyres that the power steering leaves to the hands, standing
    unassisted_share_at_100kmh: Share
    assist_nm: Annotated[float, msgspec.Meta(ge=0.1, le=50.0)] = 4.0  # unassisted torque around which it comes in
    most_nm: Annotated[float, msgspec.Meta(ge=1.0, le=50.0)]  # towards which the assistance bends the torque
    damping_nms: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)]
    rim_friction_nm: Annotated[float, msgspec.Meta(ge=0.0, le=3.0)]


class AidsProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Driver aids and their switches."""

    anti_lock: bool
    traction_control: bool
    stability_control: bool
    hill_hold: bool
    # Of the yaw rate that stability control expects; none: from the car's own tyres and steering.
    characteristic_speed_kmh: Annotated[float, msgspec.Meta(ge=20.0, le=500.0)] | None = None
    stability_lateral_mps2: Annotated[float, msgspec.Meta(ge=1.0, le=15.0)]
    stability_nm_per_radps: Annotated[float, msgspec.Meta(ge=0.0, le=100000.0)]
    stability_nm: Torque


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
    cylinders: Annotated[int, msgspec.Meta(ge=1, le=16)] = 4  # of a four-stroke engine; only to be heard

    def __post_init__(self) -> None:
        """Refuse speeds out of order.

        Raises:
            ValueError: names the key.
        """
        speeds = [point.at_rpm for point in self.curve]
        require(speeds[0] > 0.0, "curve[0].at_rpm must be above 0")
        require(all(a < b for a, b in pairwise(speeds)), f"curve at_rpm {speeds} must rise from point to point")
        require(self.stall_rpm < self.fire_rpm, f"stall_rpm {self.stall_rpm} must be below fire_rpm {self.fire_rpm}")
        require(self.fire_rpm < self.idle_rpm, f"fire_rpm {self.fire_rpm} must be below idle_rpm {self.idle_rpm}")
        most = 0.5 * self.limit_rpm
        require(self.idle_rpm < most, f"idle_rpm {self.idle_rpm} must be below half of limit_rpm {self.limit_rpm}")


class GearboxProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Clutch, gears and final drive."""

    forward: Annotated[tuple[Ratio, ...], msgspec.Meta(min_length=1, max_length=7)]
    reverse: Ratio
    final: Ratio
    synchro_rpm: Annotated[float, msgspec.Meta(ge=0.0, le=2000.0)]  # a gear goes in against this mismatch
    driven: Literal["front", "rear"]
    lock_nm: Torque  # limited slip: what the differential always keeps between its wheels; 0: open
    lock_share: Share  # and its share of the driving torque
    clutch_nm: Torque
    clutch_heat_kj: Annotated[float, msgspec.Meta(ge=1.0, le=10000.0)] = 200.0  # that takes it from cold to its limit
    clutch_cooling_s: Annotated[float, msgspec.Meta(ge=1.0, le=10000.0)] = 90.0  # time constant
    efficiency: Annotated[float, msgspec.Meta(ge=0.5, le=1.0)] = 0.92  # from clutch to wheels
    bite_closed: Share  # pedal position below which the clutch transmits everything
    bite_open: Share  # pedal position above which it transmits nothing

    def __post_init__(self) -> None:
        """Refuse gears out of order and a clutch without travel.

        Raises:
            ValueError: names the key.
        """
        require(all(a > b for a, b in pairwise(self.forward)), f"forward {self.forward} must fall from gear to gear")
        least = self.bite_closed + 0.05
        require(self.bite_open >= least, f"bite_open {self.bite_open} must be {least} or more: bite_closed + 0.05")


class AutomaticProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The automatic that works clutch and gears of the same car."""

    shift_s: Annotated[float, msgspec.Meta(ge=0.05, le=2.0)]
    shift_pause_s: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)]
    up_rpm: Rpm  # without throttle
    up_full_rpm: Rpm  # at full throttle
    down_rpm: Rpm
    down_full_rpm: Rpm
    creep_nm: Torque = 30.0  # of the clutch, with released pedals
    launch_from_rpm: Rpm  # engine speed that the slipping clutch holds with hardly any throttle
    launch_to_rpm: Rpm  # and with all of it
    lock_from_rpm: Rpm  # gearbox speed at which it may begin to close
    lock_to_rpm: Rpm
    clutch_opening_s: Seconds
    clutch_closing_s: Seconds

    def __post_init__(self) -> None:
        """Refuse thresholds out of order.

        Raises:
            ValueError: names the key.
        """
        for low, high in (
            ("down_rpm", "up_rpm"),
            ("down_full_rpm", "up_full_rpm"),
            ("launch_from_rpm", "launch_to_rpm"),
            ("lock_from_rpm", "lock_to_rpm"),
        ):
            below, above = getattr(self, low), getattr(self, high)
            require(below < above, f"{high} {above} must be above {low} {below}")


class CarProfile(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="platform", tag="car"
):
    """A car with a manual gearbox that can also work itself."""

    body: BodyProfile
    front: AxleProfile
    rear: AxleProfile
    steering: SteeringProfile
    engine: EngineProfile
    gearbox: GearboxProfile
    automatic: AutomaticProfile
    aids: AidsProfile
    tyre: TirTyre | None = None  # None: the tyre that the axles describe

    def __post_init__(self) -> None:
        """Refuse an automatic that does not fit the engine, and wheels too light for their tyres at steps of 1 ms.

        Raises:
            ValueError: names the key.
        """
        auto, engine = self.automatic, self.engine
        for key, speed in (
            ("automatic.launch_from_rpm", auto.launch_from_rpm),
            ("automatic.lock_from_rpm", auto.lock_from_rpm),
        ):
            require(speed > engine.idle_rpm, f"{key} {speed} must be above engine.idle_rpm {engine.idle_rpm}")
        up = auto.up_full_rpm
        require(up < engine.limit_rpm, f"automatic.up_full_rpm {up} must be below engine.limit_rpm {engine.limit_rpm}")
        for name, axle in (("front", self.front), ("rear", self.rear)):
            given = {} if self.tyre is None else self.tyre.coefficients
            slip_stiffness = max(axle.slip_stiffness, given.get("PKX1", 0.0) * given.get("LKX", 1.0))
            stiffness = slip_stiffness / axle.relaxation_x_m * self.body.mass_kg * STANDARD_GRAVITY_MPS2
            lever = axle.wheel_radius_m**2
            # Semi-implicit steps of h are stable to h^2 k / m = 4 and h d / m = 2; an eighth and a quarter of that.
            least = lever * max(stiffness * 1e-6 / 0.5, axle.damping_nspm * 1e-3 / 0.5)
            wheel = axle.wheel_inertia_kgm2
            require(wheel >= least, f"{name}.wheel_inertia_kgm2 {wheel} must be {least:.3g} or more for these tyres")


class BallProfile(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="platform", tag="ball"
):
    """The ball of the roll-a-ball example."""

    radius_m: Annotated[float, msgspec.Meta(ge=0.02, le=5.0)]
    max_accel_mps2: Annotated[float, msgspec.Meta(ge=0.1, le=20.0)]
    brake_mps2: Annotated[float, msgspec.Meta(ge=0.1, le=20.0)]
    rolling_mps2: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)]  # deceleration when it rolls by itself
    approach_s: Annotated[float, msgspec.Meta(ge=0.02, le=5.0)]  # time constant of the last part of the way
    turn_per_s: Annotated[float, msgspec.Meta(ge=0.0, le=20.0)]  # heading rate per road-wheel angle
    steering_ratio: Annotated[float, msgspec.Meta(ge=1.0, le=30.0)]
    max_road_wheel_deg: Annotated[float, msgspec.Meta(ge=5.0, le=60.0)]


class OdometryErrors(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What is wrong with a robot's odometry; without any of it, it is exact."""

    distance_scale: Annotated[float, msgspec.Meta(ge=0.5, le=2.0)] = 1.0  # its figure over the true one
    turn_scale: Annotated[float, msgspec.Meta(ge=0.5, le=2.0)] = 1.0
    slip_m_per_root_m: Annotated[float, msgspec.Meta(ge=0.0, le=0.5)] = 0.0  # deviation of each wheel after 1 m
    seed: Annotated[int, msgspec.Meta(ge=0, le=2**53)] = 1


class LidarProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A laser range finder that turns about its upright axis."""

    samples: Annotated[int, msgspec.Meta(ge=8, le=4096)]  # of a whole turn, anticlockwise from straight ahead
    min_m: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)]
    max_m: Annotated[float, msgspec.Meta(ge=0.1, le=100.0)]
    turn_s: Annotated[float, msgspec.Meta(ge=0.02, le=2.0)]
    noise_m: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]  # standard deviation of a range
    x_m: Annotated[float, msgspec.Meta(ge=-1.0, le=1.0)]  # ahead of base_footprint
    z_m: Annotated[float, msgspec.Meta(ge=0.0, le=2.0)]

    def __post_init__(self) -> None:
        """Refuse ranges out of order.

        Raises:
            ValueError: names the key.
        """
        require(self.min_m < self.max_m, f"min_m {self.min_m} must be below max_m {self.max_m}")


class RobotImuProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Standard deviations of an inertial measurement unit."""

    gyro_noise_radps: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]
    accel_noise_mps2: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)]
    z_m: Annotated[float, msgspec.Meta(ge=0.0, le=2.0)]


class BatteryProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A battery whose voltage falls evenly from full to empty."""

    capacity_ah: Annotated[float, msgspec.Meta(ge=0.1, le=100.0)]
    full_v: Annotated[float, msgspec.Meta(ge=1.0, le=100.0)]
    empty_v: Annotated[float, msgspec.Meta(ge=1.0, le=100.0)]
    idle_w: Annotated[float, msgspec.Meta(ge=0.0, le=500.0)]
    drive_w: Annotated[float, msgspec.Meta(ge=0.0, le=500.0)]  # at full speed, beside `idle_w`

    def __post_init__(self) -> None:
        """Refuse a voltage that would rise.

        Raises:
            ValueError: names the key.
        """
        require(self.empty_v < self.full_v, f"empty_v {self.empty_v} must be below full_v {self.full_v}")

    @property
    def energy_j(self) -> float:
        """What it holds when it is full."""
        return 0.5 * (self.full_v + self.empty_v) * self.capacity_ah * 3600.0


class TurtlebotProfile(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="platform", tag="turtlebot"
):
    """A robot with two driven wheels and a round body; its pose is that of base_footprint, between the wheels."""

    wheel_radius_m: Annotated[float, msgspec.Meta(ge=0.01, le=0.5)]
    wheel_separation_m: Annotated[float, msgspec.Meta(ge=0.05, le=2.0)]
    max_wheel_radps: Annotated[float, msgspec.Meta(ge=0.1, le=200.0)]
    max_speed_mps: Annotated[float, msgspec.Meta(ge=0.05, le=5.0)]
    max_yaw_rate_radps: Annotated[float, msgspec.Meta(ge=0.1, le=20.0)]
    max_accel_mps2: Annotated[float, msgspec.Meta(ge=0.1, le=20.0)]  # at the rim of a wheel
    brake_mps2: Annotated[float, msgspec.Meta(ge=0.1, le=20.0)]
    body_x_m: Annotated[float, msgspec.Meta(ge=-1.0, le=1.0)]  # middle of the body, ahead of base_footprint
    body_radius_m: Annotated[float, msgspec.Meta(ge=0.03, le=2.0)]
    length_m: Length
    width_m: Length
    height_m: Length
    base_link_z_m: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]  # above base_footprint
    steering_ratio: Annotated[float, msgspec.Meta(ge=1.0, le=30.0)]  # where a person drives it by a wheel
    max_road_wheel_deg: Annotated[float, msgspec.Meta(ge=5.0, le=60.0)]
    lidar: LidarProfile
    imu: RobotImuProfile
    battery: BatteryProfile
    odometry: OdometryErrors = OdometryErrors()
    depth_camera: DepthCameraProfile | None = None


class OwnProfile(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="platform", tag="own"
):
    """A vehicle that another package has registered (entry point `simconsole.vehicles`), or an FMU (`kind: fmu`)."""

    kind: Annotated[str, msgspec.Meta(pattern=r"^[a-z][a-z0-9_]{0,60}$")]
    parameters: dict[str, float] = {}
    """What differs from its own values; each has bounds of its own."""
    file: Annotated[str, msgspec.Meta(max_length=4096)] | None = None  # beside the profile: an FMU
    file_sha256: str = ""  # filled in when it is read
    names: dict[str, str] = {}  # fields of `VehicleCommand` and `VehicleState`: what the file calls them
    length_m: Length = 4.2
    width_m: Length = 1.8
    height_m: Length = 1.5
    wheelbase_m: Annotated[float, msgspec.Meta(ge=0.1, le=10.0)] = 2.6
    rear_overhang_m: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)] = 0.8
    steering_ratio: Annotated[float, msgspec.Meta(ge=1.0, le=30.0)] = 15.0
    max_road_wheel_deg: Annotated[float, msgspec.Meta(ge=5.0, le=60.0)] = 35.0


VehicleProfile: TypeAlias = CarProfile | BallProfile | TurtlebotProfile | OwnProfile
