from typing import Any

import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.ros1 import serialize_ros1


@pytest.mark.parametrize(
    ("definition", "plain", "body"),
    [
        ("", {}, ""),
        ("uint8 a\nuint32 b\nbool c\n", {"a": 1, "b": 2, "c": True}, "01 02000000 01"),
        ("string a\nuint16 b\n", {"a": "hé", "b": 3}, "03000000 68c3a9 0300"),
        (
            "uint8[] a\nuint8[2] b\nint16[] c\n",
            {"a": "AQI=", "b": "AwQ=", "c": [-1]},
            "02000000 0102 0304 01000000 ffff",
        ),
        ("string[] a\n", {"a": ["x", ""]}, "02000000 01000000 78 00000000"),
        (
            "time a\nduration b\n",
            {"a": {"sec": -1, "nanosec": 2}, "b": {"sec": 1}},
            "ffffffff 02000000 01000000 00000000",
        ),
        (
            "Header header\n",
            {"header": {"stamp": {"sec": 1}, "frame_id": "m"}},
            "07000000 01000000 00000000 01000000 6d",
        ),
        ("geometry_msgs/Point32[] a\n", {"a": [{"x": 1.0}]}, "01000000 0000803f 00000000 00000000"),
    ],
)
def test_messages_are_laid_out_as_ros_1_does(definition: str, plain: dict[str, Any], body: str) -> None:
    registry = standard_registry()
    registry.add("my_msgs/M", definition)
    message = registry.from_plain("my_msgs/M", plain)
    assert serialize_ros1(registry, "my_msgs/M", message, 7) == bytes.fromhex(body)
