"""Bags of other systems, written by the library that reads them: names, times and types as others have them."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Ros2Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.definition_text import full_text

ACKERMANN = "ackermann_msgs/msg/AckermannDriveStamped"
CONTROL = "autoware_control_msgs/msg/Control"
TWIST = "geometry_msgs/msg/Twist"
JOY = "sensor_msgs/msg/Joy"
STRING = "std_msgs/msg/String"
EPOCH_NS = 1_700_000_000_000_000_000


class Written(NamedTuple):
    """One message to write: topic, type, time, and content as plain values."""

    topic: str
    type: str
    time_ns: int
    plain: dict[str, Any]


def typestore(types: Iterable[str], ros1: bool) -> Any:
    store, registry = get_typestore(Stores.EMPTY), standard_registry()
    found: dict[str, Any] = {}
    for name in types:
        found.update(get_types_from_msg(full_text(registry.with_parts(name), ros1=ros1), name))
    store.register(found)
    return store


def built(store: Any, name: str, plain: dict[str, Any]) -> Any:
    """A message of the library, with zeros where `plain` says nothing."""
    _, fields = store.fielddefs[name]
    values = {}
    for field, (kind, detail) in fields:
        given = plain.get(field)
        if int(kind) == 2:  # another message
            values[field] = built(store, detail, given or {})
        elif int(kind) == 1:
            values[field] = given if given is not None else ("" if detail[0] == "string" else 0)
        else:
            letter = {"float32": np.float32, "int32": np.int32}.get(detail[0][1][0], object)
            values[field] = np.array(given or [], dtype=letter)
    return store.types[name](**values)


def write_bag(path: Path, messages: Iterable[Written], storage: str = "mcap") -> Path:
    """Write a bag: `path` ends in .bag for ROS 1, else it is a folder of rosbag2; return it."""
    listed = list(messages)
    ros1 = path.suffix == ".bag"
    store = typestore({message.type for message in listed}, ros1)
    connections: dict[str, Any] = {}
    plugin = StoragePlugin.MCAP if storage == "mcap" else StoragePlugin.SQLITE3
    writer: Any = Ros1Writer(path) if ros1 else Ros2Writer(path, version=8, storage_plugin=plugin)
    serialize: Callable[[Any, str], Any] = store.serialize_ros1 if ros1 else store.serialize_cdr
    with writer:
        for message in listed:
            if message.topic not in connections:
                connections[message.topic] = writer.add_connection(message.topic, message.type, typestore=store)
            data = serialize(built(store, message.type, message.plain), message.type)
            writer.write(connections[message.topic], message.time_ns, bytes(data))
    return path


def ackermann(time_ns: int, speed_mps: float = 2.0, topic: str = "/ego/drive", frame: str = "") -> Written:
    stamp = {"sec": time_ns // 10**9, "nanosec": time_ns % 10**9}
    drive = {"steering_angle": 0.125, "speed": speed_mps}
    return Written(topic, ACKERMANN, time_ns, {"header": {"stamp": stamp, "frame_id": frame}, "drive": drive})


def twist(time_ns: int, speed_mps: float = 2.0, topic: str = "/cmd_vel") -> Written:
    return Written(topic, TWIST, time_ns, {"linear": {"x": speed_mps}, "angular": {"z": 0.25}})


def joy(time_ns: int, axes: Iterable[float], buttons: Iterable[int] = (), topic: str = "/joy") -> Written:
    return Written(topic, JOY, time_ns, {"axes": list(axes), "buttons": list(buttons)})


def said(time_ns: int, word: str, topic: str = "/console/request") -> Written:
    return Written(topic, STRING, time_ns, {"data": word})
