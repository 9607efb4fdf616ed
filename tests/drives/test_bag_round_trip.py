"""A drive leaves as a bag and comes back: its commands in the same ticks, its driver's inputs, its topics."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader

from simconsole.cli.main import main
from simconsole.recording.bundles.bundle import Bundle, open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.recording.exports.export_formats import export_drive
from simconsole.recording.reading import LogTable
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.values.signals import Mode
from tests.drives.controllers import Controller, command
from tests.patience import PATIENCE_S
from tests.ports import free_port

TOPIC_FORMATS = ("mcap", "rosbag2")
SESSION = """\
schema: 1
title: In lockstep
scenario: {vehicle: hatchback, duration_s: 6}
features: {control: {person_required: false}}
outputs: {bridge: {port: 0, record: ["*"]}, hud: null, scene: null, report: false}
devices: {driver: none}
mode: {pacing: lockstep, tick_hz: 250, answer_timeout_s: 0.5}
"""
SINGLE = 1.2e-7
"""Relative resolution of float32."""


def run(*words: object) -> int:
    """One command line in this process; return its exit code."""
    return main([str(word) for word in words])


def answer(count: int, stamp: dict[str, int]) -> list[str]:
    """Asks for the car, drives in bends, shows an indicator, changes the direction of travel for a moment."""
    texts = []
    if count == 30:
        texts.append({"op": "publish", "topic": "/console/request", "msg": {"data": "autonomous"}})
    if count in (100, 150):
        lever = {"stamp": stamp, "command": 2 if count == 100 else 1}
        texts.append({"op": "publish", "topic": "/control/command/turn_indicators_cmd", "msg": lever})
    if count in (40, 60):
        gear = {"stamp": stamp, "command": 1 if count == 40 else 2}
        texts.append({"op": "publish", "topic": "/control/command/gear_cmd", "msg": gear})
    texts.append(command(stamp, 1.2 - 0.004 * count, 0.02 * np.sin(count / 50.0)))
    return [json.dumps(text) for text in texts]


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Bundle:
    """The bundle of a drive that a controller commanded in lockstep."""
    folder = tmp_path_factory.mktemp("lockstep")
    (folder / "session.yaml").write_text(SESSION)
    port = free_port()
    session = override(load_session(str(folder / "session.yaml")), outputs={"bridge": {"port": port, "record": ["*"]}})
    controller = Controller(port, answer)
    controller.start()
    drive(resolve(session), folder / "bundle")
    controller.join(PATIENCE_S)
    assert controller.failure is None
    bundle = open_bundle(folder / "bundle")
    assert bundle.log.table().column("arbitration.mode")[-1] == Mode.AUTONOMOUS
    return bundle


@pytest.fixture(scope="module")
def exported(driven: Bundle) -> Callable[[str], Path]:
    """That drive in a format of topics, made once."""
    resolved = recorded_session(driven)

    def made(name: str) -> Path:
        path = driven.folder.parent / f"drive.{name}"
        path = path if name == "mcap" else path.with_suffix("")
        if not path.exists():
            export_drive(driven.log, resolved.session, name, path, world=resolved.world)
        return path

    return made


NOT_IN_THE_LOG = ("/control", "/console/request", "/console/bridge", "/rosout")
"""Commands, which are compared by themselves, and what the console says of its connections."""


def raw(path: Path) -> dict[str, list[tuple[int, bytes]]]:
    """Times and contents by topic, as the library of the format reads them."""
    found: dict[str, list[tuple[int, bytes]]] = {}
    with path.open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages():
            found.setdefault(channel.topic, []).append((message.log_time, message.data))
    return found


def test_an_export_is_what_a_client_got_during_the_drive(driven: Bundle, exported: Callable[[str], Path]) -> None:
    """Against the recorder on the live bridge: every topic of the log, message by message and byte by byte."""
    live, made = raw(driven.folder / "topics.mcap"), raw(exported("mcap"))
    outputs = [name for name in live if not name.startswith(NOT_IN_THE_LOG)]
    assert len(outputs) == 22
    for name in outputs:
        assert made[name] == live[name], name
    command_times = {name: [time_ns for time_ns, _ in made[name]] for name in made if name.startswith("/control")}
    assert len(command_times) == 3
    # The answer to the last tick came when no tick was left to take it.
    taken = {name: [time_ns for time_ns, _ in live[name] if time_ns < 6_000_000_000] for name in command_times}
    assert command_times == taken
    assert [content for _, content in made["/console/request"]] == [data for _, data in live["/console/request"]]


@pytest.mark.parametrize("name", TOPIC_FORMATS)
def test_any_reader_finds_counts_stamps_and_odometry_of_the_log(
    driven: Bundle, exported: Callable[[str], Path], name: str
) -> None:
    table = driven.log.table()
    columns = [table.column(f"vehicle.{column}") for column in ("x_m", "y_m", "vx_mps", "yaw_rate_radps")]
    counts: dict[str, int] = {}
    with AnyReader([exported(name)]) as reader:
        for connection, time_ns, data in reader.messages():
            counts[connection.topic] = counts.get(connection.topic, 0) + 1
            message: Any = reader.deserialize(data, connection.msgtype)
            if connection.topic != "/odom":
                continue
            tick = time_ns * 250 // 10**9
            assert tick == 5 * counts["/odom"]
            stamp = message.header.stamp
            assert stamp.sec * 10**9 + stamp.nanosec == time_ns
            pose, twist = message.pose.pose, message.twist.twist
            found = (pose.position.x, pose.position.y, twist.linear.x, twist.angular.z)
            assert found == tuple(float(column[tick - 1]) for column in columns)
    assert (counts["/odom"], counts["/clock"], counts["/tf_static"]) == (300, 300, 1)
    live = {topic: len(messages) for topic, messages in raw(driven.folder / "topics.mcap").items()}
    assert {topic: count for topic, count in counts.items() if not topic.startswith("/control")} == {
        topic: count for topic, count in live.items() if topic in counts and not topic.startswith("/control")
    }


def same_commands(first: LogTable, second: LogTable) -> None:
    for column in (name for name in first.columns if name.startswith("ros.")):
        there, here = first.column(column), second.column(column)
        np.testing.assert_allclose(here, there, rtol=SINGLE, atol=1e-38, err_msg=column)
    assert np.array_equal(first.column("events.events"), second.column("events.events"))


@pytest.mark.parametrize("name", TOPIC_FORMATS)
def test_the_commands_of_a_drive_come_back_in_the_same_ticks(
    driven: Bundle, exported: Callable[[str], Path], tmp_path: Path, name: str
) -> None:
    session = driven.folder.parent / "session.yaml"
    assert run("drive", session, "--headless", "--commands", f"bag:{exported(name)}", "--out", tmp_path / "again") == 0
    bundle = open_bundle(tmp_path / "again")
    played = bundle.manifest.summary["commands"]
    assert (played["accepted"], played["refused"]) == (299 + 2 + 2 + 1, 0)
    first, again = driven.log.table(), bundle.log.table()
    same_commands(first, again)
    assert np.array_equal(first.column("arbitration.mode"), again.column("arbitration.mode"))
    np.testing.assert_allclose(again.column("vehicle.x_m"), first.column("vehicle.x_m"), atol=1e-4)


def test_a_recording_of_the_live_bridge_plays_as_well(driven: Bundle, tmp_path: Path) -> None:
    session = driven.folder.parent / "session.yaml"
    choice = f"bag:{driven.folder / 'topics.mcap'}"
    assert run("drive", session, "--headless", "--commands", choice, "--out", tmp_path / "again") == 0
    same_commands(driven.log.table(), open_bundle(tmp_path / "again").log.table())


def test_a_manual_drive_comes_back_as_a_trace(script: Path, tmp_path: Path) -> None:
    """The joystick in every tick: the driver's inputs are those of the drive, in single precision."""
    rates = "outputs: {bridge: {rates_hz: {/console/joy: 250}}, hud: null, scene: null, report: false}"
    (tmp_path / "session.yaml").write_text(f"schema: 1\n{rates}\nmode: {{pacing: free}}\nscenario: {{duration_s: 3}}\n")
    words = ("drive", tmp_path / "session.yaml", "--headless", "--driver")
    assert run(*words, f"script:{script}", "--out", tmp_path / "first") == 0
    assert run("export", tmp_path / "first", "--to", "rosbag2", "--out", tmp_path / "bag") == 0
    assert run("import", tmp_path / "bag", "--to", "trace", "--out", tmp_path / "t.csv") == 0
    assert run(*words, f"trace:{tmp_path / 't.csv'}", "--out", tmp_path / "second") == 0
    first, second = (open_bundle(tmp_path / name).log.table() for name in ("first", "second"))
    for column in (name for name in first.columns if name.startswith(("driver.", "sample."))):
        there, here = first.column(column), second.column(column)
        # A hand wheel's rate is a difference of two angles by 4 ms, each of 9.4 rad at full lock in 2**-24 steps.
        most = 9.5 * 2.0**-24 * (2.0 * 250.0 if column.endswith("_radps") else 1.0)
        np.testing.assert_allclose(here, there, rtol=SINGLE, atol=most, err_msg=column)
    assert first.column("vehicle.distance_m")[-1] > 0.5


def test_a_bag_of_commands_is_refused_where_a_controller_is_waited_for(
    driven: Bundle, exported: Callable[[str], Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    session = driven.folder.parent / "session.yaml"
    assert run("drive", session, "--commands", f"bag:{exported('mcap')}", "--out", tmp_path / "again") == 2
    assert "features.commands: value bag:" in capsys.readouterr().err
    (tmp_path / "broken.mcap").write_bytes(exported("mcap").read_bytes()[:5000])
    choice = f"bag:{tmp_path / 'broken.mcap'}"
    assert run("drive", session, "--headless", "--commands", choice, "--out", tmp_path / "again") == 2
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1
    assert "broken.mcap: cannot be read as a bag" in said[0]
    assert not (tmp_path / "again").exists()
