"""The profile of a robot with two driven wheels, and its parts."""

from typing import Annotated

from msgspec import Meta, Struct

from simconsole.profiles.parts.depth_camera import DepthCameraProfile
from simconsole.profiles.parts.ranges import Length, require


class OdometryErrors(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What is wrong with a robot's odometry; without any of it, it is exact."""

    distance_scale: Annotated[float, Meta(ge=0.5, le=2.0)] = 1.0
    """Distance in the odometry over the true one; 1 is exact."""
    turn_scale: Annotated[float, Meta(ge=0.5, le=2.0)] = 1.0
    """Turning in the odometry over the true one; 1 is exact."""
    slip_m_per_root_m: Annotated[float, Meta(ge=0.0, le=0.5)] = 0.0
    """Standard deviation of the slip of each wheel after 1 m; it grows with the root of the way."""
    seed: Annotated[int, Meta(ge=0, le=2**53)] = 1
    """Number that the slip is drawn from: equal seeds give equal odometry."""


class LidarProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A laser range finder that turns about its upright axis."""

    samples: Annotated[int, Meta(ge=8, le=4096)]
    """Ranges of a whole turn, anticlockwise from straight ahead."""
    min_m: Annotated[float, Meta(ge=0.0, le=10.0)]
    """Shortest range that is measured; below `max_m`."""
    max_m: Annotated[float, Meta(ge=0.1, le=100.0)]
    """Longest range that is measured."""
    turn_s: Annotated[float, Meta(ge=0.02, le=2.0)]
    """How long one turn takes."""
    noise_m: Annotated[float, Meta(ge=0.0, le=1.0)]
    """Standard deviation of a range."""
    x_m: Annotated[float, Meta(ge=-1.0, le=1.0)]
    """How far ahead of base_footprint the range finder is."""
    z_m: Annotated[float, Meta(ge=0.0, le=2.0)]
    """Height of the range finder above base_footprint, which lies on the floor."""

    def __post_init__(self) -> None:
        """Refuse ranges out of order.

        Raises:
            ValueError: names the key.
        """
        require(self.min_m < self.max_m, f"min_m {self.min_m} must be below max_m {self.max_m}")


class RobotImuProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Standard deviations of an inertial measurement unit."""

    gyro_noise_radps: Annotated[float, Meta(ge=0.0, le=1.0)]
    """Standard deviation of the measured yaw rate."""
    accel_noise_mps2: Annotated[float, Meta(ge=0.0, le=10.0)]
    """Standard deviation of the measured acceleration."""
    z_m: Annotated[float, Meta(ge=0.0, le=2.0)]
    """Height of the unit above base_footprint, which lies on the floor."""


class BatteryProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A battery whose voltage falls evenly from full to empty."""

    capacity_ah: Annotated[float, Meta(ge=0.1, le=100.0)]
    """Charge of the full battery."""
    full_v: Annotated[float, Meta(ge=1.0, le=100.0)]
    """Voltage of the full battery."""
    empty_v: Annotated[float, Meta(ge=1.0, le=100.0)]
    """Voltage of the empty battery; below `full_v`."""
    idle_w: Annotated[float, Meta(ge=0.0, le=500.0)]
    """Power that is always drawn."""
    drive_w: Annotated[float, Meta(ge=0.0, le=500.0)]
    """Power that is drawn at full speed, beside `idle_w`."""

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
    Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="platform", tag="turtlebot"
):
    """A robot with two driven wheels and a round body; its pose is that of base_footprint, between the wheels."""

    wheel_radius_m: Annotated[float, Meta(ge=0.01, le=0.5)]
    """Radius of the driven wheels."""
    wheel_separation_m: Annotated[float, Meta(ge=0.05, le=2.0)]
    """Distance between the driven wheels."""
    max_wheel_radps: Annotated[float, Meta(ge=0.1, le=200.0)]
    """Fastest turning of a wheel."""
    max_speed_mps: Annotated[float, Meta(ge=0.05, le=5.0)]
    """Highest speed of the robot."""
    max_yaw_rate_radps: Annotated[float, Meta(ge=0.1, le=20.0)]
    """Fastest turning of the robot on the spot."""
    max_accel_mps2: Annotated[float, Meta(ge=0.1, le=20.0)]
    """Strongest acceleration at the rim of a wheel."""
    brake_mps2: Annotated[float, Meta(ge=0.1, le=20.0)]
    """Strongest braking at the rim of a wheel."""
    body_x_m: Annotated[float, Meta(ge=-1.0, le=1.0)]
    """How far ahead of base_footprint the middle of the body is."""
    body_radius_m: Annotated[float, Meta(ge=0.03, le=2.0)]
    """Radius of the round body, for contact with walls and others."""
    length_m: Length
    """Length of the robot, for what is drawn."""
    width_m: Length
    """Width of the robot, for what is drawn."""
    height_m: Length
    """Height of the robot, for what is drawn."""
    base_link_z_m: Annotated[float, Meta(ge=0.0, le=1.0)]
    """Height of base_link above base_footprint."""
    steering_ratio: Annotated[float, Meta(ge=1.0, le=30.0)]
    """Turning of the hand wheel per road-wheel angle, where a person drives the robot by a wheel."""
    max_road_wheel_deg: Annotated[float, Meta(ge=5.0, le=60.0)]
    """Largest road-wheel angle to either side, where a person drives the robot by a wheel."""
    lidar: LidarProfile
    """The laser range finder."""
    imu: RobotImuProfile
    """Noise of the inertial measurement unit and where it is."""
    battery: BatteryProfile
    """Charge, voltages and power of the robot."""
    odometry: OdometryErrors = OdometryErrors()
    """What is wrong with the odometry; without it, it is exact."""
    depth_camera: DepthCameraProfile | None = None
    """A camera that measures depths beside colours; left out where the robot has none."""
