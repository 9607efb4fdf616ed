from collections import Counter
from collections.abc import Iterable
from typing import Any

import msgspec
import numpy as np
import pytest

from simconsole.bridge.messages.cdr import deserialize
from simconsole.profiles.bridge import BridgeProfile, CameraProfile
from simconsole.profiles.session import SessionProfile
from simconsole.recording.exports.drive_topics import DriveTopics, TopicMessage, empty_vector, snapshots
from simconsole.recording.framing import Message
from simconsole.values.signals import NEVER_TICKS, NO_COMMAND, NO_SAMPLE
from tests.recording.made import COLUMNS, SESSION, MadeRecording, made_vectors


def with_bridge(pacing: str = "free", **bridge: Any) -> SessionProfile:
    outputs = msgspec.structs.replace(SESSION.outputs, bridge=BridgeProfile(**bridge))
    mode = msgspec.structs.replace(SESSION.mode, pacing=pacing)
    return msgspec.structs.replace(SESSION, outputs=outputs, mode=mode)


def counts(messages: Iterable[TopicMessage]) -> Counter[str]:
    return Counter(message.topic for message in messages)


def test_every_topic_but_that_of_connections_at_its_rate(recording: MadeRecording) -> None:
    found = counts(DriveTopics(SESSION).messages(recording))
    rates = {"/clock": 100, "/tf": 50, "/console/joy": 100, "/console/arbitration": 50, "/odom": 50}
    assert {name: found[name] for name in rates} == {name: 4 * rate for name, rate in rates.items()}
    status = [name for name in found if name.startswith("/vehicle/status/")]
    assert len(status) == 6
    assert all(found[name] == 120 for name in status)
    assert found["/tf_static"] == 1
    assert found["/control/command/control_cmd"] == 199
    assert found["/console/request"] == 1
    assert "/console/bridge" not in found


def test_a_view_of_another_program_is_not_exported_though_it_may_be_rated_and_renamed(recording: MadeRecording) -> None:
    session = with_bridge(external_view=True, rates_hz={"/view/poses": 10.0}, rename={"/view/hud": "/hud"})
    found = counts(DriveTopics(session).messages(recording))
    assert {"/view/scene", "/view/poses", "/view/hud", "/hud"}.isdisjoint(found)
    assert found == counts(DriveTopics(with_bridge()).messages(recording))


def test_pictures_of_a_camera_are_not_exported_but_where_it_is(recording: MadeRecording) -> None:
    session = with_bridge(camera=CameraProfile(rate_hz=5.0), rename={"/camera/camera_info": "/info"})
    found = counts(DriveTopics(session).messages(recording))
    assert found == counts(DriveTopics(with_bridge()).messages(recording))


def test_times_never_go_back_and_values_are_those_of_the_tick(recording: MadeRecording) -> None:
    topics = DriveTopics(SESSION)
    last_ns = 0
    for message in topics.messages(recording):
        assert message.time_ns >= last_ns
        last_ns = message.time_ns
        if message.topic == "/odom":
            plain = deserialize(topics.registry, message.type, message.data)
            stamp = plain["header"]["stamp"]
            assert stamp["sec"] * 10**9 + stamp["nanosec"] == message.time_ns
            tick = message.time_ns * 250 // 10**9
            assert plain["pose"]["pose"]["position"]["x"] == 0.1 * tick


def test_a_command_stands_at_the_tick_before_the_one_that_took_it(recording: MadeRecording) -> None:
    times = [
        message.time_ns for message in DriveTopics(SESSION).messages(recording) if message.topic.endswith("control_cmd")
    ]
    assert times == [5 * number * 4_000_000 for number in range(1, 200)]


def test_acts_of_operators_are_a_topic_with_their_words() -> None:
    content = b'{"tick":9,"act":"mark","note":"cut in \xc3\xa9"}'
    acts = (Message(10, content), Message(10, b"{}"), Message(999, b"{}"))
    topics = DriveTopics(with_bridge(namespace="/ego"))
    messages = list(topics.messages(MadeRecording(made_vectors(), acts=acts)))
    found = [message for message in messages if message.topic == "/ego/console/acts"]
    assert [message.time_ns for message in found] == [36_000_000, 36_000_000, 998 * 4_000_000]
    assert deserialize(topics.registry, found[0].type, found[0].data) == {"data": content.decode()}
    times_ns = [message.time_ns for message in messages]
    assert times_ns == sorted(times_ns)


def test_a_log_without_a_stream_of_acts_has_none() -> None:
    assert "/console/acts" not in counts(DriveTopics(SESSION).messages(MadeRecording(made_vectors(50), acts=None)))


def test_in_lockstep_only_the_controller_s_ticks_are_published(recording: MadeRecording) -> None:
    found = list(DriveTopics(with_bridge("lockstep")).messages(recording))
    outputs = [message for message in found if not message.topic.endswith(("_cmd", "request"))]
    assert {message.time_ns % 20_000_000 for message in outputs} == {0}
    assert counts(found)["/odom"] == 200
    assert counts(found)["/clock"] == 200, "100 Hz cannot be reached at 50 answers a second"


def test_names_and_rates_are_the_session_s(recording: MadeRecording) -> None:
    session = with_bridge(namespace="/ego", rates_hz={"/odom": 10.0, "/clock": 0.0, "/console/bridge": 2.0})
    found = counts(DriveTopics(session).messages(recording))
    assert found["/ego/odom"] == 40
    assert "/clock" not in found
    assert "/ego/control/command/control_cmd" in found


def test_columns_of_another_version_are_found_by_name() -> None:
    """Another order, one column more, one fewer."""
    vectors = made_vectors(10)
    order = np.random.default_rng(1).permutation(len(COLUMNS))
    kept = [place for place in order if COLUMNS[place] not in ("vehicle.z_m", "ros.age_ticks")]
    columns = ("vehicle.wings", *(COLUMNS[place] for place in kept))
    other = MadeRecording(np.column_stack([np.full(10, 9.0), vectors[:, kept]]), columns)
    for found, vector in zip(snapshots(other), vectors, strict=True):
        assert found.vehicle.x_m == vector[COLUMNS.index("vehicle.x_m")]
        assert found.vehicle.z_m == 0.0
        assert found.ros.age_ticks == NEVER_TICKS


def test_an_empty_tick_is_one_in_which_nothing_came() -> None:
    (found,) = snapshots(MadeRecording(empty_vector().reshape(1, -1)))
    assert (found.sample, found.ros) == (NO_SAMPLE, NO_COMMAND)


def test_it_says_how_far_it_is(recording: MadeRecording) -> None:
    told: list[int] = []
    for _ in DriveTopics(SESSION).messages(recording, told.append):
        pass
    assert told == [300, 600, 900, 1000]
    assert recording.passes == 1


@pytest.mark.parametrize("bridge", [None, {}])
def test_a_session_without_a_bridge_is_exported_like_one_with_a_shipped_one(
    recording: MadeRecording, bridge: dict[str, Any] | None
) -> None:
    session = SESSION if bridge is None else with_bridge(**bridge)
    assert sum(counts(DriveTopics(session).messages(recording)).values()) == 3086
