"""Command topics: wire messages to `signals.RemoteCommand`, checked before anything of them is used.

A command is refused whole when a required field is missing, a value is not finite or beyond its limit, or its stamp
is not newer than the last one's. A stamp of 0 is no stamp: such messages are taken in the order they arrive.
"""

from typing import Any, Final, NamedTuple

from simconsole.bridge.console.input_slots import BridgeInputs
from simconsole.bridge.console.published_tick import MAP_FRAME, ROBOT_FRAMES, prefixed
from simconsole.bridge.console.topics import BASE_FRAME
from simconsole.bridge.protocol.topic_registry import Accept
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import RemoteProtocolError
from simconsole.values.kernels import is_finite
from simconsole.values.signals import Event, RemoteCommand, RemoteKind
from simconsole.values.trigonometry import atan2
from simconsole.values.units import NS_PER_S

CONTROL: Final = "/control/command/control_cmd"
GEAR: Final = "/control/command/gear_cmd"
TURN_INDICATORS: Final = "/control/command/turn_indicators_cmd"
HAZARD_LIGHTS: Final = "/control/command/hazard_lights_cmd"
ACTUATION: Final = "/control/command/actuation_cmd"
ACKERMANN: Final = "/ackermann_cmd"
TWIST: Final = "/cmd_vel"
TWIST_STAMPED: Final = "/cmd_vel_stamped"
BALL_POSE: Final = "/ball/desired_pose"
BALL_SPEED: Final = "/ball/desired_speed"
REQUEST: Final = "/console/request"

REQUESTS: Final[dict[str, Event]] = {
    "autonomous": Event.REQUEST_AUTONOMOUS,
    "manual": Event.REQUEST_MANUAL,
    "shared": Event.REQUEST_SHARED,
    "takeover": Event.REQUEST_TAKEOVER,
    "estop": Event.EMERGENCY_STOP,
    "reset": Event.RESET,
    "mark": Event.MARK,
    "pause": Event.PAUSE,
    "start": Event.START,
    "restart": Event.RESTART,
    "fault": Event.FAULT,
    "anti_lock": Event.TOGGLE_ANTI_LOCK,
    "traction": Event.TOGGLE_TRACTION,
    "stability": Event.TOGGLE_STABILITY,
}
# autoware_vehicle_msgs/GearCommand: NEUTRAL 1, DRIVE 2 to DRIVE_18 19, REVERSE 20 and 21, PARK 22, LOW 23 and 24.
DIRECTIONS: Final[dict[int, float]] = {
    1: 0.0,
    **dict.fromkeys(range(2, 20), 1.0),
    20: -1.0,
    21: -1.0,
    22: 0.0,
    23: 1.0,
    24: 1.0,
}
# autoware_vehicle_msgs/TurnIndicatorsCommand and HazardLightsCommand; 0 is NO_COMMAND and leaves them as they are.
INDICATORS: Final[dict[int, float]] = {1: 0.0, 2: 1.0, 3: -1.0}
HAZARDS: Final[dict[int, float]] = {1: 0.0, 2: 1.0}
_FUTURE_NS: Final = 50_000_000
_UNIT_TOLERANCE: Final = 0.1


class CommandTopic(NamedTuple):
    """One row of the table of command topics."""

    name: str
    type: str
    accept: Accept
    leased: bool = True


class CommandDecoder:
    """Checks commands and puts what they mean into the slot."""

    def __init__(self, inputs: BridgeInputs, profile: BridgeProfile, *, is_robot: bool = False) -> None:
        """Check against the limits of `profile` and write to `inputs`; a robot takes velocities alone."""
        self._is_robot = is_robot
        frames = [prefixed(profile.namespace, frame) for frame in ROBOT_FRAMES] if is_robot else [BASE_FRAME]
        self._body_frames = ("", *frames)
        self._inputs = inputs
        self._limits = profile.commands
        self._follows_clock = profile.sender_clock == "console"
        self._max_age_ns = int(profile.max_stamp_age_ms * 1e6)
        self._last_stamps: dict[str, int] = {}
        self._ball_speed_mps = 0.0
        # The console's odometry begins at the map's origin and does not drift: both frames are the same.
        self._world_frames = ("", MAP_FRAME, profile.odometry_frame)
        self.ros_time_ns = 0
        """What /clock says now; only compared with stamps where senders follow it."""

    def topics(self) -> tuple[CommandTopic, ...]:
        """Return the table of command topics under their standard names."""
        velocities = (
            CommandTopic(TWIST, "geometry_msgs/Twist", self._twist),
            CommandTopic(TWIST_STAMPED, "geometry_msgs/TwistStamped", self._twist_stamped),
        )
        request = CommandTopic(REQUEST, "std_msgs/String", self._request, leased=False)
        if self._is_robot:
            return (*velocities, request)
        return (
            CommandTopic(CONTROL, "autoware_control_msgs/Control", self._control),
            CommandTopic(GEAR, "autoware_vehicle_msgs/GearCommand", self._gear),
            CommandTopic(TURN_INDICATORS, "autoware_vehicle_msgs/TurnIndicatorsCommand", self._turn_indicators),
            CommandTopic(HAZARD_LIGHTS, "autoware_vehicle_msgs/HazardLightsCommand", self._hazard_lights),
            CommandTopic(ACTUATION, "tier4_vehicle_msgs/ActuationCommandStamped", self._actuation),
            CommandTopic(ACKERMANN, "ackermann_msgs/AckermannDriveStamped", self._ackermann),
            *velocities,
            CommandTopic(BALL_POSE, "geometry_msgs/PoseStamped", self._ball_pose),
            CommandTopic(BALL_SPEED, "std_msgs/Float64", self._ball_speed),
            request,
        )

    def forget_stamps(self) -> None:
        """Begin a new order of stamps: another commander may have another clock."""
        self._last_stamps.clear()

    def _control(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        _require(plain, "lateral.steering_tire_angle", "longitudinal.acceleration")
        lateral, longitudinal, limits = message.lateral, message.longitudinal, self._limits
        command = RemoteCommand(
            kind=float(RemoteKind.ACCELERATION),
            road_wheel_rad=_within("lateral.steering_tire_angle", lateral.steering_tire_angle, limits.road_wheel_rad),
            road_wheel_radps=_within(
                "lateral.steering_tire_rotation_rate", lateral.steering_tire_rotation_rate, limits.road_wheel_radps
            ),
            speed_mps=_within("longitudinal.velocity", longitudinal.velocity, limits.speed_mps),
            accel_mps2=_within("longitudinal.acceleration", longitudinal.acceleration, limits.accel_mps2),
        )
        self._inputs.accept(command, self._order(CONTROL, message.stamp), now_ns)

    def _ackermann(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        _require(plain, "drive.steering_angle", "drive.speed")
        _in_frame(message.header, self._body_frames)
        drive, limits = message.drive, self._limits
        speed_mps = _within("drive.speed", drive.speed, limits.speed_mps)
        command = RemoteCommand(
            kind=float(RemoteKind.SPEED),
            road_wheel_rad=_within("drive.steering_angle", drive.steering_angle, limits.road_wheel_rad),
            road_wheel_radps=_within(
                "drive.steering_angle_velocity", drive.steering_angle_velocity, limits.road_wheel_radps
            ),
            speed_mps=speed_mps,
            accel_mps2=_within("drive.acceleration", drive.acceleration, limits.accel_mps2),
            direction=_sign(speed_mps),
        )
        self._inputs.accept(command, self._order(ACKERMANN, message.header.stamp), now_ns)

    def _actuation(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        """Take pedals 0 to 1 and, as raw_vehicle_cmd_converter passes it on unconverted, the road-wheel angle."""
        _require(plain, "actuation.accel_cmd", "actuation.brake_cmd", "actuation.steer_cmd")
        _in_frame(message.header, self._body_frames)
        asked = message.actuation
        command = RemoteCommand(
            kind=float(RemoteKind.ACTUATION),
            road_wheel_rad=_within("actuation.steer_cmd", asked.steer_cmd, self._limits.road_wheel_rad),
            throttle=_within("actuation.accel_cmd", asked.accel_cmd, 1.0, 0.0),
            brake=_within("actuation.brake_cmd", asked.brake_cmd, 1.0, 0.0),
        )
        self._inputs.accept(command, self._order(ACTUATION, message.header.stamp), now_ns)

    def _twist(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        _require(plain, "linear.x", "angular.z")
        self._move(message, "", None, now_ns)

    def _twist_stamped(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        _require(plain, "twist.linear.x", "twist.angular.z")
        _in_frame(message.header, self._body_frames)
        self._move(message.twist, "twist.", (TWIST_STAMPED, message.header.stamp), now_ns)

    def _move(self, twist: Any, path: str, stamp: tuple[str, Any] | None, now_ns: int) -> None:
        speed_mps = _within(f"{path}linear.x", twist.linear.x, self._limits.speed_mps)
        command = RemoteCommand(
            kind=float(RemoteKind.TWIST),
            speed_mps=speed_mps,
            yaw_rate_radps=_within(f"{path}angular.z", twist.angular.z, self._limits.yaw_rate_radps),
            direction=_sign(speed_mps),
        )
        self._inputs.accept(command, self._order(*stamp) if stamp is not None else None, now_ns)

    def _ball_pose(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        _require(plain, "pose.position.x", "pose.position.y")
        _in_frame(message.header, self._world_frames)
        position, turn = message.pose.position, message.pose.orientation
        square = turn.x * turn.x + turn.y * turn.y + turn.z * turn.z + turn.w * turn.w
        if not abs(square - 1.0) <= _UNIT_TOLERANCE:
            raise RemoteProtocolError("not a unit quaternion - at `$.pose.orientation`")
        command = RemoteCommand(
            kind=float(RemoteKind.POSE),
            speed_mps=self._ball_speed_mps,
            x_m=_within("pose.position.x", position.x, self._limits.position_m),
            y_m=_within("pose.position.y", position.y, self._limits.position_m),
            yaw_rad=atan2(
                2.0 * (turn.w * turn.z + turn.x * turn.y), square - 2.0 * (turn.y * turn.y + turn.z * turn.z)
            ),
            direction=1.0,
        )
        self._inputs.accept(command, self._order(BALL_POSE, message.header.stamp), now_ns)

    def _ball_speed(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        _require(plain, "data")
        self._ball_speed_mps = _within("data", message.data, self._limits.speed_mps)
        command = self._inputs.command
        if command.kind == RemoteKind.POSE:
            self._inputs.accept(command._replace(speed_mps=self._ball_speed_mps), self._inputs.stamp_ns, now_ns)

    def _gear(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        _require(plain, "command")
        direction = DIRECTIONS.get(message.command)
        if direction is None:
            raise RemoteProtocolError(f"{message.command} is no gear - at `$.command`")
        self._order(GEAR, message.stamp)
        self._inputs.keep(direction=direction)

    def _turn_indicators(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        shown = _setting(plain, message.command, INDICATORS, "a turn indicator")
        self._order(TURN_INDICATORS, message.stamp)
        if shown is not None:
            self._inputs.keep(turn_indicators=shown)

    def _hazard_lights(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        shown = _setting(plain, message.command, HAZARDS, "a state of hazard lights")
        self._order(HAZARD_LIGHTS, message.stamp)
        if shown is not None:
            self._inputs.keep(hazard_lights=shown)

    def _request(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        event = REQUESTS.get(message.data)
        if event is None:
            raise RemoteProtocolError(f"not one of {', '.join(REQUESTS)} - at `$.data`")
        self._inputs.raise_events(int(event))

    def _order(self, topic: str, stamp: Any) -> int | None:
        """Return a stamp in ns that is newer than the topic's last one, None for no stamp."""
        stamp_ns: int = stamp.sec * NS_PER_S + stamp.nanosec
        if stamp_ns == 0:
            return None
        last = self._last_stamps.get(topic)
        if last is not None and stamp_ns <= last:
            raise RemoteProtocolError("not newer than the last accepted one - at `$.stamp`")
        if self._follows_clock:
            if stamp_ns > self.ros_time_ns + _FUTURE_NS:
                raise RemoteProtocolError("from the future of /clock - at `$.stamp`")
            if stamp_ns < self.ros_time_ns - self._max_age_ns:
                raise RemoteProtocolError(f"older than {self._max_age_ns / 1e6:g} ms by /clock - at `$.stamp`")
        self._last_stamps[topic] = stamp_ns
        return stamp_ns


def _require(plain: dict[str, Any] | None, *paths: str) -> None:
    """Refuse a message in which a field was left to its default: a command is never 0 by omission."""
    if plain is None:  # it was given in full
        return
    for path in paths:
        value: Any = plain
        for key in path.split("."):
            value = value.get(key) if isinstance(value, dict) else None
        if value is None:
            raise RemoteProtocolError(f"required in a command - at `$.{path}`")


def _setting(plain: dict[str, Any] | None, command: int, settings: dict[int, float], name: str) -> float | None:
    """Return what one of Autoware's command numbers means; None for its NO_COMMAND."""
    _require(plain, "command")
    if command != 0 and command not in settings:
        raise RemoteProtocolError(f"{command} is not {name} - at `$.command`")
    return settings.get(command)


def _in_frame(header: Any, frames: tuple[str, ...]) -> None:
    """Refuse a frame that the console does not take commands in; an empty name stands for the right one."""
    if header.frame_id.removeprefix("/") not in frames:
        named = " or ".join(filter(None, frames))
        raise RemoteProtocolError(f"{header.frame_id[:64]!r} is not {named} - at `$.header.frame_id`")


def _within(path: str, value: float, most: float, least: float | None = None) -> float:
    """Return the value if it is finite and in its range; `least` is `-most` unless given."""
    least = -most if least is None else least
    if least <= value <= most:
        return value
    wrong = f"{value:g} is not within {least:g} to {most:g}" if is_finite(value) else "not finite"
    raise RemoteProtocolError(f"{wrong} - at `$.{path}`")


def _sign(speed_mps: float) -> float:
    """Return the direction of travel of a speed; 0 leaves the direction as it is."""
    return 1.0 if speed_mps > 0.0 else -1.0 if speed_mps < 0.0 else 0.0
