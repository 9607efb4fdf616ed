"""There and back: what the decoder makes of a drive's messages is what the drive had taken."""

from typing import Any

import numpy as np
import pytest

from simconsole.bridge.console.command_decoder import GEAR, HAZARD_LIGHTS, TURN_INDICATORS, CommandDecoder
from simconsole.bridge.console.command_messages import CommandMessages
from simconsole.bridge.console.input_slots import BridgeInputs
from simconsole.bridge.messages import Registry, standard_registry
from simconsole.bridge.messages.cdr import deserialize, serialize
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.layout import write
from simconsole.values.signals import NO_COMMAND, Event, EventInput, RemoteCommand, RemoteKind
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot

COMMANDS = [
    NO_COMMAND._replace(kind=1.0, road_wheel_rad=0.1, road_wheel_radps=-2.0, speed_mps=7.0, accel_mps2=-1.3),
    NO_COMMAND._replace(kind=2.0, road_wheel_rad=-1.2, speed_mps=80.0, accel_mps2=0.7, direction=1.0),
    NO_COMMAND._replace(kind=2.0, speed_mps=-3.0, direction=-1.0),
    NO_COMMAND._replace(kind=3.0, speed_mps=4.0, yaw_rate_radps=0.1),
    NO_COMMAND._replace(kind=4.0, road_wheel_rad=0.3, throttle=0.4, brake=0.1),
    NO_COMMAND._replace(kind=5.0, x_m=1.0, y_m=-2.0, yaw_rad=0.5, speed_mps=3.0),
]


class Replayed:
    """A console's slot, fed with what `CommandMessages` made of a drive, through CDR."""

    def __init__(self) -> None:
        self.registry: Registry = standard_registry()
        self.inputs = BridgeInputs()
        self.topics = {topic.name: topic for topic in CommandDecoder(self.inputs, BridgeProfile()).topics()}
        self.messages = CommandMessages(self.registry, {topic.name: topic.type for topic in self.topics.values()})

    def tick(self, tick: int, ros: RemoteCommand, events: float = 0.0) -> tuple[RemoteCommand, EventInput, list[str]]:
        row = np.zeros(PLATFORM_AT)
        write(row, LAYOUT.ros, ros)
        write(row, LAYOUT.events, EventInput(events))
        sent = self.messages.of(Snapshot(tick, 250, row))
        self.inputs.tick = tick - 1
        for name, message in sent:
            topic = self.topics[name]
            plain = deserialize(self.registry, topic.type, serialize(self.registry, topic.type, message))
            topic.accept(plain, self.registry.from_plain(topic.type, plain), 0)
        return (*self.inputs.take(tick), [name for name, _ in sent])


def assert_taken(found: RemoteCommand, ros: RemoteCommand) -> None:
    assert found == pytest.approx(ros, rel=1.2e-7, abs=1e-12)


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: RemoteKind(int(command.kind)).name)
def test_a_command_of_each_kind_comes_back(command: RemoteCommand) -> None:
    replayed = Replayed()
    ros = command._replace(sequence=1.0, age_ticks=0.0)
    assert_taken(replayed.tick(11, ros)[0], ros)
    again, _, names = replayed.tick(12, ros._replace(age_ticks=1.0))
    assert not names, "no new command"
    assert again.age_ticks == 1.0


def test_a_drive_of_many_commands_comes_back_tick_by_tick() -> None:
    replayed, rng = Replayed(), np.random.default_rng(5)
    ros = NO_COMMAND
    for tick in range(1, 400):
        if rng.random() < 0.3:
            command = COMMANDS[int(rng.integers(5))]
            direction = command.direction if command.kind in (2.0, 3.0) else ros.direction
            ros = command._replace(sequence=ros.sequence + 1.0, direction=direction, age_ticks=-1.0)
            ros = ros._replace(turn_indicators=float(rng.integers(-1, 2)), hazard_lights=float(rng.integers(2)))
        if rng.random() < 0.05:
            ros = ros._replace(direction=float(rng.integers(-1, 2)))
        if ros.sequence:
            ros = ros._replace(age_ticks=ros.age_ticks + 1.0)
        assert_taken(replayed.tick(tick, ros)[0], ros)


def test_lights_and_gear_are_sent_when_they_change() -> None:
    replayed = Replayed()
    ros = NO_COMMAND._replace(direction=-1.0, turn_indicators=1.0, hazard_lights=1.0)
    found, _, names = replayed.tick(5, ros)
    assert names == [GEAR, TURN_INDICATORS, HAZARD_LIGHTS]
    assert found == ros
    assert not replayed.tick(6, ros)[2]


def test_the_speed_of_a_ball_alone_is_one_command() -> None:
    replayed = Replayed()
    ros = COMMANDS[5]._replace(sequence=1.0, age_ticks=0.0)
    replayed.tick(5, ros)
    faster = ros._replace(sequence=2.0, speed_mps=4.0)
    found, _, names = replayed.tick(6, faster)
    assert names == ["/ball/desired_speed"]
    assert_taken(found, faster)


def test_requests_come_back_and_the_console_s_own_events_do_not() -> None:
    asked = Event.REQUEST_AUTONOMOUS | Event.MARK
    _, events, _ = Replayed().tick(3, NO_COMMAND, float(asked | Event.COMMANDER_LOST | Event.LOOP_STALL))
    assert int(events.events) == asked


def test_a_source_that_falls_silent_at_the_end_of_a_drive_sends_nothing() -> None:
    replayed = Replayed()
    replayed.tick(3, COMMANDS[2]._replace(sequence=4.0, age_ticks=0.0))
    assert not replayed.tick(4, NO_COMMAND)[2]


def test_messages_carry_the_time_of_the_tick_before(snapshot: Any) -> None:
    (message,) = [message for _, message in Replayed().messages.of(snapshot(11, kind=1.0, sequence=1.0, direction=1.0))]
    assert (message.stamp.sec, message.stamp.nanosec) == (0, 40_000_000)
