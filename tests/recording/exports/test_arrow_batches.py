import pyarrow

from simconsole.recording.exports.arrow_batches import UNIT, batches, schema
from simconsole.recording.exports.column_table import ColumnTable, TableChoice
from tests.recording.made import MadeRecording

CHOICE = TableChoice(("vehicle.x_m", "arbitration.mode"), labels=True)


def test_types_and_units(recording: MadeRecording) -> None:
    made = schema(ColumnTable(recording, CHOICE))
    assert made.names == ["tick", "time_s", "arbitration.mode_label", "vehicle.x_m"]
    assert made.types == [pyarrow.int64(), pyarrow.float64(), pyarrow.string(), pyarrow.float64()]
    assert [field.metadata[UNIT] for field in made] == [b"ticks", b"s", b"1", b"m"]


def test_batches_are_the_blocks(recording: MadeRecording) -> None:
    told: list[int] = []
    assert [batch.num_rows for batch in batches(ColumnTable(recording, CHOICE), told.append)] == [300, 300, 300, 100]
    assert told == [300, 600, 900, 1000]
