import math
from typing import Any

import msgspec
import pytest

from simconsole.bridge.messages import Registry, is_stamped, standard_registry
from simconsole.values.errors import BridgeError, RemoteProtocolError


@pytest.fixture
def registry() -> Registry:
    return standard_registry()


def test_every_standard_type_can_be_made_encoded_and_read_back(registry: Registry) -> None:
    assert len(registry.names()) >= 60
    for name in registry.names():
        message = registry.struct(name)()
        plain = msgspec.json.decode(msgspec.json.encode(message))
        assert registry.from_plain(name, plain) == message


def test_defaults_are_the_definition_s(registry: Registry) -> None:
    assert registry.struct("geometry_msgs/Quaternion")().w == 1.0
    odometry = registry.struct("nav_msgs/msg/Odometry")()
    assert odometry.pose.pose.orientation.w == 1.0
    assert odometry.pose.covariance == [0.0] * 36


def test_default_arrays_are_not_shared(registry: Registry) -> None:
    registry.add("demo/Two", "geometry_msgs/Point[2] points\nfloat64[] values [1.5]")
    two = registry.struct("demo/Two")
    first, second = two(), two()
    first.points[0].x = 1.0
    first.values.append(2.0)
    assert second.points[0].x == 0.0
    assert second.values == [1.5]


def test_constants_are_attributes(registry: Registry) -> None:
    assert registry.struct("autoware_vehicle_msgs/GearCommand").REVERSE == 20
    assert registry.struct("autoware_vehicle_msgs/ControlModeReport").MANUAL == 4


@pytest.mark.parametrize(
    ("name", "value", "path"),
    [
        ("nav_msgs/Odometry", {"pose": {"covariance": [0.0] * 35}}, "$.pose.covariance"),
        ("nav_msgs/Odometry", {"pose": {"pose": {"position": {"x": "1"}}}}, "$.pose.pose.position.x"),
        ("nav_msgs/Odometry", {"speed": 1}, "unknown field `speed`"),
        ("std_msgs/UInt8", {"data": 256}, "$.data"),
        ("std_msgs/UInt8", {"data": -1}, "$.data"),
        ("std_msgs/Int64", {"data": 2**63}, "$.data"),
        ("std_msgs/UInt64", {"data": -1}, "$.data"),
        ("std_msgs/Bool", {"data": 1}, "$.data"),
        ("std_msgs/Float64", {"data": True}, "$.data"),
        ("std_msgs/String", {"data": 5}, "$.data"),
        ("std_msgs/String", [], "Expected `object`"),
        ("sensor_msgs/Joy", {"buttons": [1, "2"]}, "$.buttons"),
        ("std_msgs/UInt8MultiArray", {"data": [1, 256]}, "$.data"),
        ("std_msgs/UInt8MultiArray", {"data": "not base64!"}, "$.data"),
    ],
)
def test_refusal_names_the_path(registry: Registry, name: str, value: Any, path: str) -> None:
    with pytest.raises(RemoteProtocolError) as caught:
        registry.from_plain(name, value)
    assert path in str(caught.value)


def test_integers_are_fine_for_floats(registry: Registry) -> None:
    assert registry.from_plain("std_msgs/Float64", {"data": 3}).data == 3.0


def test_null_is_nan_where_gaps_are_allowed(registry: Registry) -> None:
    assert math.isnan(registry.from_plain("std_msgs/Float64", {"data": None}).data)
    scan = registry.from_plain("sensor_msgs/LaserScan", {"ranges": [1.0, None]})
    assert scan.ranges[0] == 1.0
    assert math.isnan(scan.ranges[1])
    with pytest.raises(RemoteProtocolError, match="null"):
        registry.from_plain("std_msgs/Float64", {"data": None}, gaps=False)


def test_null_is_nothing_but_a_float(registry: Registry) -> None:
    for name in ("std_msgs/String", "std_msgs/Int32", "std_msgs/Bool"):
        with pytest.raises(RemoteProtocolError, match="null"):
            registry.from_plain(name, {"data": None})


def test_nan_goes_out_as_null(registry: Registry) -> None:
    message = registry.struct("nav_msgs/Odometry")()
    message.pose.covariance[3] = math.nan
    message.pose.pose.position.x = math.inf
    plain = msgspec.json.decode(msgspec.json.encode(message))
    assert plain["pose"]["covariance"][3] is None
    assert plain["pose"]["pose"]["position"]["x"] is None


def test_own_instance_passes_unchanged(registry: Registry) -> None:
    message = registry.struct("std_msgs/String")("x")
    assert registry.from_plain("std_msgs/String", message) is message


def test_unknown_type(registry: Registry) -> None:
    with pytest.raises(BridgeError, match="demo/msg/Nothing is not known"):
        registry.resolve("demo/Nothing")


def test_type_that_uses_an_unknown_one_names_both(registry: Registry) -> None:
    registry.add("demo/A", "demo/Missing m")
    with pytest.raises(BridgeError, match="demo/msg/A: uses demo/msg/Missing"):
        registry.struct("demo/A")


def test_type_that_contains_itself_is_refused(registry: Registry) -> None:
    registry.add_all("MSG: demo/A\nB b\n===\nMSG: demo/B\nA[] a\n")
    with pytest.raises(BridgeError, match="contains itself"):
        registry.struct("demo/A")


def test_second_definition_must_be_the_same(registry: Registry) -> None:
    registry.add("std_msgs/String", "string data")
    with pytest.raises(BridgeError, match="already defined differently"):
        registry.add("std_msgs/String", "string text")


def test_bad_default_is_found_when_the_type_is_made(registry: Registry) -> None:
    registry.add("demo/A", 'float64[2] x ["a", "b"]')
    with pytest.raises(BridgeError, match="demo/msg/A: default of x"):
        registry.struct("demo/A")


def test_bounds_of_strings_and_arrays_hold(registry: Registry) -> None:
    registry.add("demo/A", "string<=3 s\nint8[<=2] n\nuint8[2] b")
    good = registry.from_plain("demo/A", {"s": "abc", "n": [1, 2], "b": [7, 8]})
    assert good.b == b"\x07\x08"
    for bad in ({"s": "abcd"}, {"n": [1, 2, 3]}, {"b": [1]}, {"b": [1, 2, 3]}):
        with pytest.raises(RemoteProtocolError):
            registry.from_plain("demo/A", bad)


def test_which_types_are_stamped(registry: Registry) -> None:
    assert is_stamped(registry.definition("nav_msgs/Odometry"))
    assert not is_stamped(registry.definition("geometry_msgs/Twist"))
    assert not is_stamped(registry.definition("std_msgs/Empty"))


def test_parts_of_services_and_actions() -> None:
    registry = standard_registry()
    for name in ("demo/Grip", "demo/srv/Grip"):
        registry.add_service(name, "float32 force_n\n---\nbool held\n")
    assert registry.part("demo/srv/Grip", "Request") == registry.part("demo/Grip", "Request")
    assert registry.struct("demo/Grip_Response")().held is False
    registry.add_action("demo/action/Lift", "float32 to_m\n---\n---\nfloat32 at_m\n")
    assert [bool(registry.part("demo/action/Lift", part)) for part in ("Goal", "Result", "Feedback")] == [True] * 3
    assert registry.part("demo/srv/Nothing", "Request") is None
    with pytest.raises(BridgeError, match="has 2 parts divided by ---, expected 3"):
        registry.add_action("demo/Half", "---\n")
