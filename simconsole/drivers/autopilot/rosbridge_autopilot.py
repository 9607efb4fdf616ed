"""The driver on the ROS side: a program that uses only rosbridge and follows the route of a world (shell).

It answers every odometry with one command that carries the odometry's own stamp, so that a console in lockstep knows
which state the command was made for; also while a person drives, so that engagement finds a fresh command. What people
must know is logged: why it gives no commands (`answers`), and why the console refused one. One program drives several
cars that are alike, each in its namespace: what it answers to odometry that came together goes together.
"""

import logging
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, NamedTuple

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.protocol.backoff import DEAD_AFTER_S
from simconsole.drivers.autopilot.advised import Advised
from simconsole.drivers.autopilot.answers import Answers, make_tracker
from simconsole.drivers.autopilot.lights import SIGNALS, SIGNALS_TYPE, lights_of, signal_stops
from simconsole.drivers.autopilot.motion import Odometry, motion_of
from simconsole.drivers.autopilot.others import ROAD_USERS, ROAD_USERS_TYPE, Others, road_users_of
from simconsole.drivers.autopilot.plan_message import PLAN, PLAN_TYPE, PlanMessages
from simconsole.drivers.autopilot.remarks import Remarks
from simconsole.drivers.autopilot.yields import yields
from simconsole.drivers.path_tracker.car_model import car_model
from simconsole.drivers.path_tracker.tracker import TrackerCommand
from simconsole.drivers.path_tracker.tracker_settings import GATE, TIMING, TRACKERS, Gate
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.files.world_files import load_world
from simconsole.values.errors import BridgeError, OtherDriveError
from simconsole.values.host.jit import compiled
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.speed_advice import to_bytes

ODOMETRY: Final = "/odom"
MODE: Final = "/console/mode"
ADVICE: Final = "/autopilot/advice"
ADVICE_TYPE: Final = "std_msgs/String"
COMMAND: Final = "/control/command/control_cmd"
CONTROL: Final = "autoware_control_msgs/Control"

_DRIVING: Final = frozenset(map(mode_label, (Mode.AUTONOMOUS, Mode.SHARED, Mode.TAKEOVER_REQUESTED)))
"""In the other modes the remote share belongs to the console itself: a parking hold or a stop."""
_PATIENCE_S: Final = 10.0  # for the console to open its port
_WAIT_S: Final = 0.25  # how often `stop` is checked while no message comes

_logger = logging.getLogger("simconsole.drivers.autopilot.rosbridge_autopilot")


class Topics(NamedTuple):
    """Names of topics on the server."""

    odometry: str
    mode: str
    command: str
    signals: str
    road_users: str
    plan: str
    advice: str


STANDARD: Final = Topics(
    odometry=ODOMETRY, mode=MODE, command=COMMAND, signals=SIGNALS, road_users=ROAD_USERS, plan=PLAN, advice=ADVICE
)


def run(
    url: str,
    course_name: str,
    *,
    stop: Callable[[], bool] | None = None,
    namespaces: Sequence[str] = ("",),
    rename: Mapping[str, str] | None = None,
    patience_s: float = _PATIENCE_S,
    token: str | None = None,
    certificate: str | None = None,
    drive: str | None = None,
    vehicle: str = "hatchback",
    delay_s: float = TIMING.delay_s,
    tracker: str = TRACKERS[0],
    gate: Gate = GATE,
    dead_after_s: float = DEAD_AFTER_S,
    plan_hz: float = 0.0,
    speed_advice: bool = False,
) -> dict[str, Any]:
    """Drive until the server ends the session, is gone for `patience_s`, or `stop()` is true; return statistics.

    They are those of the car; of several, `cars` has those of each by its namespace.

    Args:
        url: the rosbridge server, `ws://HOST:PORT`.
        course_name: a world profile, by name or path.
        stop: called after every message and four times a second.
        namespaces: of each car what is put before every topic, `/car1`.
        rename: names of topics in place of the standard ones; they win over the namespace.
        patience_s: how long to try to connect, at the start and after a connection was lost.
        token: shown to the server.
        certificate: a PEM file that a wss:// server is checked against.
        drive: the nonce of the drive that has started this program, if one has; shown to the server, too.
        vehicle: the profile of the car, by name or path.
        delay_s: from an odometry's stamp to the moment at which the command that answers it acts.
        tracker: how it steers, one of `tracker_settings.TRACKERS`.
        gate: what the console lets pass of it.
        dead_after_s: as `BridgeClient` takes it.
        plan_hz: how often a second it tells what it plans, in the odometry's time; 0: never.
        speed_advice: come to lights at green where a legal speed does so, by what their messages tell.

    Raises:
        ProfileError: the world cannot be read.
        BridgeError: no server answers at `url`.
        OtherDriveError: the server there belongs to another drive.
    """
    world, vehicle_profile = open_world(load_world(course_name)), load_vehicle(vehicle)

    def answers(namespace: str) -> Answers:
        lights = signal_stops(world, vehicle_profile)
        return Answers(
            make_tracker(tracker, world.route, car_model(vehicle_profile), delay_s, gate),
            lambda what: _say(f"{namespace}: {what}" if namespace else what),
            lights,
            None if roads_of(world) is None else Others(world.route, vehicle_profile, compiled),
            yields(world, vehicle_profile, lights),
            Advised() if speed_advice else None,
        )

    with BridgeClient(
        url,
        token=token,
        certificate=certificate,
        drive=drive,
        until_good_bye=True,
        dead_after_s=dead_after_s,
        answers_together=len(namespaces) > 1,
    ) as client:
        ground = world.ground if plan_hz > 0.0 else None
        cars = {
            namespace: _Car(
                client,
                Topics._make((rename or {}).get(topic, namespace + topic) for topic in STANDARD),
                answers(namespace),
                PlanMessages(client.registry, plan_hz, ground),
            )
            for namespace in namespaces
        }
        client.connect(patience_s)
        try:
            ended = _drive(client, list(cars.values()), stop or _never, patience_s)
        except OtherDriveError:
            raise
        except BridgeError as error:
            ended = str(error)
        results = {"url": url, "course": course_name, "ended": ended, "connections": client.connections}
    told = {namespace: car.answers.statistics.results() for namespace, car in cars.items()}
    return {**results, **(told[namespaces[0]] if len(told) == 1 else {"cars": told})}


class _Car:
    """One car that is driven: its topics, and what answers its odometry."""

    def __init__(self, client: BridgeClient, topics: Topics, answers: Answers, plans: PlanMessages) -> None:
        """Ask the client for what concerns the car."""
        self.topics, self.answers = topics, answers
        self._client, self._plans = client, plans
        self._command = client.registry.struct(CONTROL)()
        # A console publishes who drives; with a server that does not, this program drives from the start.
        self._engaged = True
        client.advertise(topics.command, CONTROL)
        if plans.hz > 0.0:
            client.advertise(topics.plan, PLAN_TYPE)
        if answers.is_advised:
            client.advertise(topics.advice, ADVICE_TYPE)
        client.subscribe(topics.odometry, "nav_msgs/Odometry", reads=Odometry)
        client.subscribe(topics.mode, "std_msgs/String")
        if answers.sees_lights:
            client.subscribe(topics.signals, SIGNALS_TYPE)
        if answers.sees_others:
            client.subscribe(topics.road_users, ROAD_USERS_TYPE)

    def take(self, topic: str, message: Any) -> None:
        """Take a message of one of its topics; answer odometry with a command."""
        if topic == self.topics.signals:
            self.answers.see(lights_of(message))
        elif topic == self.topics.road_users:
            self.answers.see_others(*road_users_of(message))
        elif topic == self.topics.odometry:
            self._answer(message)
        else:
            self._engaged = message.data in _DRIVING

    def _answer(self, message: Any) -> None:
        client, answers, topics = self._client, self.answers, self.topics
        seen = motion_of(message)
        if seen is None:
            answers.statistics.skipped += 1
            return
        stamp = message.header.stamp
        stamp_s = stamp.sec + stamp.nanosec * 1e-9
        answer = answers.answer(seen, self._engaged, stamp_s)
        if (advice := answers.advice()) is not None:  # before the command, with which a console in lockstep goes on
            client.publish(topics.advice, {"data": to_bytes(advice).decode()})
        if answer is not None:
            fill_command(self._command, stamp, answer)
            client.publish(topics.command, self._command)
        if self._plans.is_due(stamp_s):  # after the command, which must not wait for it
            client.publish(topics.plan, self._plans.message(stamp, answers.planned(seen)))


def _drive(client: BridgeClient, cars: Sequence[_Car], stop: Callable[[], bool], patience_s: float) -> str:
    """Answer the odometry of cars with commands until `stop` or until the server is gone; return which of both.

    A lost connection is opened again.

    Raises:
        BridgeError: the server has ended the session.
    """
    of_topic = {topic: car for car in cars for topic in car.topics}
    remarks = Remarks(_say)
    heard_s = time.monotonic()
    while not stop():
        received = client.receive(_WAIT_S)
        remarks.tell(client.statuses)
        if client.connected:
            heard_s = time.monotonic()
        elif time.monotonic() - heard_s > patience_s:
            return client.failure
        if received is not None:
            topic, message = received
            of_topic[topic].take(topic, message)
    return "stopped"


def fill_command(command: Any, stamp: Any, answer: TrackerCommand) -> None:
    """Write an answer into an autoware_control_msgs/Control; all its stamps are the odometry's."""
    lateral, longitudinal = command.lateral, command.longitudinal
    command.stamp = lateral.stamp = longitudinal.stamp = stamp
    command.control_time = lateral.control_time = longitudinal.control_time = stamp
    lateral.steering_tire_angle = answer.road_wheel_rad
    lateral.steering_tire_rotation_rate = answer.road_wheel_radps
    lateral.is_defined_steering_tire_rotation_rate = True
    longitudinal.velocity = answer.speed_mps
    longitudinal.acceleration = answer.accel_mps2
    longitudinal.jerk = answer.jerk_mps3
    longitudinal.is_defined_acceleration = True
    longitudinal.is_defined_jerk = True


def _say(what: str) -> None:
    _logger.warning("autopilot: %s", what)


def _never() -> bool:
    return False
