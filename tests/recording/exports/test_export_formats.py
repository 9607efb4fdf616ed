import json
from pathlib import Path

import pytest

from simconsole.recording.exports.column_table import TableChoice
from simconsole.recording.exports.export_formats import (
    FORMATS,
    TABLE_FORMATS,
    TOPIC_FORMATS,
    default_path,
    export_drive,
)
from simconsole.values.errors import RecordingError
from tests.recording.made import SESSION, MadeRecording


def test_an_export_lies_beside_its_bundle() -> None:
    found = {name: default_path(Path("/drives/one"), name) for name in FORMATS}
    assert found == {
        "mcap": Path("/drives/one.mcap"),
        "rosbag2": Path("/drives/one-rosbag2"),
        "csv": Path("/drives/one.csv"),
        "parquet": Path("/drives/one.parquet"),
    }


@pytest.mark.parametrize("name", TOPIC_FORMATS)
def test_topics_have_no_columns_to_choose(recording: MadeRecording, tmp_path: Path, name: str) -> None:
    with pytest.raises(RecordingError, match="columns, rate, units, labels: only csv, parquet"):
        export_drive(recording, SESSION, name, tmp_path / "drive", TableChoice())


@pytest.mark.parametrize("name", TABLE_FORMATS)
def test_tables_have_no_layout(recording: MadeRecording, tmp_path: Path, name: str) -> None:
    with pytest.raises(RecordingError, match="layout: only mcap, rosbag2"):
        export_drive(recording, SESSION, name, tmp_path / "drive", layout=True)


@pytest.mark.parametrize("name", TOPIC_FORMATS)
def test_a_layout_is_written_beside_topics_and_never_over_another(
    recording: MadeRecording, tmp_path: Path, name: str
) -> None:
    done = export_drive(recording, SESSION, name, tmp_path / "drive.mcap", layout=True)
    assert done.layout == tmp_path / "drive.layout.json"
    assert "configById" in json.loads(done.layout.read_text())
    done.path.rename(tmp_path / "other.mcap")
    with pytest.raises(RecordingError, match=r"drive\.layout\.json: cannot be exported to: it exists already"):
        export_drive(recording, SESSION, name, tmp_path / "drive.mcap", layout=True)
