from collections.abc import Callable

import numpy as np
import pytest

from simconsole.canbus.codec import COMMAND, CONSOLE, Codec, Frame
from simconsole.canbus.node import CanNode
from simconsole.canbus.protection import Check, protected
from simconsole.profiles.can import CanProfile
from simconsole.values.signals import NEVER_TICKS, Event, RemoteKind
from simconsole.values.state_vector import LAYOUT, Snapshot

Snapshots = Callable[[int], Snapshot]
GOOD = {"REQUEST": 0.0, "ROAD_WHEEL": 0.1, "ACCEL": 1.5, "DIRECTION": 1.0, "TURN_INDICATORS": 0.0, "HAZARD_LIGHTS": 0.0}
STEP_NS = 20_000_000


class Sender:
    """An ECU by hand: counts, and knows the time."""

    def __init__(self, codec: Codec) -> None:
        self.codec = codec
        self.counter = 0
        self.now_ns = 0

    def frame(self, **changes: float) -> Frame:
        self.counter += 1
        return self.codec.encode(COMMAND, {**GOOD, **changes}, self.counter)

    def to(self, node: CanNode, **changes: float) -> int:
        self.now_ns += STEP_NS
        return node.receive(self.frame(**changes), self.now_ns)


@pytest.fixture
def sender(codec: Codec) -> Sender:
    return Sender(codec)


def test_a_second_of_ticks_gives_each_message_at_its_rate(codec: Codec, node: CanNode, snapshot: Snapshots) -> None:
    counts: dict[str, int] = {}
    for tick in range(250):
        for frame in node.transmit(snapshot(tick), 0):
            name = codec.by_id[frame.can_id]
            counts[name] = counts.get(name, 0) + 1
    assert counts == {info.name: 1000 // info.period_ms for info in codec.sent_by(CONSOLE)}
    assert node.counters().sent == 560


def test_vehicle_without_wheel_speeds_does_not_send_them(codec: Codec, snapshot: Snapshots) -> None:
    node = CanNode(codec, CanProfile(), 250)
    assert 0x111 not in {frame.can_id for tick in range(10) for frame in node.transmit(snapshot(tick), 0)}


def test_value_that_is_not_finite_silences_its_message_only(codec: Codec, node: CanNode, snapshot: Snapshots) -> None:
    row = snapshot(0).vector.copy()
    row[LAYOUT.vehicle.start + 6] = np.nan  # vx_mps
    names = [codec.by_id[frame.can_id] for frame in node.transmit(Snapshot(0, 250, row), 0)]
    assert "SC_MOTION" not in names
    assert len(names) == 7
    assert node.counters().unsent == 1


def test_good_command_is_an_acceleration_command(node: CanNode, sender: Sender) -> None:
    sender.to(node)
    assert node.command.sequence == 0
    assert node.command.age_ticks == NEVER_TICKS
    sender.to(node, ROAD_WHEEL=-0.25, ACCEL=-2.5, DIRECTION=-1.0, TURN_INDICATORS=-1.0, HAZARD_LIGHTS=1.0)
    command = node.command
    assert command.kind == RemoteKind.ACCELERATION
    assert (command.sequence, command.refused, command.age_ticks) == (1.0, 0.0, 0.0)
    assert command.road_wheel_rad == pytest.approx(-0.25)
    assert command.accel_mps2 == pytest.approx(-2.5)
    assert (command.direction, command.turn_indicators, command.hazard_lights) == (-1.0, -1.0, 1.0)
    assert node.receipt_ns == 2 * STEP_NS


def test_bad_frames_are_counted_and_leave_the_command_as_it_was(node: CanNode, sender: Sender) -> None:
    sender.to(node)
    sender.to(node)
    before = node.command
    good = sender.frame()
    broken = Frame(good.can_id, good.data[:7] + bytes((good.data[7] ^ 1,)))
    for frame in (broken, Frame(good.can_id, good.data[:7])):
        assert node.receive(frame, sender.now_ns + 1) == 0
    assert node.command == before._replace(refused=2.0)
    assert node.receipt_ns == 2 * STEP_NS
    assert node.state(sender.now_ns + 1) is Check.WRONG_LENGTH


def test_command_out_of_range_is_refused_whole(codec: Codec, node: CanNode, sender: Sender) -> None:
    sender.to(node)
    word = int.from_bytes(sender.frame().data, "little") | 0x7FFF << 32
    data = protected(0x200, word.to_bytes(8, "little"), sender.counter)
    node.receive(Frame(0x200, data), sender.now_ns)
    assert node.state(sender.now_ns) is Check.OUT_OF_RANGE
    assert (node.command.sequence, node.command.refused) == (0.0, 1.0)


def test_frames_of_others_are_not_looked_at(node: CanNode, sender: Sender) -> None:
    frame = sender.frame()
    node.receive(frame._replace(can_id=0x100), 0)
    node.receive(frame._replace(can_id=0x7FF), 0)
    node.receive(frame._replace(extended=True), 0)
    assert node.command.refused == 0


def test_request_acts_once_when_it_changes(node: CanNode, sender: Sender) -> None:
    events = [sender.to(node, REQUEST=request) for request in (0, 0, 1, 1, 0, 1, 2)]
    wanted = [0, 0, Event.REQUEST_AUTONOMOUS, 0, 0, Event.REQUEST_AUTONOMOUS, Event.REQUEST_MANUAL]
    assert events == [int(event) for event in wanted]


def test_request_that_stood_when_reception_began_is_none(node: CanNode, sender: Sender) -> None:
    assert [sender.to(node, REQUEST=1) for _ in range(4)] == [0] * 4


def test_emergency_stop_that_stood_when_reception_began_counts(node: CanNode, sender: Sender) -> None:
    assert [sender.to(node, REQUEST=5) for _ in range(3)] == [0, int(Event.EMERGENCY_STOP), 0]


def test_after_a_silence_an_old_request_does_not_act_again(node: CanNode, sender: Sender) -> None:
    for request in (0, 0, 1):
        sender.to(node, REQUEST=request)
    sender.now_ns += 1_000_000_000
    assert [sender.to(node, REQUEST=1) for _ in range(3)] == [0, 0, 0]


def test_bad_frame_raises_no_event(node: CanNode, sender: Sender) -> None:
    sender.to(node)
    sender.to(node)
    asked = sender.frame(REQUEST=5.0)
    assert node.receive(Frame(asked.can_id, bytes((asked.data[0] ^ 1,)) + asked.data[1:]), sender.now_ns) == 0


def test_status_says_how_the_command_is_received(
    codec: Codec, node: CanNode, sender: Sender, snapshot: Snapshots
) -> None:
    sender.to(node)
    sender.to(node)
    frames = node.transmit(snapshot(0), sender.now_ns + 32_000_000)
    (status,) = (frame for frame in frames if frame.can_id == 0x120)
    values = codec.decode("SC_STATUS", status.data)
    assert values is not None
    assert (values["COMMAND_STATE"], values["COMMAND_AGE"]) == (Check.OK, 32)
