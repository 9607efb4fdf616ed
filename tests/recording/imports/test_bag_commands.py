from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from simconsole.profiles.bridge import BridgeProfile
from simconsole.recording.imports.bag_commands import BagChoice, BagCommands, bag_choice
from simconsole.values.errors import RecordingError
from simconsole.values.signals import NO_COMMAND, Event, RemoteKind
from simconsole.values.state_vector import PLATFORM_AT, Snapshot
from tests.recording.imports.bags import EPOCH_NS, Written, ackermann, joy, said, twist, write_bag

HZ = 250


def ticks(commands: BagCommands, last: int) -> list[tuple[float, float, int]]:
    """Speed, sequence and events that each tick takes."""
    taken = []
    for tick in range(1, last + 1):
        ros, events = commands.take(tick)
        taken.append((ros.speed_mps, ros.sequence, int(events.events)))
        commands.publish(Snapshot(tick, HZ, np.zeros(PLATFORM_AT)))
    return taken


@pytest.fixture
def play(tmp_path: Path) -> Callable[..., BagCommands]:
    def opened(*messages: Written, topic: str | None = None, name: str = "bag", **profile: object) -> BagCommands:
        path = write_bag(tmp_path / name, messages)
        return BagCommands(BagChoice(path, topic), BridgeProfile(**profile), HZ)  # type: ignore[arg-type]

    return opened


@pytest.mark.parametrize(
    ("text", "path", "topic"),
    [
        ("bag:drive.mcap", "drive.mcap", None),
        ("bag:drive.mcap:/ego/cmd", "drive.mcap", "/ego/cmd"),
        ("bag:/a/b.bag:/cmd_vel", "/a/b.bag", "/cmd_vel"),
        ("bag:/a/folder", "/a/folder", None),
        ("bag:C:/a/drive.mcap", "C:/a/drive.mcap", None),
    ],
)
def test_a_choice_is_a_file_and_perhaps_a_topic(text: str, path: str, topic: str | None) -> None:
    assert bag_choice(text) == (Path(path), topic)


@pytest.mark.parametrize("text", ["", "bag:", "bog:x", "drive.mcap"])
def test_no_choice_is_refused(text: str) -> None:
    with pytest.raises(RecordingError, match="bag:FILE or bag:FILE:/TOPIC"):
        bag_choice(text)


def test_a_message_counts_from_the_tick_after_its_time(play: Callable[..., BagCommands]) -> None:
    commands = play(twist(8_000_000, 1.0), twist(8_000_001, 2.0), twist(17_000_000, 3.0))
    speeds = [speed for speed, _, _ in ticks(commands, 8)]
    assert speeds == [0.0, 0.0, 1.0, 2.0, 2.0, 3.0, 3.0, 3.0]
    ros, _ = commands.take(9)
    assert (ros.kind, ros.age_ticks) == (RemoteKind.TWIST, 3.0)


@pytest.mark.parametrize("name", ["bag", "drive.bag"])
def test_a_bag_of_a_wall_clock_starts_with_the_drive(play: Callable[..., BagCommands], name: str) -> None:
    """Another frame rate and jitter: whatever came between two ticks, the newest counts."""
    rng = np.random.default_rng(2)
    times_ns = [int(at * 1e6) for at in np.arange(30) * 33.3 + rng.uniform(0.0, 9.0, 30)]
    stream = [ackermann(EPOCH_NS + at, 1.0 + number) for number, at in enumerate(times_ns)]
    commands = play(joy(EPOCH_NS, [0.0]), *stream, name=name)
    taken = ticks(commands, 260)
    for tick, (speed, sequence, _) in enumerate(taken, start=1):
        come = sum(at <= (tick - 1) * 4_000_000 for at in times_ns)
        assert (speed, sequence) == (float(come), float(come))
    assert commands.summary() == {"commands": {"topics": ["/ego/drive"], "accepted": 30, "refused": 0}}


def test_requests_of_a_bag_are_raised_once(play: Callable[..., BagCommands]) -> None:
    commands = play(said(4_000_000, "autonomous"), twist(4_000_000), said(4_000_000, "mark"))
    events = [events for _, _, events in ticks(commands, 4)]
    assert events == [0, int(Event.REQUEST_AUTONOMOUS | Event.MARK), 0, 0]


def test_before_the_first_message_nobody_commands(play: Callable[..., BagCommands]) -> None:
    assert play(twist(80_000_000)).take(1)[0] == NO_COMMAND


def test_what_a_live_console_refuses_is_refused_and_counted(play: Callable[..., BagCommands]) -> None:
    fast, late = ackermann(0, 81.0), ackermann(4_000_000)
    foreign = ackermann(8_000_000, frame="lidar")
    commands = play(fast, late, foreign, ackermann(12_000_000)._replace(plain=late.plain))
    ros = [commands.take(tick)[0] for tick in (1,)]
    ticks(commands, 6)
    found = commands.summary()["commands"]
    assert (found["accepted"], found["refused"]) == (1, 3)
    assert "81 is not within -80 to 80" in found["first_refusal"]
    assert commands.take(7)[0].refused == 3.0
    assert ros[0].refused == 1.0


def test_a_recording_is_no_flood(play: Callable[..., BagCommands]) -> None:
    commands = play(*(twist(number * 1_000_000, 5.0) for number in range(1000)))
    ticks(commands, 251)
    assert commands.summary()["commands"]["accepted"] == 1000


def test_the_session_s_own_names_are_known(play: Callable[..., BagCommands]) -> None:
    commands = play(twist(0, topic="/ego/cmd_vel"), said(0, "mark", "/ego/console/request"), namespace="/ego")
    assert commands.summary()["commands"]["topics"] == ["/ego/cmd_vel", "/ego/console/request"]


def test_a_topic_that_is_named_plays_alone(play: Callable[..., BagCommands]) -> None:
    commands = play(twist(0, 1.0), ackermann(0, 2.0), said(0, "mark"), topic="/ego/drive")
    assert commands.summary()["commands"]["topics"] == ["/ego/drive"]
    assert ticks(commands, 1) == [(2.0, 1.0, 0)]


@pytest.mark.parametrize(
    ("messages", "topic", "wrong"),
    [
        ((ackermann(0), twist(0, topic="/other")), None, r"value /ego/drive, /other: one topic .* say which"),
        ((joy(0, [1.0]),), None, r"value none: .*geometry_msgs/msg/Twist"),
        ((twist(0),), "/nothing", r"topic: value /nothing: one of its topics: /cmd_vel"),
        ((joy(0, [1.0]),), "/joy", r"topic /joy: type: value sensor_msgs/msg/Joy: one of"),
        ((said(0, "mark", "/chatter"),), "/chatter", r"topic /chatter: type: value std_msgs/msg/String"),
    ],
)
def test_a_bag_without_one_clear_topic_is_refused(
    play: Callable[..., BagCommands], messages: tuple[Written, ...], topic: str | None, wrong: str
) -> None:
    with pytest.raises(RecordingError, match=wrong):
        play(*messages, topic=topic)


def test_a_damaged_bag_is_found_before_the_first_tick(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "drive.bag", [twist(number, 1.0) for number in range(2000)])
    data = bytearray(path.read_bytes())
    place = data.index(b"op=\x02", len(data) // 3)
    data[place : place + 30] = bytes(30)
    path.write_bytes(data)
    with pytest.raises(RecordingError, match=r"drive\.bag: cannot be read as a bag"):
        BagCommands(BagChoice(path, None), BridgeProfile(), HZ)
