import csv
from pathlib import Path

from simconsole.recording.exports.column_table import ColumnTable, TableChoice
from simconsole.recording.exports.csv_file import write_table
from tests.recording.made import COLUMNS, MadeRecording


def test_numbers_read_back_as_the_same_float64(recording: MadeRecording, tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    choice = TableChoice(("vehicle.y_m", "arbitration.mode"), labels=True)
    assert write_table(ColumnTable(recording, choice), path, lambda tick: None) == {"rows": 1000}
    with path.open(newline="") as file:
        head, *rows = list(csv.reader(file))
    assert head == ["tick", "time_s", "arbitration.mode_label", "vehicle.y_m"]
    assert [float(row[3]) for row in rows] == recording.vectors[:, COLUMNS.index("vehicle.y_m")].tolist()
    assert [int(row[0]) for row in rows] == list(range(1, 1001))
    assert {row[2] for row in rows} == {"MANUAL", "AUTONOMOUS"}
