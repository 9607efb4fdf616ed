"""Output topics: one finished tick to the wire messages of the table in docs/rosbridge.md.

Every stamp is the tick's simulated time. Frames are REP-105's map, odom and base_link; the console's odometry does
not drift, so map and odom coincide.
"""

from collections.abc import Callable, Sequence
from math import radians
from typing import Any, Final

from simconsole.bridge.console.camera_topics import OPTICAL_FRAME, optical
from simconsole.bridge.console.map_topics import MapTopics
from simconsole.bridge.console.published_tick import (
    MAP_FRAME,
    ONCE,
    OutputTopic,
    PublishedTick,
    RobotTable,
    quaternion,
)
from simconsole.bridge.console.signal_topics import SignalTopics
from simconsole.bridge.link.localisation import Localisation, covariances
from simconsole.bridge.messages import Registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.link import WayProfile
from simconsole.values.labels import commander_label, link_label, mode_label, notice_label, reason_label
from simconsole.values.signals import NEVER_TICKS, Link, Mode, RemoteCommand, VehicleState
from simconsole.values.state_vector import LAYOUT, Snapshot
from simconsole.world.rules.road_signals import RoadSignals
from simconsole.world.world import NO_MAP, ShownMap

CLOCK: Final = "/clock"
TF: Final = "/tf"
TF_STATIC: Final = "/tf_static"
ODOMETRY: Final = "/odom"
ODOMETRY_HZ: Final = 50.0
GROUND_TRUTH: Final = "/ground_truth/odom"
IMU: Final = "/imu/data"
JOY: Final = "/console/joy"
ARBITRATION: Final = "/console/arbitration"
BRIDGE: Final = "/console/bridge"
MODE: Final = "/console/mode"
LATERAL_AUTHORITY: Final = "/console/authority/lateral"
LONGITUDINAL_AUTHORITY: Final = "/console/authority/longitudinal"
"""The remote side's share, 0 to 1, as a type that every ROS has, like the mode."""
VELOCITY: Final = "/vehicle/status/velocity_status"
STEERING: Final = "/vehicle/status/steering_status"
GEAR_STATUS: Final = "/vehicle/status/gear_status"
TURN_INDICATORS_STATUS: Final = "/vehicle/status/turn_indicators_status"
HAZARD_LIGHTS_STATUS: Final = "/vehicle/status/hazard_lights_status"
CONTROL_MODE: Final = "/vehicle/status/control_mode"

ROSOUT: Final = "/rosout"
"""What happens, as every ROS 2 node tells it; nodes of a graph publish there too."""
ROSOUT_TYPE: Final = "rcl_interfaces/msg/Log"

ROUTE: Final = "/route"
Route = Sequence[tuple[float, float, float]]
"""The lane's middle to follow in the map: x and y in m, yaw in rad, point after point."""

GLOBAL_TOPICS: Final = frozenset({CLOCK, TF, TF_STATIC})
"""Never put under a namespace: ROS programs expect exactly these names."""

BASE_FRAME: Final = "base_link"
WHEEL_BUTTONS: Final = 13
SHIFTER_BUTTONS: Final = 10
"""The T500 RS and the TH8 RS (facts of their HID descriptors)."""

_TYPES: Final = """
std_msgs/String std_msgs/Float64 builtin_interfaces/Time std_msgs/Header rosgraph_msgs/Clock
nav_msgs/Odometry tf2_msgs/TFMessage sensor_msgs/Joy sensor_msgs/Imu
geometry_msgs/TransformStamped geometry_msgs/Transform geometry_msgs/Vector3 geometry_msgs/Point
geometry_msgs/Quaternion geometry_msgs/Pose geometry_msgs/PoseWithCovariance geometry_msgs/Twist
geometry_msgs/TwistWithCovariance autoware_vehicle_msgs/VelocityReport autoware_vehicle_msgs/SteeringReport
autoware_vehicle_msgs/GearReport autoware_vehicle_msgs/TurnIndicatorsReport autoware_vehicle_msgs/HazardLightsReport
autoware_vehicle_msgs/ControlModeReport simconsole_msgs/Arbitration simconsole_msgs/Controller simconsole_msgs/Bridge
simconsole_msgs/BridgeClient rcl_interfaces/Log nav_msgs/Path geometry_msgs/PoseStamped
"""
_MODE_AT: Final = LAYOUT.arbitration.at("mode")
_NO_COVARIANCE: Final = [0.0] * 36
_NO_IMU_COVARIANCE: Final = [0.0] * 9
# Numbers of autoware_vehicle_msgs/ControlModeReport.
_AUTONOMOUS, _STEER_ONLY, _VELOCITY_ONLY, _MANUAL, _DISENGAGED, _NOT_READY = 1, 2, 3, 4, 5, 6
_CONTROL_MODES: Final[dict[float, int]] = {
    Mode.PARKED: _NOT_READY,
    Mode.MANUAL: _MANUAL,
    Mode.AUTONOMOUS: _AUTONOMOUS,
    Mode.TAKEOVER_REQUESTED: _AUTONOMOUS,
    Mode.MINIMAL_RISK: _DISENGAGED,
    Mode.STOPPED: _DISENGAGED,
    Mode.EMERGENCY_STOP: _DISENGAGED,
}
# Numbers of autoware_vehicle_msgs/GearReport.
_NEUTRAL, _DRIVE, _REVERSE = 1, 2, 20
# Numbers of autoware_vehicle_msgs/TurnIndicatorsReport and HazardLightsReport.
_DISABLE, _ENABLE_LEFT, _ENABLE_RIGHT = 1, 2, 3
_ENABLE = 2


class Outputs:
    """Builds the messages of the output topics."""

    def __init__(
        self,
        registry: Registry,
        profile: BridgeProfile,
        counts: Callable[[], dict[str, Any]] = dict,
        route: Route = (),
        signals: RoadSignals | None = None,
        shown_map: ShownMap = NO_MAP,
        robot: RobotTable | None = None,
    ) -> None:
        """Generate the classes of all output topics.

        `counts` fills /console/bridge (`counters.bridge_status`), `route` /route, `signals` those of traffic lights,
        `shown_map` those of the map; a `robot` has topics of its own in place of the car's.
        """
        self._robot_topics = () if robot is None else robot(registry, profile)
        self._route_points = route
        self._signals = SignalTopics(registry, signals)
        self._map = MapTopics(registry, shown_map, profile.link.localisation)
        self._counts = counts
        self._odometry_frame = profile.odometry_frame
        self._camera = profile.camera
        self._localisation = Localisation(profile.link)
        self._pose_covariance, self._twist_covariance = covariances(profile.link.localisation)
        at_once = profile.link.measurements == WayProfile()
        self._shows_truth = (self._localisation.is_perfect and at_once) or profile.link.ground_truth
        names = _TYPES.split()
        self._types: dict[str, Any] = {name.partition("/")[2]: registry.struct(name) for name in names}

    def topics(self) -> tuple[OutputTopic, ...]:
        """Return the table under the standard names, odometry last: who acts on it has everything else already."""
        truth = OutputTopic(
            GROUND_TRUTH,
            "nav_msgs/Odometry",
            50.0,
            lambda tick: self._odometry(tick, tick.vehicle, MAP_FRAME, _NO_COVARIANCE, _NO_COVARIANCE),
        )
        truths = (truth,) if self._shows_truth else ()
        clock = OutputTopic(CLOCK, "rosgraph_msgs/Clock", 100.0, self._clock)
        joy = OutputTopic(JOY, "sensor_msgs/Joy", 100.0, self._joy)
        if self._robot_topics:
            return (clock, joy, *self._authority_topics(), *truths, *self._robot_topics)
        return (
            clock,
            OutputTopic(TF_STATIC, "tf2_msgs/TFMessage", ONCE, self._tf_static),
            OutputTopic(ROUTE, "nav_msgs/Path", ONCE, self._route),
            *self._map.topics(),
            *self._signals.topics(),
            OutputTopic(TF, "tf2_msgs/TFMessage", 50.0, self._tf, measured=True),
            joy,
            OutputTopic(VELOCITY, "autoware_vehicle_msgs/VelocityReport", 30.0, self._velocity, measured=True),
            OutputTopic(STEERING, "autoware_vehicle_msgs/SteeringReport", 30.0, self._steering, measured=True),
            OutputTopic(GEAR_STATUS, "autoware_vehicle_msgs/GearReport", 30.0, self._gear),
            OutputTopic(
                TURN_INDICATORS_STATUS, "autoware_vehicle_msgs/TurnIndicatorsReport", 30.0, self._turn_indicators
            ),
            OutputTopic(HAZARD_LIGHTS_STATUS, "autoware_vehicle_msgs/HazardLightsReport", 30.0, self._hazard_lights),
            OutputTopic(CONTROL_MODE, "autoware_vehicle_msgs/ControlModeReport", 30.0, self._control_mode),
            *self._authority_topics(),
            OutputTopic(IMU, "sensor_msgs/Imu", 100.0, self._imu, measured=True),
            *truths,
            OutputTopic(
                ODOMETRY,
                "nav_msgs/Odometry",
                ODOMETRY_HZ,
                lambda tick: self._odometry(
                    tick, tick.measured, self._odometry_frame, self._pose_covariance, self._twist_covariance
                ),
                measured=True,
            ),
        )

    def _authority_topics(self) -> tuple[OutputTopic, ...]:
        """Return what the console tells of itself, whatever it drives."""
        return (
            OutputTopic(ARBITRATION, "simconsole_msgs/Arbitration", 50.0, self._arbitration),
            OutputTopic(MODE, "std_msgs/String", 10.0, self._mode, _MODE_AT),
            OutputTopic(LATERAL_AUTHORITY, "std_msgs/Float64", 10.0, self._lateral_authority),
            OutputTopic(LONGITUDINAL_AUTHORITY, "std_msgs/Float64", 10.0, self._longitudinal_authority),
            OutputTopic(BRIDGE, "simconsole_msgs/Bridge", 1.0, self._bridge),
        )

    def happening(self, tick: PublishedTick, text: str, *, warns: bool) -> Any:
        """Return `text`, what a tick decided, as a message of /rosout."""
        log = self._types["Log"]
        return log(stamp=tick.stamp, level=log.WARN if warns else log.INFO, name="simconsole", msg=text)

    def published_tick(self, snapshot: Snapshot) -> PublishedTick:
        """Return the tick of `snapshot` as published."""
        types = self._types
        return PublishedTick(snapshot, self._localisation, types["Time"], types["Header"], types["Quaternion"])

    def _clock(self, tick: PublishedTick) -> Any:
        return self._types["Clock"](tick.stamp)

    def _odometry(
        self,
        tick: PublishedTick,
        vehicle: VehicleState,
        frame: str,
        pose_covariance: list[float],
        twist_covariance: list[float],
    ) -> Any:
        types = self._types
        pose = types["Pose"](types["Point"](vehicle.x_m, vehicle.y_m, vehicle.z_m), tick.orientation(vehicle))
        vector = types["Vector3"]
        twist = types["Twist"](vector(vehicle.vx_mps, vehicle.vy_mps, 0.0), vector(0.0, 0.0, vehicle.yaw_rate_radps))
        return types["Odometry"](
            tick.header(frame),
            BASE_FRAME,
            types["PoseWithCovariance"](pose, pose_covariance),
            types["TwistWithCovariance"](twist, twist_covariance),
        )

    def _imu(self, tick: PublishedTick) -> Any:
        """Build what a unit at the centre of gravity measures; its axes are the vehicle's, gravity is taken out."""
        types, measured = self._types, tick.measured
        return types["Imu"](
            header=tick.header(BASE_FRAME),
            orientation=tick.orientation(measured),
            orientation_covariance=_NO_IMU_COVARIANCE,
            angular_velocity=types["Vector3"](0.0, 0.0, measured.yaw_rate_radps),
            angular_velocity_covariance=_NO_IMU_COVARIANCE,
            linear_acceleration=types["Vector3"](measured.ax_mps2, measured.ay_mps2, 0.0),
            linear_acceleration_covariance=_NO_IMU_COVARIANCE,
        )

    def _tf(self, tick: PublishedTick) -> Any:
        vehicle = tick.measured
        place = self._types["Vector3"](vehicle.x_m, vehicle.y_m, vehicle.z_m)
        return self._transform(tick, self._odometry_frame, BASE_FRAME, place, tick.orientation(vehicle))

    def _tf_static(self, tick: PublishedTick) -> Any:
        nowhere, unturned = self._types["Vector3"](), self._types["Quaternion"]()
        message = self._transform(tick, MAP_FRAME, self._odometry_frame, nowhere, unturned)
        camera = self._camera
        if camera is not None:
            place = self._types["Vector3"](camera.x_m, camera.y_m, camera.z_m)
            turn = self._types["Quaternion"](*optical(radians(camera.yaw_deg), radians(camera.pitch_deg)))
            message.transforms += self._transform(tick, BASE_FRAME, OPTICAL_FRAME, place, turn).transforms
        return message

    def _route(self, tick: PublishedTick) -> Any:
        types, header = self._types, tick.header(MAP_FRAME)
        poses = [
            types["PoseStamped"](
                header, types["Pose"](types["Point"](x_m, y_m), types["Quaternion"](*quaternion(0.0, 0.0, yaw_rad)))
            )
            for x_m, y_m, yaw_rad in self._route_points
        ]
        return types["Path"](header, poses)

    def _transform(self, tick: PublishedTick, parent: str, child: str, place: Any, turn: Any) -> Any:
        types = self._types
        transform = types["TransformStamped"](tick.header(parent), child, types["Transform"](place, turn))
        return types["TFMessage"]([transform])

    def _joy(self, tick: PublishedTick) -> Any:
        sample = tick.snapshot.sample
        wheel, shifter = int(sample.wheel_buttons), int(sample.shifter_buttons)
        buttons = [wheel >> bit & 1 for bit in range(WHEEL_BUTTONS)]
        buttons += [shifter >> bit & 1 for bit in range(SHIFTER_BUTTONS)]
        axes = [*sample[: sample._fields.index("wheel_buttons")], sample.hat_x, sample.hat_y]
        return self._types["Joy"](tick.header(""), axes, buttons)

    def _velocity(self, tick: PublishedTick) -> Any:
        vehicle = tick.measured
        report = self._types["VelocityReport"]
        return report(tick.header(BASE_FRAME), vehicle.vx_mps, vehicle.vy_mps, vehicle.yaw_rate_radps)

    def _steering(self, tick: PublishedTick) -> Any:
        return self._types["SteeringReport"](tick.stamp, tick.vehicle.road_wheel_rad)

    def _gear(self, tick: PublishedTick) -> Any:
        gear = tick.vehicle.gear
        report = _DRIVE if gear > 0.0 else _REVERSE if gear < 0.0 else _NEUTRAL
        return self._types["GearReport"](tick.stamp, report)

    def _turn_indicators(self, tick: PublishedTick) -> Any:
        shown = tick.snapshot.command.turn_indicators
        report = _ENABLE_LEFT if shown > 0.0 else _ENABLE_RIGHT if shown < 0.0 else _DISABLE
        return self._types["TurnIndicatorsReport"](tick.stamp, report)

    def _hazard_lights(self, tick: PublishedTick) -> Any:
        shown = tick.snapshot.command.hazard_lights
        return self._types["HazardLightsReport"](tick.stamp, _ENABLE if shown > 0.0 else _DISABLE)

    def _control_mode(self, tick: PublishedTick) -> Any:
        arbitration = tick.snapshot.arbitration
        mode = _CONTROL_MODES.get(arbitration.mode)
        if mode is None:
            mode = _shared_mode(arbitration.remote_lateral > 0.0, arbitration.remote_longitudinal > 0.0)
        return self._types["ControlModeReport"](tick.stamp, mode)

    def _mode(self, tick: PublishedTick) -> Any:
        return self._types["String"](mode_label(tick.snapshot.arbitration.mode))

    def _lateral_authority(self, tick: PublishedTick) -> Any:
        return self._types["Float64"](tick.snapshot.arbitration.remote_lateral)

    def _longitudinal_authority(self, tick: PublishedTick) -> Any:
        return self._types["Float64"](tick.snapshot.arbitration.remote_longitudinal)

    def _bridge(self, tick: PublishedTick) -> Any:
        counts = self._counts()
        clients = [self._types["BridgeClient"](**client) for client in counts.pop("clients", ())]
        return self._types["Bridge"](header=tick.header(""), clients=clients, **counts)

    def _arbitration(self, tick: PublishedTick) -> Any:
        snapshot = tick.snapshot
        decided, notice = snapshot.arbitration, snapshot.notice
        return self._types["Arbitration"](
            header=tick.header(BASE_FRAME),
            mode=int(decided.mode),
            reason=int(decided.reason),
            mode_words=mode_label(decided.mode),
            reason_words=reason_label(decided.reason),
            refusal=int(decided.refusal),
            refusal_words=reason_label(decided.refusal) if decided.refusal else "",
            notice=int(notice),
            notice_words=notice_label(notice),
            remote_lateral=decided.remote_lateral,
            remote_longitudinal=decided.remote_longitudinal,
            person_road_wheel=decided.person_road_wheel_rad,
            person_throttle=decided.person_throttle,
            person_brake=decided.person_brake,
            remote_road_wheel=decided.remote_road_wheel_rad,
            remote_throttle=decided.remote_throttle,
            remote_brake=decided.remote_brake,
            takeover_stage=int(decided.takeover_stage),
            commander=int(decided.commander),
            commander_words=commander_label(decided.commander),
            ros=self._controller(
                snapshot.ros, snapshot.ros_link, decided.ros_road_wheel_rad, decided.ros_throttle, decided.ros_brake,
                snapshot.tick_hz,
            ),
            ecu=self._controller(
                snapshot.ecu, snapshot.ecu_link, decided.ecu_road_wheel_rad, decided.ecu_throttle, decided.ecu_brake,
                snapshot.tick_hz,
            ),
        )  # fmt: skip

    def _controller(
        self, command: RemoteCommand, link: Link, road_wheel_rad: float, throttle: float, brake: float, tick_hz: int
    ) -> Any:
        return self._types["Controller"](
            state=int(link.state),
            state_words=link_label(link.state),
            road_wheel=road_wheel_rad,
            throttle=throttle,
            brake=brake,
            commands_accepted=int(command.sequence),
            commands_refused=int(command.refused + link.implausible),
            command_age=-1.0 if command.age_ticks >= NEVER_TICKS else command.age_ticks / tick_hz,
        )


def is_due(tick: int, last_tick: int | None, tick_hz: int, rate_hz: float) -> bool:
    """Return whether a topic of `rate_hz` is due at `tick`, `last_tick` being the last one that was published.

    The phase hangs on the tick's number alone, not on when the first client came: drift-free, and equal in every run.
    What became due in a tick that is not published is due in the next one that is.
    """
    if rate_hz == ONCE:
        return last_tick is None
    if last_tick is None or tick < last_tick:  # at the start, or after it has begun anew
        last_tick = 0
    return int(tick * rate_hz / tick_hz) > int(last_tick * rate_hz / tick_hz)


def _shared_mode(steers: bool, drives: bool) -> int:
    if steers and drives:
        return _AUTONOMOUS
    if steers:
        return _STEER_ONLY
    return _VELOCITY_ONLY if drives else _MANUAL
