from typing import Any

import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.cdr import serialize

HEADER = b"\x00\x01\x00\x00"


@pytest.mark.parametrize(
    ("definition", "plain", "body"),
    [
        ("", {}, "00"),
        ("uint8 a\nuint32 b\nbool c\n", {"a": 1, "b": 2, "c": True}, "01000000 02000000 01"),
        ("uint8 a\nfloat64 b\n", {"a": 1, "b": 1.0}, "0100000000000000 000000000000f03f"),
        ("string a\nuint16 b\n", {"a": "hé", "b": 3}, "04000000 68c3a900 0300"),
        ("uint8[] a\n", {"a": [7, 8]}, "02000000 0708"),
        ("uint8[2] a\nint16[<=3] b\n", {"a": [7, 8], "b": [-1]}, "07080000 01000000 ffff"),
        ("float64[] a\n", {"a": []}, "00000000"),
        ("string[] a\n", {"a": ["x", ""]}, "02000000 02000000 78000000 01000000 00"),
        ("wstring a\n", {"a": "hé"}, "02000000 6800e900"),
        ("builtin_interfaces/Time[] a\n", {"a": [{"sec": 1, "nanosec": 2}]}, "01000000 01000000 02000000"),
    ],
)
def test_bytes_of_a_message(definition: str, plain: dict[str, Any], body: str) -> None:
    registry = standard_registry()
    registry.add("demo/Case", definition)
    message = registry.from_plain("demo/Case", plain)
    assert serialize(registry, "demo/Case", message) == HEADER + bytes.fromhex(body)


def test_length_of_an_odometry() -> None:
    registry = standard_registry()
    data = serialize(registry, "nav_msgs/Odometry", registry.struct("nav_msgs/Odometry")())
    # Header 8 + 4 + 1, child frame at 16: 4 + 1, then 7 + 36 + 6 + 36 doubles from 24 on.
    assert len(data) == 4 + 24 + 85 * 8
