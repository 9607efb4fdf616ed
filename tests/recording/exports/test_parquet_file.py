from pathlib import Path

from pyarrow import parquet

from simconsole.recording.exports.column_table import ColumnTable, TableChoice
from simconsole.recording.exports.parquet_file import write_table
from tests.recording.made import COLUMNS, MadeRecording


def test_any_tool_reads_float64_columns_with_their_units(recording: MadeRecording, tmp_path: Path) -> None:
    path = tmp_path / "drive.parquet"
    assert write_table(ColumnTable(recording, TableChoice()), path, lambda tick: None) == {"rows": 1000}
    table = parquet.read_table(path)
    assert table.column_names == ["tick", "time_s", *COLUMNS]
    assert table["vehicle.y_m"].to_pylist() == recording.vectors[:, COLUMNS.index("vehicle.y_m")].tolist()
    assert table.schema.field("vehicle.yaw_rate_radps").metadata[b"unit"] == b"rad/s"
    assert parquet.ParquetFile(path).num_row_groups == 4
