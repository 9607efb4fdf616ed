"""What holds for all formats."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from pyarrow import csv, parquet
from rosbags.highlevel import AnyReader

from simconsole.recording.exports.column_table import TableChoice
from simconsole.recording.exports.drive_topics import DriveTopics
from simconsole.recording.exports.export_formats import FORMATS, TOPIC_FORMATS, export_drive
from simconsole.recording.reading import Block
from simconsole.values.errors import RecordingError
from simconsole.world.kinds.worlds import shown_map
from tests.recording.made import SESSION, MadeRecording, made_vectors

PATHS = {"mcap": "drive.mcap", "rosbag2": "drive", "csv": "drive.csv", "parquet": "drive.parquet"}
every_format = pytest.mark.parametrize("name", FORMATS)


@pytest.fixture
def path(tmp_path: Path, name: str) -> Path:
    return tmp_path / "made" / PATHS[name]


def times_ns(path: Path, name: str) -> list[int]:
    """When something stands in an export: odometry in topics, rows in tables."""
    if name in TOPIC_FORMATS:
        with AnyReader([path]) as reader:
            wanted = [connection for connection in reader.connections if connection.topic == "/odom"]
            return [time_ns for _, time_ns, _ in reader.messages(connections=wanted)]
    table = csv.read_csv(path) if name == "csv" else parquet.read_table(path)
    return [tick * 4_000_000 for tick in table["tick"].to_pylist()]


@every_format
def test_it_holds_the_drive_at_its_simulated_times(recording: MadeRecording, path: Path, name: str) -> None:
    choice = None if name in TOPIC_FORMATS else TableChoice(rate_hz=50.0)
    done = export_drive(recording, SESSION, name, path, choice)
    assert done.path == path
    assert times_ns(path, name) == [tick * 4_000_000 for tick in range(5, 1001, 5)]
    assert done.counts.get("/odom", done.counts.get("rows")) == 200


@every_format
def test_it_reads_block_by_block_once_and_says_how_far_it_is(recording: MadeRecording, path: Path, name: str) -> None:
    told: list[int] = []
    export_drive(recording, SESSION, name, path, on_tick=told.append)
    assert told == [300, 600, 900, 1000]
    assert recording.passes == 1
    assert [one.name for one in path.parent.iterdir()] == [path.name], "nothing is left beside it"


@every_format
def test_a_drive_without_a_tick_is_an_empty_export(path: Path, name: str) -> None:
    done = export_drive(MadeRecording(made_vectors(0)), SESSION, name, path)
    assert sum(done.counts.values()) == 0
    assert path.exists()


@every_format
def test_what_is_there_is_never_written_over(recording: MadeRecording, path: Path, name: str) -> None:
    path.mkdir(parents=True)
    with pytest.raises(RecordingError, match="cannot be exported to: it exists already"):
        export_drive(recording, SESSION, name, path)
    assert list(path.iterdir()) == []


class Interrupted(MadeRecording):
    """A drive whose export somebody interrupts."""

    def blocks(self, columns: Sequence[str] | None = None) -> Iterator[Block]:
        yield next(super().blocks(columns))
        raise KeyboardInterrupt


@every_format
def test_an_interrupted_export_leaves_nothing(recording: MadeRecording, path: Path, name: str) -> None:
    with pytest.raises(KeyboardInterrupt):
        export_drive(Interrupted(recording.vectors), SESSION, name, path)
    assert list(path.parent.iterdir()) == []


@every_format
def test_a_folder_that_takes_nothing_is_one_line(recording: MadeRecording, tmp_path: Path, name: str) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(RecordingError, match="cannot be exported to"):
        export_drive(recording, SESSION, name, tmp_path / "file" / PATHS[name])


@pytest.mark.parametrize("name", TOPIC_FORMATS)
def test_any_reader_finds_every_topic_with_the_stamps_of_the_log(
    recording: MadeRecording, path: Path, name: str
) -> None:
    export_drive(recording, SESSION, name, path)
    expected: dict[str, list[int]] = {}
    for message in DriveTopics(SESSION, shown=shown_map(None)).messages(recording):
        expected.setdefault(message.topic, []).append(message.time_ns)
    found: dict[str, list[int]] = {}
    with AnyReader([path]) as reader:
        for connection, time_ns, data in reader.messages():
            found.setdefault(connection.topic, []).append(time_ns)
            reader.deserialize(data, connection.msgtype)
    assert found == expected
