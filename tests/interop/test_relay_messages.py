"""What clients and nodes publish passes through the relay as it is meant to; against a real rclpy."""

import base64
import json
from collections.abc import Iterator, Mapping
from typing import Any, Final

import cbor2
import pytest

from tests.interop.programs import Client
from tests.interop.puppets import Puppet, Served, puppet, served
from tests.interop.ros2 import needs_ros2
from tests.patience import PATIENCE_S, wait_until
from tests.samples import Sample

pytestmark = needs_ros2
LATE: Final = 30
"""Large messages that may wait: on a busy machine this side reads later than the node sends, and that loses nothing."""


@pytest.fixture(scope="module")
def sides(around: Mapping[str, str]) -> Iterator[tuple[Served, Puppet]]:
    room = f"queued_bytes={2_000_000 * LATE}"
    with served(around, "--limit", room) as console, puppet(around) as node:
        yield console, node


def wait_for_topic(web: Client, name: str) -> None:
    """Wait until the console knows a topic of the graph."""

    def known() -> bool:
        web.say(op="call_service", id="list", service="/rosapi/topics")
        return name in web.hear(lambda heard: heard.get("id") == "list")["values"]["topics"]

    wait_until(known, f"{name} at the console")


@pytest.mark.parametrize("more", [{}, {"type": "std_msgs/String"}])
def test_publishing_without_advertising_reaches_nodes(web: Client, node: Puppet, more: dict[str, str]) -> None:
    name = f"/unadvertised/n{len(more)}"
    node.do("subscribe", name=name)
    wait_for_topic(web, name)

    def arrives() -> bool:
        web.say(op="publish", topic=name, msg={"data": "here"}, **more)
        return node.heard() == {"heard": name, "data": "here"}

    wait_until(arrives, "a message")
    node.do("destroy", kind="subscription", name=name)


def test_quality_of_service_is_applied_in_the_graph(web: Client, node: Puppet) -> None:
    qos = {"reliability": "BEST_EFFORT", "deadline": {"secs": 0, "nsecs": 250_000_000}, "lifespan": 2.5, "depth": 7}
    web.say(op="advertise", topic="/qos/said", type="std_msgs/String", qos=qos)
    web.say(op="advertise", topic="/qos/endless", type="std_msgs/String", qos={"lifespan": "infinite"})

    def offered(name: str) -> Any:
        node.do("offers", name=name)
        return node.hear(lambda said: said.get("offers") == name)["qos"]

    found = wait_until(lambda: offered("/qos/said"), "the publisher")
    assert found == [{"reliability": "BEST_EFFORT", "deadline_ns": 250_000_000, "lifespan_ns": 2_500_000_000}]
    found = wait_until(lambda: offered("/qos/endless"), "the publisher")
    assert (found[0]["reliability"], found[0]["lifespan_ns"]) == ("RELIABLE", 2**63 - 1)


def test_log_of_nodes_reaches_clients(web: Client, node: Puppet) -> None:
    web.say(op="subscribe", topic="/rosout", type="rcl_interfaces/msg/Log")

    def arrives() -> Any:
        node.do("log", text="hello from a node")
        web.say(op="call_service", id="end", service="/rosapi/get_time")
        while (heard := web.hear(lambda heard: True)).get("id") != "end":
            if heard["msg"]["msg"] == "hello from a node":
                return heard["msg"]
        return None

    log = wait_until(arrives, "what the node has logged")
    assert (log["name"], log["level"]) == ("puppet", 20)


@pytest.mark.parametrize(
    ("name", "kind", "latched", "data"),
    [
        ("/console/mode", "String", False, "PARKED"),
        ("/console/authority/lateral", "Float64", False, 1.0),
        ("/console/authority/longitudinal", "Float64", False, 1.0),
        ("/route", "Path", True, "map"),
    ],
)
def test_mode_authority_and_route_are_relayed_as_standard_messages(
    node: Puppet, name: str, kind: str, latched: bool, data: str | float
) -> None:
    node.do("subscribe", name=name, kind=kind, latched=latched)
    assert node.hear(lambda said: said.get("heard") == name)["data"] == data
    node.do("destroy", kind="subscription", name=name)


@pytest.mark.parametrize("compression", ["none", "cbor", "cbor-raw"])
@pytest.mark.parametrize("kind", ["Image", "PointCloud2"])
def test_pictures_and_clouds_pass_ten_times_a_second(
    web: Client, node: Puppet, kind: str, compression: str, sample: Sample
) -> None:
    """640x480 in colour, and a cloud of 1 MB: all that was published since the first arrives, in order."""
    name = f"/large/{kind.lower()}/{compression.replace('-', '_')}"
    web.say(op="subscribe", topic=name, type=f"sensor_msgs/msg/{kind}", compression=compression, queue_length=LATE)
    node.do("stream", name=name, kind=kind, hz=10.0)
    count = sample.of(6, 20)
    heard = [number(web.web.recv(timeout=PATIENCE_S), compression) for _ in range(count)]
    node.do("destroy", kind="stream", name=name)
    web.say(op="unsubscribe", topic=name)
    assert heard == list(range(heard[0], heard[0] + count))


def number(text: str | bytes, compression: str) -> int:
    """The number of a message of `stream`, whose data must be right."""
    if compression == "none":
        message = json.loads(text)["msg"]
        data, frame = base64.b64decode(message["data"]), message["header"]["frame_id"]
    else:
        assert isinstance(text, bytes)
        message = cbor2.loads(text)["msg"]
        if compression == "cbor-raw":
            data = message["bytes"]  # behind the stamp and the length of the name
            frame = data[16:].partition(b"\0")[0].decode()
        else:
            data, frame = message["data"], message["header"]["frame_id"]
    found = int(frame)
    assert bytes([found % 256]) * 900_000 in data
    return found
