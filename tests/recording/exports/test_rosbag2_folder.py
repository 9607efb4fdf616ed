from pathlib import Path
from typing import Any

from rosbags.interfaces import QosDurability
from rosbags.rosbag2 import Reader

from simconsole.recording.exports.drive_topics import DriveTopics
from simconsole.recording.exports.rosbag2_folder import write_topics
from tests.recording.made import SESSION, MadeRecording


def written(recording: MadeRecording, path: Path) -> dict[str, int]:
    topics = DriveTopics(SESSION)
    return write_topics(topics.registry, topics.messages(recording), path)


def test_metadata_say_what_is_in_the_folder(recording: MadeRecording, tmp_path: Path) -> None:
    counts = written(recording, tmp_path / "drive")
    assert sorted(path.name for path in (tmp_path / "drive").iterdir()) == ["drive.mcap", "metadata.yaml"]
    with Reader(tmp_path / "drive") as reader:
        assert {one.topic: one.msgcount for one in reader.connections} == counts
        assert reader.message_count == sum(counts.values())
        assert (reader.start_time, reader.end_time) == (4_000_000, 4_000_000_001)
        quality: dict[str, Any] = {one.topic: one.ext for one in reader.connections}
    durable = {name for name, ext in quality.items() if _latched(ext)}
    assert durable == {"/console/mode", "/map/markers", "/route", "/tf_static", "/traffic_signals/stop_lines"}
    text = (tmp_path / "drive" / "metadata.yaml").read_text()
    assert "storage_identifier: mcap" in text
    assert "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564" in text, "Clock, as ROS 2 has it"


def _latched(ext: Any) -> bool:
    return any(one.durability is QosDurability.TRANSIENT_LOCAL for one in ext.offered_qos_profiles)
