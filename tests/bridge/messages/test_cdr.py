from typing import Any

import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.cdr import deserialize, serialize
from simconsole.values.errors import RemoteProtocolError

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
    data = serialize(registry, "demo/Case", message)
    assert data == HEADER + bytes.fromhex(body)
    assert registry.from_plain("demo/Case", deserialize(registry, "demo/Case", data)) == message
    for length in range(len(data)):
        with pytest.raises(RemoteProtocolError, match="CDR"):
            deserialize(registry, "demo/Case", data[:length])


def test_length_of_an_odometry() -> None:
    registry = standard_registry()
    data = serialize(registry, "nav_msgs/Odometry", registry.struct("nav_msgs/Odometry")())
    # Header 8 + 4 + 1, child frame at 16: 4 + 1, then 7 + 36 + 6 + 36 doubles from 24 on.
    assert len(data) == 4 + 24 + 85 * 8


def test_big_endian_is_read() -> None:
    registry = standard_registry()
    registry.add("demo/Case", "uint8 a\nfloat64[] b\nwstring c\n")
    data = b"\0\0\0\0" + bytes.fromhex("07000000 00000001 4000000000000000 00000002 006800e9")
    assert deserialize(registry, "demo/Case", data) == {"a": 7, "b": [2.0], "c": "hé"}


@pytest.mark.parametrize("body", ["ffffffff", "ffffffff 00", "02000000 ff00", "03000000 ffffff"])
def test_hostile_strings(body: str) -> None:
    registry = standard_registry()
    with pytest.raises(RemoteProtocolError, match="do not fit"):
        deserialize(registry, "std_msgs/String", HEADER + bytes.fromhex(body))


def test_bytes_after_the_end_are_padding() -> None:
    data = HEADER + bytes.fromhex("02000000 6100 0000")
    assert deserialize(standard_registry(), "std_msgs/String", data) == {"data": "a"}
