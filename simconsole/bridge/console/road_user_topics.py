"""What the console tells of the other road users, with the errors of its localisation.

A controller knows them by its own sensors: where they are is as wrong as where it thinks that it is itself. Their
places relative to the vehicle are exact.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any, Final

from simconsole.bridge.console.published_tick import MAP_FRAME, OutputTopic, PublishedTick, quaternion
from simconsole.bridge.messages import Registry
from simconsole.values.units import NS_PER_S
from simconsole.world.traffic.road_users import RoadUser, RoadUserKind, RoadUsersAt, users

ROAD_USERS: Final = "/road_users"
DETECTIONS: Final = "/road_users/detections"
RATE_HZ: Final = 20.0

CLASSES: Final = {RoadUserKind.CAR: "car", RoadUserKind.VAN: "van", RoadUserKind.PEDESTRIAN: "person"}
"""What detectors call them."""

ReadRoadUsers = Callable[[], RoadUsersAt]
"""Returns where the road users are after the newest step of traffic."""

_TYPES: Final = """
simconsole_msgs/RoadUsers simconsole_msgs/RoadUser vision_msgs/Detection3DArray vision_msgs/Detection3D
vision_msgs/ObjectHypothesisWithPose vision_msgs/ObjectHypothesis vision_msgs/BoundingBox3D
builtin_interfaces/Time std_msgs/Header
geometry_msgs/PoseWithCovariance geometry_msgs/Pose geometry_msgs/Point geometry_msgs/Quaternion
geometry_msgs/Twist geometry_msgs/Vector3
"""


class RoadUserTopics:
    """Builds the messages that tell of the road users."""

    def __init__(self, registry: Registry, read: ReadRoadUsers) -> None:
        """Generate the classes of all messages; `read` is asked for each."""
        self._read = read
        self._types: dict[str, Any] = {name.partition("/")[2]: registry.struct(name) for name in _TYPES.split()}

    def topics(self) -> tuple[OutputTopic, ...]:
        """Return the rows of the table of output topics."""
        return (
            OutputTopic(ROAD_USERS, "simconsole_msgs/RoadUsers", RATE_HZ, self._road_users, measured=True),
            OutputTopic(DETECTIONS, "vision_msgs/Detection3DArray", RATE_HZ, self._detections, measured=True),
        )

    def _road_users(self, tick: PublishedTick) -> Any:
        types, at = self._types, self._read()
        vector = types["Vector3"]
        told = [
            types["RoadUser"](
                id=int(user.id),
                kind=int(user.kind),
                pose=self._pose(user, 0.0),
                twist=types["Twist"](vector(user.speed_mps, 0.0, 0.0), vector()),
                size=vector(user.length_m, user.width_m, user.height_m),
                turn_indicators=int(user.turn_indicators),
            )
            for user in measured(tick, at)
        ]
        return types["RoadUsers"](self._header(tick, at), told)

    def _detections(self, tick: PublishedTick) -> Any:
        types, at = self._types, self._read()
        header = self._header(tick, at)
        told = []
        for user in measured(tick, at):
            pose = self._pose(user, 0.5 * user.height_m)
            hypothesis = types["ObjectHypothesis"](CLASSES[RoadUserKind(int(user.kind))], 1.0)
            result = types["ObjectHypothesisWithPose"](hypothesis, types["PoseWithCovariance"](pose))
            size = types["Vector3"](user.length_m, user.width_m, user.height_m)
            told.append(
                types["Detection3D"](
                    header=header, results=[result], bbox=types["BoundingBox3D"](pose, size), id=str(int(user.id))
                )
            )
        return types["Detection3DArray"](header, told)

    def _header(self, tick: PublishedTick, at: RoadUsersAt) -> Any:
        stamp_ns = at.tick * NS_PER_S // tick.snapshot.tick_hz
        return self._types["Header"](self._types["Time"](*divmod(stamp_ns, NS_PER_S)), MAP_FRAME)

    def _pose(self, user: RoadUser, height_m: float) -> Any:
        types = self._types
        place = types["Point"](user.x_m, user.y_m, user.z_m + height_m)
        return types["Pose"](place, types["Quaternion"](*quaternion(0.0, 0.0, user.yaw_rad)))


def measured(tick: PublishedTick, at: RoadUsersAt) -> Iterator[RoadUser]:
    """Yield the road users as a vehicle measures them that thinks it is where its localisation says."""
    true, thought = tick.vehicle, tick.measured
    turn = thought.yaw_rad - true.yaw_rad
    cosine, sine = math.cos(turn), math.sin(turn)
    for user in users(at.users):
        if thought is true:
            yield user
            continue
        dx, dy = user.x_m - true.x_m, user.y_m - true.y_m
        yield user._replace(
            x_m=thought.x_m + cosine * dx - sine * dy,
            y_m=thought.y_m + sine * dx + cosine * dy,
            yaw_rad=user.yaw_rad + turn,
        )
