from typing import Any, NamedTuple

import pytest

from simconsole.bridge.protocol.client_protocol import Received
from simconsole.drivers.robots.nodes.fleet_program import Drivers, drive
from simconsole.drivers.robots.nodes.shared_client import NodePort, SharedClient
from tests.drivers.robots.nodes.stub_client import StubClient

DONE_NS = 3


class Node:
    """Answers odometry; one that waits for SLAM takes what else has come meanwhile."""

    def __init__(self, port: NodePort, topic: str, looks_ahead: int) -> None:
        self.answered_ns = 0
        self.answered: list[int] = []
        self._port, self._looks_ahead = port, looks_ahead
        self._topic = topic
        port.subscribe(topic, "nav_msgs/Odometry")
        port.subscribe("/tf", "tf2_msgs/TFMessage")

    def is_asked(self, received: Received) -> bool:
        return received.topic == self._topic

    def take(self, topic: str, time_ns: int) -> None:
        if topic != self._topic:
            return
        ahead = [self._port.receive(0.0) for _ in range(self._looks_ahead)]
        assert self._topic not in [one.topic for one in ahead if one is not None]
        self.answered_ns = time_ns
        self.answered.append(time_ns)


class Done(NamedTuple):
    """A team whose last task is one robot's."""

    node: Node

    @property
    def is_done(self) -> bool:
        return self.node.answered_ns >= DONE_NS


@pytest.mark.parametrize("echo", [0, 1])
@pytest.mark.parametrize("looks_ahead", [0, 1, 2])
@pytest.mark.parametrize("last", [0, 1, 2])
def test_a_drive_in_lockstep_ends_at_one_time_whatever_has_come_when_its_last_task_is_done(
    last: int, looks_ahead: int, echo: int
) -> None:
    """With an echo, what a node has published of its last task comes back before the server asks again."""
    client = StubClient()
    shared = SharedClient(client)
    ports = [shared.port() for _ in range(3)]
    nodes = [Node(port, f"/{number}", looks_ahead if number == last else 0) for number, port in enumerate(ports)]
    client.coming = [
        Received(topic, time_ns) for time_ns in range(1, 9) for topic in ("/0", "/1", "/2", *("/tf",) * echo)
    ]
    drivers: Drivers = list(zip(ports, nodes, strict=True))
    team: Any = Done(nodes[last])
    assert drive(shared, drivers, team, lambda: False, True, lambda team: None) == "mission done"
    assert [node.answered for node in nodes] == [[1, 2, 3]] * 3
    assert DONE_NS + 1 in [one.message for port in ports for one in port.waiting if one.topic != "/tf"]


def test_a_drive_by_the_clock_ends_with_its_last_task() -> None:
    client = StubClient()
    shared = SharedClient(client)
    port = shared.port()
    node = Node(port, "/0", 0)
    client.coming = [Received("/0", time_ns) for time_ns in range(1, 9)]
    team: Any = Done(node)
    assert drive(shared, [(port, node)], team, lambda: False, False, lambda team: None) == "mission done"
    assert not port.waiting
    assert client.coming
