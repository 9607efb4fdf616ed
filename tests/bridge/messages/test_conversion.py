import pytest

from simconsole.bridge.messages import Registry, standard_registry
from simconsole.values.errors import RemoteProtocolError


@pytest.fixture
def registry() -> Registry:
    return standard_registry()


@pytest.mark.parametrize("stamp", [{"sec": 3, "nanosec": 5}, {"secs": 3, "nsecs": 5}, {"sec": 3, "nsec": 5}])
def test_every_spelling_of_a_time(registry: Registry, stamp: dict[str, int]) -> None:
    message = registry.from_plain("nav_msgs/Odometry", {"header": {"stamp": stamp}})
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (3, 5)


def test_now_is_the_time_given(registry: Registry) -> None:
    message = registry.from_plain("rosgraph_msgs/Clock", {"clock": "now"}, now_ns=2_000_000_007)
    assert (message.clock.sec, message.clock.nanosec) == (2, 7)


def test_seq_of_ros1_is_dropped_from_headers_only(registry: Registry) -> None:
    registry.from_plain("nav_msgs/Path", {"header": {"seq": 7}, "poses": [{"header": {"seq": 8}}]})
    with pytest.raises(RemoteProtocolError, match="seq"):
        registry.from_plain("geometry_msgs/Point", {"seq": 7})


def test_octets_as_list_and_as_base64(registry: Registry) -> None:
    for data in ([0, 127, 255], "AH//"):
        assert registry.from_plain("std_msgs/UInt8MultiArray", {"data": data}).data == b"\x00\x7f\xff"


@pytest.mark.parametrize("stamp", ["later", 5, [], {"sec": 1, "secs": 2, "x": 3}, {"sec": 2**31}, {"sec": 1.5}])
def test_what_is_no_time(registry: Registry, stamp: object) -> None:
    with pytest.raises(RemoteProtocolError):
        registry.from_plain("rosgraph_msgs/Clock", {"clock": stamp})


def test_hostile_depth_costs_no_recursion(registry: Registry) -> None:
    deep: object = 0
    for _ in range(1000):
        deep = {"header": deep, "stamp": [deep]}
    with pytest.raises(RemoteProtocolError):
        registry.from_plain("nav_msgs/Odometry", deep)
