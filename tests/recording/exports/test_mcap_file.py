from collections import Counter
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from simconsole.recording.exports.drive_topics import DriveTopics
from simconsole.recording.exports.mcap_file import write_topics
from tests.recording.made import COLUMNS, SESSION, MadeRecording


def test_the_reader_of_mcap_and_its_decoder_for_ros_2_see_the_drive(recording: MadeRecording, tmp_path: Path) -> None:
    path, topics = tmp_path / "drive.mcap", DriveTopics(SESSION)
    counts = write_topics(topics.registry, topics.messages(recording), path)
    x_m = recording.vectors[:, COLUMNS.index("vehicle.x_m")]
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        assert reader.get_header().profile == "ros2"
        summary = reader.get_summary()
        assert summary is not None
        assert {schema.encoding for schema in summary.schemas.values()} == {"ros2msg"}
        assert {channel.message_encoding for channel in summary.channels.values()} == {"cdr"}
        latched = {c.topic for c in summary.channels.values() if "durability: 1" in str(c.metadata)}
        assert latched == {"/console/mode", "/map/markers", "/route", "/tf_static", "/traffic_signals/stop_lines"}
        seen: Counter[str] = Counter()
        for _, channel, message, decoded in reader.iter_decoded_messages():
            seen[channel.topic] += 1
            assert message.publish_time == message.log_time
            if channel.topic == "/odom":
                assert decoded.pose.pose.position.x == x_m[message.log_time * 250 // 10**9 - 1]
    assert dict(seen) == counts


def test_a_file_that_is_there_is_not_written_over(recording: MadeRecording, tmp_path: Path) -> None:
    topics = DriveTopics(SESSION)
    with pytest.raises(FileExistsError):
        write_topics(topics.registry, topics.messages(recording), tmp_path)
