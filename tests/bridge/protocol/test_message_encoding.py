import json
import math
import struct
import tracemalloc
from typing import Any

import cbor2
import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.cdr import deserialize, serialize
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.protocol.message_encoding import PLAIN_JSON, Dialect, Encoder, Encoding, png, to_plain
from simconsole.bridge.protocol.operations import Compression
from tests.bridge.reading import unpacked

HEAD = b'{"op":"publish","topic":"/a","msg":'


def encoder(type_name: str, plain: dict[str, Any]) -> Encoder:
    registry = standard_registry()
    full = registry.resolve(type_name)
    return Encoder(registry, full, registry.from_plain(full, plain), 7, 3_000_000_004)


def test_json_of_both_dialects() -> None:
    made = encoder("sensor_msgs/Joy", {"header": {"stamp": {"sec": 1, "nanosec": 2}}, "axes": [0.5]})
    assert json.loads(made.text(PLAIN_JSON, HEAD, "/a"))["msg"]["header"] == {
        "stamp": {"sec": 1, "nanosec": 2},
        "frame_id": "",
    }
    old = made.text(Encoding("ros1"), HEAD, "/a")
    assert json.loads(old)["msg"] == {
        "header": {"seq": 7, "stamp": {"secs": 1, "nsecs": 2}, "frame_id": ""},
        "axes": [0.5],
        "buttons": [],
    }


def test_messages_within_messages_are_spelled_too() -> None:
    registry = standard_registry()
    plain = {"transforms": [{"header": {"stamp": {"sec": 4}}}]}
    message = registry.from_plain("tf2_msgs/TFMessage", plain)
    spelled = to_plain(registry, "tf2_msgs/msg/TFMessage", message, "ros1")
    assert spelled["transforms"][0]["header"]["stamp"] == {"secs": 4, "nsecs": 0}


@pytest.mark.parametrize("length", [0, 1, 5, 900, 10_001])
def test_png_carries_the_text(length: int) -> None:
    made = encoder("std_msgs/String", {"data": "é" * length})
    text = made.text(Encoding("ros2", "png"), HEAD, "/a")
    assert json.loads(text)["op"] == "png"
    assert json.loads(unpacked(text)) == {"op": "publish", "topic": "/a", "msg": {"data": "é" * length}}
    assert png(b"")


def test_cbor_has_typed_arrays_and_true_not_a_numbers() -> None:
    made = encoder("sensor_msgs/LaserScan", {"ranges": [1.5, None], "angle_min": None})
    text = made.text(Encoding("ros2", "cbor"), HEAD, "/a")
    assert isinstance(text, Binary)
    decoded = cbor2.loads(text)
    assert (decoded["op"], decoded["topic"]) == ("publish", "/a")
    ranges = decoded["msg"]["ranges"]
    assert ranges.tag == 85
    assert struct.unpack("<2f", ranges.value)[0] == 1.5
    assert math.isnan(decoded["msg"]["angle_min"])


def test_octets_are_a_byte_string_in_cbor() -> None:
    registry = standard_registry()
    registry.add("demo/Bytes", "uint8[] data\nint64[2] numbers\nbool[] flags\n")
    message = registry.from_plain("demo/Bytes", {"data": [1, 255], "numbers": [2**62, -1], "flags": [True]})
    made = Encoder(registry, "demo/msg/Bytes", message, 0, 0).text(Encoding("ros2", "cbor"), HEAD, "/a")
    fields = cbor2.loads(made)["msg"]
    assert (fields["data"], fields["flags"]) == (b"\x01\xff", [True])
    assert (fields["numbers"].tag, fields["numbers"].value) == (79, struct.pack("<2q", 2**62, -1))


def test_raw_cbor_carries_cdr_and_when_it_was_received() -> None:
    text = encoder("std_msgs/Int16", {"data": -2}).text(Encoding("ros2", "cbor-raw"), HEAD, "/a")
    assert cbor2.loads(text)["msg"] == {"secs": 3, "nsecs": 4, "bytes": b"\x00\x01\x00\x00\xfe\xff"}


def test_each_form_is_made_once_for_all() -> None:
    made = encoder("std_msgs/String", {"data": "x"})
    encoding = Encoding("ros2", "cbor")
    assert made.text(encoding, HEAD, "/a") is made.text(encoding, HEAD, "/a")
    assert made.text(encoding, HEAD.replace(b"/a", b"a"), "a") != made.text(encoding, HEAD, "/a")


def test_cbor_raw_is_ros_1_s_serialization_for_its_clients() -> None:
    registry = standard_registry()
    message = registry.from_plain("std_msgs/Header", {"stamp": {"sec": 1}, "frame_id": "m"})
    encoder = Encoder(registry, "std_msgs/msg/Header", message, 7, 0)
    raw = cbor2.loads(encoder.text(Encoding("ros1", "cbor-raw"), b"", "/h"))["msg"]["bytes"]
    assert raw == bytes.fromhex("07000000 01000000 00000000 01000000 6d")
    assert encoder.text(Encoding("ros2", "cbor-raw"), b"", "/h") != raw


@pytest.mark.parametrize("name", ["sensor_msgs/Image", "sensor_msgs/PointCloud2"])
@pytest.mark.parametrize("dialect", ["ros2", "ros1"])
@pytest.mark.parametrize("compression", ["none", "cbor", "cbor-raw"])
def test_octets_are_copied_not_packed_one_by_one(name: str, dialect: Dialect, compression: Compression) -> None:
    """A list of a million octets, whatever makes it, is eight times as large as they are."""
    registry = standard_registry()
    full, size = registry.resolve(name), 1_000_000
    data = serialize(registry, full, registry.from_plain(full, {"data": b"x" * size}))
    encoder(name, {}).text(Encoding(dialect, compression), HEAD, "/a")  # what is made once
    tracemalloc.start()
    try:
        message = registry.from_plain(full, deserialize(registry, full, data))
        text = Encoder(registry, full, message, 7, 0).text(Encoding(dialect, compression), HEAD, "/a")
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert len(text) > size
    assert peak < 7 * size
