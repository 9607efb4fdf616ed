"""A recorded drive as messages of topics: what a client of its bridge would have got, and the commands it took."""

from collections.abc import Callable, Iterator
from typing import Any, Final, NamedTuple

import msgspec
import numpy as np

from simconsole.bridge.console.camera_topics import CAMERA_TOPICS, CameraTopics
from simconsole.bridge.console.command_decoder import CommandDecoder
from simconsole.bridge.console.command_messages import CommandMessages
from simconsole.bridge.console.input_slots import BridgeInputs
from simconsole.bridge.console.output_schedule import OutputSchedule, topic_names
from simconsole.bridge.console.published_tick import RobotTable
from simconsole.bridge.console.road_user_topics import RoadUserTopics
from simconsole.bridge.console.topics import BRIDGE, ODOMETRY, Outputs, Route
from simconsole.bridge.console.view_topics import VIEW_TOPICS, view_topics
from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.cdr import serialize
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.session import SessionProfile
from simconsole.recording.framing import Message
from simconsole.recording.log_header import ACTS
from simconsole.recording.reading import Recording
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.values.kernels import Row
from simconsole.values.signals import NO_COMMAND, NO_EVENTS, NO_SAMPLE, NO_SITUATION
from simconsole.values.state_vector import INPUT_WIDTH, LAYOUT, PLATFORM_AT, Snapshot, TickInputs, input_vector
from simconsole.values.units import tick_time_ns
from simconsole.vehicle.turtlebot.robot_state import ROBOT
from simconsole.world.rules.road_signals import RoadSignals
from simconsole.world.rules.running_signals import RunningSignals
from simconsole.world.traffic.road_users import NOBODY_AT_ALL
from simconsole.world.world import NO_MAP, ShownMap

OnTick = Callable[[int], None]
"""Told, now and then, the last tick that was written."""

UNRECORDED: Final = (BRIDGE, *VIEW_TOPICS, *CAMERA_TOPICS)
"""Topics whose content is not in the log: counters of connections, and a view that is made from the world."""


ACTS_TOPIC: Final = "/console/acts"
ACTS_TYPE: Final = "std_msgs/msg/String"
"""What operators did, with their notes: the JSON of the log's stream of acts."""


class TopicMessage(NamedTuple):
    """One message as it was published: CDR, and its simulated time."""

    topic: str
    type: str
    latched: bool
    time_ns: int
    data: bytes


class DriveTopics:
    """Makes the messages of one drive, in the order of their times, by the code that the bridge has."""

    def __init__(
        self,
        session: SessionProfile,
        route: Route = (),
        signals: RoadSignals | None = None,
        shown: ShownMap = NO_MAP,
        robot: RobotTable | None = None,
    ) -> None:
        """Take names and rates of the session's bridge, or of a bridge as shipped where it has none.

        `route` is what /route shows, `signals` are the world's traffic lights or those that another simulator ran,
        `shown` its map; `robot` makes the topics of what was driven if it was one.

        Raises:
            ProfileError: the session's bridge renames or rates a topic that does not exist.
        """
        profile = session.outputs.bridge or BridgeProfile()
        self.registry = standard_registry()
        self._step_ticks = 1
        self._lockstep = session.mode.pacing == "lockstep"
        if self._lockstep:
            self._step_ticks = session.mode.control_period_ticks
            profile = msgspec.structs.replace(profile, rates_hz={**profile.rates_hz, ODOMETRY: session.mode.control_hz})
        self._outputs = Outputs(self.registry, profile, route=route, signals=signals, shown_map=shown, robot=robot)
        self._robot = robot
        self._signals = signals if isinstance(signals, RunningSignals) else None
        outputs = (*view_topics(self.registry, profile), *self._outputs.topics())
        if profile.camera is not None:
            outputs = (*outputs, *CameraTopics(self.registry, profile.camera, lambda: None).topics())
        commands = CommandDecoder(BridgeInputs(), profile, is_robot=robot is not None).topics()
        self._road_users = NOBODY_AT_ALL
        if session.environment.traffic is not None:
            outputs = (*RoadUserTopics(self.registry, lambda: self._road_users).topics(), *outputs)
        self.names = topic_names(profile, [*(topic.name for topic in outputs), *(topic.name for topic in commands)])
        recorded = tuple(output for output in outputs if output.name not in UNRECORDED)
        self.names[ACTS_TOPIC] = profile.namespace + ACTS_TOPIC
        self._command_types = {command.name: self.registry.resolve(command.type) for command in commands}
        rates_hz = {name: rate for name, rate in profile.rates_hz.items() if name not in UNRECORDED}
        self._schedule = OutputSchedule(recorded, self.names, msgspec.structs.replace(profile, rates_hz=rates_hz))
        self._output_types = {output.standard: self.registry.resolve(output.type) for output in self._schedule.outputs}

    def messages(self, recording: Recording, on_tick: OnTick = lambda tick: None) -> Iterator[TopicMessage]:
        """Yield every message of a recording. Memory does not grow with its length."""
        commands = CommandMessages(self.registry, self._command_types)
        acts = _acts(recording)
        act = next(acts, None)
        steps = recorded_road_users(recording)
        step = next(steps, None)
        for snapshot in snapshots(recording, on_tick, () if self._robot is None else ROBOT.names):
            sent_ns = tick_time_ns(snapshot.tick - 1, snapshot.tick_hz)
            while act is not None and act.tick <= snapshot.tick:
                text = self.registry.struct(ACTS_TYPE)(act.content.decode("utf-8", "replace"))
                yield self._message(ACTS_TOPIC, ACTS_TYPE, False, sent_ns, text)
                act = next(acts, None)
            for name, message in commands.of(snapshot):
                yield self._message(name, self._command_types[name], False, sent_ns, message)
            while step is not None and step.tick <= snapshot.tick:
                self._road_users, step = step, next(steps, None)
                if self._signals is not None:
                    self._signals.take(self._road_users.signals)
            if snapshot.tick % self._step_ticks:
                continue
            published = None
            for output in self._schedule.due(snapshot, odometry=self._lockstep):
                published = published or self._outputs.published_tick(snapshot)
                type_name, message = self._output_types[output.standard], output.build(published)
                yield self._message(output.standard, type_name, output.latched, snapshot.t_ns, message)

    def _message(self, name: str, type_name: str, latched: bool, time_ns: int, message: Any) -> TopicMessage:
        data = serialize(self.registry, type_name, message)
        return TopicMessage(self.names[name], type_name, latched, time_ns, data)


def _acts(recording: Recording) -> Iterator[Message]:
    """Return the acts of operators; none in a log of earlier versions, which has no such stream."""
    known = any(stream.name == ACTS for stream in recording.header.streams)
    return recording.messages(ACTS) if known else iter(())


def snapshots(
    recording: Recording, on_tick: OnTick = lambda tick: None, platform: tuple[str, ...] = ()
) -> Iterator[Snapshot]:
    """Yield the ticks of a recording as this version sees them, its columns found by name.

    What the recording does not have is as if nothing had come: other versions have other columns. `platform` names
    those of the platform's own state that are wanted, all in their order.
    """
    header = recording.header
    here = [f"{stage}.{field}" for stage, part in LAYOUT._asdict().items() for field in part.names]
    here += [f"platform.{field}" for field in platform]
    beside = [name for name in header.columns if name.startswith("others.")] if platform else []
    here += beside
    known = set(header.columns)
    names = [name for name in here if name in known]
    places = [here.index(name) for name in names]
    empty = np.concatenate((empty_vector(), np.zeros(len(platform) + len(beside))))
    for block in recording.blocks(names):
        vectors = np.tile(empty, (len(block.ticks), 1))
        vectors[:, places] = block.vectors
        for tick, vector in zip(block.ticks.tolist(), vectors, strict=True):
            yield Snapshot(tick, header.tick_hz, vector)
        if len(block.ticks):
            on_tick(int(block.ticks[-1]))


def empty_vector() -> Row:
    """Return the stages of a tick in which nothing has come from outside and nothing has happened."""
    vector = np.zeros(PLATFORM_AT)
    vector[:INPUT_WIDTH] = input_vector(TickInputs(NO_SAMPLE, NO_COMMAND, NO_EVENTS))
    vector[LAYOUT.situation.slice] = NO_SITUATION
    return vector
