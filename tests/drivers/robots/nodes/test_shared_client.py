from typing import Any

from simconsole.bridge.protocol.client_protocol import Received
from simconsole.drivers.robots.nodes.shared_client import SharedClient
from tests.drivers.robots.nodes.stub_client import StubClient

KIND = "std_msgs/String"


def shared() -> tuple[StubClient, SharedClient]:
    client = StubClient()
    return client, SharedClient(client)


def test_each_node_gets_what_it_subscribed_to() -> None:
    client, hub = shared()
    first, second = hub.port(), hub.port()
    first.subscribe("/a", KIND)
    second.subscribe("/a", KIND)
    second.subscribe("/b", KIND)
    client.coming = [Received("/a", 1), Received("/b", 2)]
    assert hub.pump(0.0)
    assert hub.pump(0.0)
    assert not hub.pump(0.0)
    assert [received.message for received in first.waiting] == [1]
    assert [received.message for received in second.waiting] == [1, 2]


def test_a_node_that_waits_for_nobody_gets_its_messages_while_another_one_waits() -> None:
    client, hub = shared()
    waits, prompt = hub.port(), hub.port()
    taken: list[tuple[str, Any]] = []
    prompt.at_once = lambda topic, message: taken.append((topic, message))
    waits.subscribe("/a", KIND)
    prompt.subscribe("/b", KIND)
    client.coming = [Received("/b", 1), Received("/a", 2)]
    assert waits.receive(0.0) is None
    assert taken == [("/b", 1)]
    assert waits.receive(0.0) == Received("/a", 2)
    assert not prompt.waiting


def test_what_nodes_publish_goes_over_the_one_connection() -> None:
    client, hub = shared()
    port = hub.port()
    port.advertise("/a", KIND)
    port.advertise_action("/go", "nav2_msgs/action/NavigateToPose", lambda goal: None)
    assert port.publish("/a", {"data": "x"})
    assert client.told["/a"][0].data == "x"
    assert list(client.actions) == ["/go"]
