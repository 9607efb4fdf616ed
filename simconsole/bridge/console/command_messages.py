"""The way back from what was taken to what was sent: command messages that leave a controller's slot as recorded.

A state vector holds the newest accepted command of its tick, not the message. Each change from one tick to the next
becomes the message that makes it: what `CommandDecoder` reads from it are the same values, in single precision where
the message has no more. A command counts as sent at the tick before the one that took it, and is stamped so.
"""

from typing import Any, Final

from simconsole.bridge.console.command_decoder import (
    ACKERMANN,
    ACTUATION,
    BALL_POSE,
    BALL_SPEED,
    CONTROL,
    GEAR,
    HAZARD_LIGHTS,
    HAZARDS,
    INDICATORS,
    REQUEST,
    REQUESTS,
    TURN_INDICATORS,
    TWIST,
)
from simconsole.bridge.console.published_tick import MAP_FRAME, quaternion
from simconsole.bridge.console.topics import BASE_FRAME
from simconsole.bridge.messages import Registry
from simconsole.values.numerics.single_precision import toward_zero
from simconsole.values.signals import NO_COMMAND, RemoteCommand, RemoteKind
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import NS_PER_S, tick_time_ns

_TOPICS: Final[dict[float, str]] = {
    RemoteKind.ACCELERATION: CONTROL,
    RemoteKind.SPEED: ACKERMANN,
    RemoteKind.TWIST: TWIST,
    RemoteKind.ACTUATION: ACTUATION,
    RemoteKind.POSE: BALL_POSE,
}
_BY_SIGN: Final = (RemoteKind.SPEED, RemoteKind.TWIST)
"""Kinds whose speed says the direction of travel too."""
_GEARS: Final = {0.0: 1, 1.0: 2, -1.0: 20}
_INDICATORS: Final = {shown: number for number, shown in INDICATORS.items()}
_HAZARDS: Final = {shown: number for number, shown in HAZARDS.items()}


class CommandMessages:
    """Makes the command messages of a drive, tick after tick."""

    def __init__(self, registry: Registry, command_types: dict[str, str]) -> None:
        """Take the types of the command topics by standard name."""
        self._types = {name: registry.struct(type_name) for name, type_name in command_types.items()}
        self._last = NO_COMMAND

    def of(self, snapshot: Snapshot) -> list[tuple[str, Any]]:
        """Return the messages that came between the last tick and this one: standard topic and typed message."""
        last, ros = self._last, snapshot.ros
        sent_ns = tick_time_ns(snapshot.tick - 1, snapshot.tick_hz)
        sent: list[tuple[str, Any]] = []
        if ros.kind != RemoteKind.NONE or last.kind == RemoteKind.NONE:  # else the source has failed or the drive ends
            self._last = ros
            if ros.sequence > last.sequence:
                sent += self._commands(ros, last, sent_ns)
            sent += self._settings(ros, last, sent_ns)
        events = int(snapshot.events.events)
        sent += [(REQUEST, self._types[REQUEST](name)) for name, event in REQUESTS.items() if events & event]
        return sent

    def _commands(self, ros: RemoteCommand, last: RemoteCommand, sent_ns: int) -> list[tuple[str, Any]]:
        sent: list[tuple[str, Any]] = []
        accepted = ros.sequence - last.sequence
        if ros.kind == RemoteKind.POSE and ros.speed_mps != last.speed_mps:
            sent.append((BALL_SPEED, self._types[BALL_SPEED](ros.speed_mps)))
            accepted -= last.kind == RemoteKind.POSE  # alone, it changes the command in the slot, and counts as one
        topic = _TOPICS.get(ros.kind)
        if topic is not None and accepted > 0.0:
            message = self._types[topic]()
            fill = getattr(self, f"_{RemoteKind(int(ros.kind)).name.lower()}")
            fill(message, ros, divmod(sent_ns, NS_PER_S))
            sent.append((topic, message))
        return sent

    def _settings(self, ros: RemoteCommand, last: RemoteCommand, sent_ns: int) -> list[tuple[str, Any]]:
        """Return what sets the direction of travel and the lights, where no command has done so."""
        moved = ros.speed_mps if ros.kind in _BY_SIGN and ros.sequence > last.sequence else 0.0
        direction = 1.0 if moved > 0.0 else -1.0 if moved < 0.0 else last.direction
        changes = (
            (GEAR, ros.direction, direction, _GEARS),
            (TURN_INDICATORS, ros.turn_indicators, last.turn_indicators, _INDICATORS),
            (HAZARD_LIGHTS, ros.hazard_lights, last.hazard_lights, _HAZARDS),
        )
        sent = []
        for topic, now, before, numbers in changes:
            if now != before and now in numbers:
                message = self._types[topic](command=numbers[now])
                message.stamp.sec, message.stamp.nanosec = divmod(sent_ns, NS_PER_S)
                sent.append((topic, message))
        return sent

    @staticmethod
    def _acceleration(message: Any, ros: RemoteCommand, stamp: tuple[int, int]) -> None:
        for part in (message, message.lateral, message.longitudinal):
            part.stamp.sec, part.stamp.nanosec = stamp
        message.lateral.steering_tire_angle = toward_zero(ros.road_wheel_rad)
        message.lateral.steering_tire_rotation_rate = toward_zero(ros.road_wheel_radps)
        message.longitudinal.velocity = toward_zero(ros.speed_mps)
        message.longitudinal.acceleration = toward_zero(ros.accel_mps2)

    @staticmethod
    def _speed(message: Any, ros: RemoteCommand, stamp: tuple[int, int]) -> None:
        _stamp(message.header, stamp, BASE_FRAME)
        message.drive.steering_angle = toward_zero(ros.road_wheel_rad)
        message.drive.steering_angle_velocity = toward_zero(ros.road_wheel_radps)
        message.drive.speed = toward_zero(ros.speed_mps)
        message.drive.acceleration = toward_zero(ros.accel_mps2)

    @staticmethod
    def _twist(message: Any, ros: RemoteCommand, stamp: tuple[int, int]) -> None:
        message.linear.x = ros.speed_mps
        message.angular.z = ros.yaw_rate_radps

    @staticmethod
    def _actuation(message: Any, ros: RemoteCommand, stamp: tuple[int, int]) -> None:
        _stamp(message.header, stamp, BASE_FRAME)
        message.actuation.steer_cmd = ros.road_wheel_rad
        message.actuation.accel_cmd = ros.throttle
        message.actuation.brake_cmd = ros.brake

    @staticmethod
    def _pose(message: Any, ros: RemoteCommand, stamp: tuple[int, int]) -> None:
        _stamp(message.header, stamp, MAP_FRAME)
        message.pose.position.x, message.pose.position.y = ros.x_m, ros.y_m
        turn = message.pose.orientation
        turn.x, turn.y, turn.z, turn.w = quaternion(0.0, 0.0, ros.yaw_rad)


def _stamp(header: Any, stamp: tuple[int, int], frame: str) -> None:
    header.stamp.sec, header.stamp.nanosec = stamp
    header.frame_id = frame
