"""SLAM, navigation and task allocation of several robots as one program on the ROS side, over one WebSocket."""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.protocol.backoff import DEAD_AFTER_S
from simconsole.bridge.protocol.client_protocol import Received
from simconsole.drivers.robots.fleet.team import Team
from simconsole.drivers.robots.nodes.navigation_node import NavigationNode
from simconsole.drivers.robots.nodes.shared_client import NodePort, SharedClient
from simconsole.drivers.robots.nodes.slam_node import WAIT_S, SlamNode, StampedPose
from simconsole.drivers.robots.slam.mapper import SharedMap
from simconsole.values.errors import BridgeError
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from simconsole.world.arena.occupancy import Grid


class Robot(NamedTuple):
    """One robot of the program."""

    namespace: str  # of its topics and frames, `/tb3_0`
    start: Pose  # in map


class FleetDriven(NamedTuple):
    """What the program has made of a drive."""

    grid: Grid | None  # None: there was no scan
    moments: list[list[StampedPose]]  # where SLAM had each robot
    commands: int
    ended: str  # why


class Answering(Protocol):
    """What drives one robot, as `NavigationNode`."""

    answered_ns: int

    def is_asked(self, received: Received) -> bool:
        """Return whether this is odometry that the robot is to answer."""

    def take(self, topic: str, message: Any) -> None:
        """Take a message; answer odometry."""


Drivers = Sequence[tuple[NodePort, Answering]]


def run(
    url: str,
    robots: Sequence[Robot],
    team: Team,
    *,
    stop: Callable[[], bool] = lambda: False,
    lockstep: bool = True,
    patience_s: float = 10.0,
    told: Callable[[Team], None] = lambda team: None,
) -> FleetDriven:
    """Drive until the team is done, the server ends the session, or `stop()` is true.

    Args:
        url: the rosbridge server, `ws://HOST:PORT`.
        robots: in the order of the team's members.
        team: what they do.
        stop: called after every message and four times a second.
        lockstep: the console waits for each command; else nobody waits, and a server that is silent is gone.
        patience_s: how long to try to connect.
        told: called likewise, with the team.

    Raises:
        BridgeError: no server answers at `url`.
    """
    shared_map = SharedMap(compiled)
    with BridgeClient(url, until_good_bye=True, dead_after_s=math.inf if lockstep else DEAD_AFTER_S) as client:
        shared = SharedClient(client)
        slams = [_slam(shared.port(), shared_map, robot) for robot in robots]
        drivers = [_driver(shared.port(), robot, number, team, lockstep) for number, robot in enumerate(robots)]
        shared_map.warm_up()
        for member in team.members:
            member.navigator.warm_up()
        client.connect(patience_s)
        try:
            ended = drive(shared, drivers, team, stop, lockstep, told)
        except BridgeError as error:
            ended = str(error)
    commands = sum(node.commands for _, node in drivers)
    return FleetDriven(shared_map.grid, [node.moments for node in slams], commands, ended)


def drive(
    shared: SharedClient,
    drivers: Drivers,
    team: Team,
    stop: Callable[[], bool],
    lockstep: bool,
    told: Callable[[Team], None],
) -> str:
    """Drive until the team is done or `stop()` is true; return which.

    Args:
        shared: the connection.
        drivers: the robots' nodes, and their shares of it.
        team: what they do.
        stop: as of `run`, likewise the others.
        lockstep: the console waits for each command.
        told: called after every message, with the team.

    Raises:
        BridgeError: the connection has ended.
    """
    while not stop() and not team.is_done:
        _take(shared, drivers)
        told(team)
    if not team.is_done:
        return "stopped"
    if lockstep:
        # A server that waits sees in the very tick that its client is gone. Which tick that is must not depend on which
        # messages had come when the last task was done: all robots answer what is of that time, and nothing later.
        done_ns = max(node.answered_ns for _, node in drivers)
        while not stop() and any(node.answered_ns < done_ns for _, node in drivers):
            _take(shared, drivers)
        while not stop() and not any(node.is_asked(one) for port, node in drivers for one in port.waiting):
            shared.pump(WAIT_S)
    return "mission done"


def _take(shared: SharedClient, drivers: Drivers) -> None:
    """Take one message, and those that came while a robot waited for SLAM."""
    shared.pump(WAIT_S)
    for port, node in drivers:
        while port.waiting:
            node.take(*port.waiting.popleft())


def _slam(port: NodePort, shared_map: SharedMap, robot: Robot) -> SlamNode:
    node = SlamNode(port, shared_map, robot.start, robot.namespace)
    port.at_once = node.take
    return node


def _driver(port: NodePort, robot: Robot, number: int, team: Team, lockstep: bool) -> tuple[NodePort, NavigationNode]:
    member = team.members[number]
    node = NavigationNode(
        port,
        member.navigator,
        member,
        namespace=robot.namespace,
        lockstep=lockstep,
        yields=lambda time_s, pose: team.yields(number, time_s, pose),
        heard=lambda time_s, obeys: team.hear(number, time_s, obeys),
    )
    return port, node
