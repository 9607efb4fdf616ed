"""Output topics of a TurtleBot3: names, types, frames and rates of the real one's nodes (docs/robots.md).

Under a namespace the frames have it as their prefix. The transform from map to odom is left to who localises.
"""

from typing import Any, Final

from simconsole.bridge.console.camera_topics import optical
from simconsole.bridge.console.published_tick import (
    FOOTPRINT_FRAME,
    ONCE,
    OutputTopic,
    PublishedTick,
    RobotTable,
    prefixed,
    quaternion,
)
from simconsole.bridge.console.robots.depth_topics import OPTICAL_FRAME, DepthTopics
from simconsole.bridge.messages import Registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.values.draws import Channel, normal
from simconsole.values.kernels import Row
from simconsole.values.layout import read
from simconsole.values.units import NS_PER_S, STANDARD_GRAVITY_MPS2
from simconsole.vehicle.turtlebot.robot_state import ROBOT, RobotState, others_of
from simconsole.world.arena.arena_world import ArenaWorld
from simconsole.world.arena.depth_camera import DepthCamera
from simconsole.world.arena.laser_scan import Execution, LaserScanner
from simconsole.world.arena.lidar import TWO_PI
from simconsole.world.arena.raycast import ray_grid

SCAN: Final = "/scan"
ODOMETRY: Final = "/odom"
IMU: Final = "/imu"
JOINT_STATES: Final = "/joint_states"
BATTERY: Final = "/battery_state"
SENSORS: Final = "/sensor_state"
MAGNETIC_FIELD: Final = "/magnetic_field"
TF: Final = "/tf"
TF_STATIC: Final = "/tf_static"

JOINTS: Final = ("wheel_left_joint", "wheel_right_joint")
WHEEL_LINKS: Final = ("wheel_left_link", "wheel_right_link")
EARTH_FIELD_T: Final = (20.9e-6, -43.9e-6)
"""Of the earth's magnetic field, north and up, in central Europe; map's y is taken for north."""
ENCODER_TICKS: Final = 4096.0
"""Of a turn of the wheel: what Dynamixel X motors count."""
_TYPES: Final = """
sensor_msgs/LaserScan sensor_msgs/Imu sensor_msgs/JointState sensor_msgs/BatteryState sensor_msgs/MagneticField
turtlebot3_msgs/SensorState nav_msgs/Odometry tf2_msgs/TFMessage geometry_msgs/TransformStamped geometry_msgs/Transform
geometry_msgs/Vector3 geometry_msgs/Point geometry_msgs/Quaternion geometry_msgs/Pose geometry_msgs/PoseWithCovariance
geometry_msgs/Twist geometry_msgs/TwistWithCovariance std_msgs/Header builtin_interfaces/Time
"""


class RobotTopics:
    """Builds the messages of one robot."""

    def __init__(
        self,
        registry: Registry,
        bridge: BridgeProfile,
        profile: TurtlebotProfile,
        scanner: LaserScanner | None,
        camera: DepthTopics | None = None,
    ) -> None:
        """Generate the classes of all topics. Without a `scanner` there is no /scan: the world is no arena."""
        self._camera = camera
        self._types: dict[str, Any] = {name.partition("/")[2]: registry.struct(name) for name in _TYPES.split()}
        self._profile = profile
        self._scanner = scanner
        self._seed = bridge.link.seed
        self._namespace = bridge.namespace
        self._odometry_frame = bridge.odometry_frame

    def topics(self) -> tuple[OutputTopic, ...]:
        """Return the table under the standard names, odometry last."""
        scan = OutputTopic(SCAN, "sensor_msgs/LaserScan", 1.0 / self._profile.lidar.turn_s, self._scan, measured=True)
        return (
            OutputTopic(TF_STATIC, "tf2_msgs/TFMessage", ONCE, self._tf_static),
            # Who localises tells the transform from map to odom by this topic, too.
            OutputTopic(TF, "tf2_msgs/TFMessage", 30.0, self._tf, measured=True, shared=True),
            OutputTopic(IMU, "sensor_msgs/Imu", 200.0, self._imu, measured=True),
            OutputTopic(MAGNETIC_FIELD, "sensor_msgs/MagneticField", 30.0, self._magnetic_field, measured=True),
            OutputTopic(JOINT_STATES, "sensor_msgs/JointState", 30.0, self._joint_states, measured=True),
            OutputTopic(BATTERY, "sensor_msgs/BatteryState", 1.0, self._battery, measured=True),
            OutputTopic(SENSORS, "turtlebot3_msgs/SensorState", 30.0, self._sensors, measured=True),
            *((scan,) if self._scanner is not None else ()),
            *(() if self._camera is None else self._camera.topics()),
            OutputTopic(ODOMETRY, "nav_msgs/Odometry", 30.0, self._odometry, measured=True),
        )

    def _frame(self, name: str) -> str:
        return prefixed(self._namespace, name)

    def _scan(self, tick: PublishedTick) -> Any:
        lidar = self._profile.lidar
        scan = (
            None
            if self._scanner is None
            else self._scanner.scan(state_of(tick.snapshot.vector), others_of(tick.snapshot.vector))
        )
        ranges = [] if scan is None else scan.ranges_m.tolist()
        stamp_ns = tick.snapshot.t_ns - (0 if scan is None else scan.age_ns)
        step_rad = TWO_PI / lidar.samples
        return self._types["LaserScan"](
            header=self._types["Header"](self._types["Time"](*divmod(stamp_ns, NS_PER_S)), self._frame("base_scan")),
            angle_min=0.0,
            angle_max=step_rad * (lidar.samples - 1),
            angle_increment=step_rad,
            time_increment=lidar.turn_s / lidar.samples,
            scan_time=lidar.turn_s,
            range_min=lidar.min_m,
            range_max=lidar.max_m,
            ranges=ranges,
            intensities=[],
        )

    def _odometry(self, tick: PublishedTick) -> Any:
        types, odometry = self._types, state_of(tick.snapshot.vector).odometry
        vector = types["Vector3"]
        pose = types["Pose"](
            types["Point"](odometry.x_m, odometry.y_m, 0.0),
            types["Quaternion"](*quaternion(0.0, 0.0, odometry.yaw_rad)),
        )
        twist = types["Twist"](vector(odometry.speed_mps, 0.0, 0.0), vector(0.0, 0.0, odometry.yaw_rate_radps))
        return types["Odometry"](
            tick.header(self._frame(self._odometry_frame)),
            self._frame(FOOTPRINT_FRAME),
            types["PoseWithCovariance"](pose),
            types["TwistWithCovariance"](twist),
        )

    def _imu(self, tick: PublishedTick) -> Any:
        """Build what the unit measures, gravity included; its heading is counted from the start, as odometry's is."""
        types, imu, number = self._types, self._profile.imu, tick.snapshot.tick
        state, vehicle = state_of(tick.snapshot.vector), tick.vehicle

        def drawn(channel: Channel, deviation: float) -> float:
            return deviation * normal(self._seed, channel, number) if deviation else 0.0

        rate = vehicle.yaw_rate_radps + drawn(Channel.GYRO, imu.gyro_noise_radps)
        accel = (
            vehicle.ax_mps2 + drawn(Channel.ROBOT_ACCEL_X, imu.accel_noise_mps2),
            vehicle.ay_mps2 + drawn(Channel.ROBOT_ACCEL_Y, imu.accel_noise_mps2),
            STANDARD_GRAVITY_MPS2 + drawn(Channel.ROBOT_ACCEL_Z, imu.accel_noise_mps2),
        )
        return types["Imu"](
            header=tick.header(self._frame("imu_link")),
            orientation=types["Quaternion"](*quaternion(0.0, 0.0, state.odometry.yaw_rad)),
            angular_velocity=types["Vector3"](0.0, 0.0, rate),
            linear_acceleration=types["Vector3"](*accel),
        )

    def _magnetic_field(self, tick: PublishedTick) -> Any:
        north, up = EARTH_FIELD_T
        cosine, sine = _heading(tick.vehicle.yaw_rad)
        return self._types["MagneticField"](
            header=tick.header(self._frame("mag_link")),
            magnetic_field=self._types["Vector3"](north * sine, north * cosine, up),
        )

    def _joint_states(self, tick: PublishedTick) -> Any:
        state = state_of(tick.snapshot.vector)
        return self._types["JointState"](
            header=tick.header(self._frame("base_link")),
            name=[self._frame(joint) for joint in JOINTS],
            position=[state.gauges.left_rad, state.gauges.right_rad],
            velocity=[state.motion.left_radps, state.motion.right_radps],
            effort=[],
        )

    def _battery(self, tick: PublishedTick) -> Any:
        battery = self._profile.battery
        left = self._charge(tick)
        message = self._types["BatteryState"]
        return message(
            header=tick.header(""),
            voltage=self._volts(tick),
            charge=left * battery.capacity_ah,
            capacity=battery.capacity_ah,
            design_capacity=battery.capacity_ah,
            percentage=left,  # a share, as sensor_msgs says
            power_supply_status=message.POWER_SUPPLY_STATUS_DISCHARGING,
            power_supply_health=message.POWER_SUPPLY_HEALTH_GOOD,
            power_supply_technology=message.POWER_SUPPLY_TECHNOLOGY_LIPO,
            present=True,
        )

    def _charge(self, tick: PublishedTick) -> float:
        used_j = state_of(tick.snapshot.vector).gauges.used_j
        return max(0.0, 1.0 - used_j / self._profile.battery.energy_j)

    def _volts(self, tick: PublishedTick) -> float:
        battery = self._profile.battery
        return battery.empty_v + self._charge(tick) * (battery.full_v - battery.empty_v)

    def _sensors(self, tick: PublishedTick) -> Any:
        state = state_of(tick.snapshot.vector)
        turned = (state.gauges.left_rad, state.gauges.right_rad)
        counts = [int(angle / TWO_PI * ENCODER_TICKS) for angle in turned]
        return self._types["SensorState"](
            header=tick.header(""),
            bumper=int(state.motion.bumper),
            torque=True,
            left_encoder=_wrapped(counts[0]),
            right_encoder=_wrapped(counts[1]),
            battery=self._volts(tick),
        )

    def _tf(self, tick: PublishedTick) -> Any:
        """Build odom to the robot, and its wheels as they are turned."""
        state, half = state_of(tick.snapshot.vector), 0.5 * self._profile.wheel_separation_m
        odometry, height = state.odometry, self._profile.wheel_radius_m - self._profile.base_link_z_m
        quarter = -1.5707963267948966  # a wheel's own z axis is its axle
        turned = (state.gauges.left_rad, state.gauges.right_rad)
        wheels = [
            self._transform(tick, "base_link", link, (0.0, side, height), _about_axle(quarter, angle))
            for link, side, angle in zip(WHEEL_LINKS, (half, -half), turned, strict=True)
        ]
        place = (odometry.x_m, odometry.y_m, 0.0)
        base = self._transform(
            tick, self._odometry_frame, FOOTPRINT_FRAME, place, quaternion(0.0, 0.0, odometry.yaw_rad)
        )
        return self._types["TFMessage"]([base, *wheels])

    def _tf_static(self, tick: PublishedTick) -> Any:
        profile, base_z = self._profile, self._profile.base_link_z_m
        places = (
            (FOOTPRINT_FRAME, "base_link", (0.0, 0.0, base_z)),
            ("base_link", "base_scan", (profile.lidar.x_m, 0.0, profile.lidar.z_m - base_z)),
            ("base_link", "imu_link", (profile.body_x_m, 0.0, profile.imu.z_m - base_z)),
            ("base_link", "mag_link", (profile.body_x_m, 0.0, profile.imu.z_m - base_z)),
        )
        unturned = (0.0, 0.0, 0.0, 1.0)
        frames = [self._transform(tick, *place, unturned) for place in places]
        if profile.depth_camera is not None:
            place = (profile.depth_camera.x_m, 0.0, profile.depth_camera.z_m - base_z)
            frames.append(self._transform(tick, "base_link", OPTICAL_FRAME, place, optical(0.0, 0.0)))
        return self._types["TFMessage"](frames)

    def _transform(
        self, tick: PublishedTick, parent: str, child: str, place: tuple[float, ...], turn: tuple[float, ...]
    ) -> Any:
        types = self._types
        transform = types["Transform"](types["Vector3"](*place), types["Quaternion"](*turn))
        return types["TransformStamped"](tick.header(self._frame(parent)), self._frame(child), transform)


def state_of(vector: Row) -> RobotState:
    """Return a robot's own state."""
    return read(vector, ROBOT)


def _heading(yaw_rad: float) -> tuple[float, float]:
    """Return cosine and sine."""
    _, _, sine, cosine = quaternion(0.0, 0.0, yaw_rad)  # of half the angle
    return cosine * cosine - sine * sine, 2.0 * cosine * sine


def _about_axle(roll_rad: float, turn_rad: float) -> tuple[float, float, float, float]:
    """Return the rotation by roll, then by `turn_rad` about the new z axis, the axle."""
    x, _, _, w = quaternion(roll_rad, 0.0, 0.0)
    _, _, sine, cosine = quaternion(0.0, 0.0, turn_rad)
    return x * cosine, -x * sine, w * sine, w * cosine


def _wrapped(count: int) -> int:
    """Return a count as the 32 bits of the motor's register hold it."""
    return (count + 2**31) % 2**32 - 2**31


def robot_table(vehicle: VehicleProfile | None, arena: ArenaWorld | None, execution: Execution) -> RobotTable | None:
    """Return what makes a robot's topics, None where the vehicle is no robot.

    Args:
        vehicle: that is driven.
        arena: that it is in; without one its lidar sees nothing, and has no topic.
        execution: how rays are cast, `jit.compiled` or `jit.plain`.
    """
    if not isinstance(vehicle, TurtlebotProfile):
        return None
    robot: TurtlebotProfile = vehicle

    def topics(registry: Registry, bridge: BridgeProfile) -> tuple[OutputTopic, ...]:
        seed, scanner, camera = bridge.link.seed, None, None
        if arena is not None:
            scanner = LaserScanner(robot.lidar, ray_grid(arena.outlines), seed, execution)
        if arena is not None and robot.depth_camera is not None:
            seen = DepthCamera(robot.depth_camera, arena.profile, robot.height_m, execution)
            camera = DepthTopics(registry, bridge, seen)
        return RobotTopics(registry, bridge, robot, scanner, camera).topics()

    return topics
