import numpy as np
import pytest

from simconsole.recording.exports.column_table import LABELLED, ColumnTable, TableChoice
from simconsole.values.errors import RecordingError
from simconsole.values.units import DEG_PER_RAD
from tests.recording.made import COLUMNS, MadeRecording


def columns(recording: MadeRecording, choice: TableChoice) -> dict[str, list[object]]:
    table = ColumnTable(recording, choice)
    parts = list(table.blocks())
    return {
        column.name: [value for part in parts for value in part[place]] for place, column in enumerate(table.columns)
    }


def test_tick_and_time_come_first_and_then_the_chosen_columns(recording: MadeRecording) -> None:
    found = columns(recording, TableChoice(("vehicle.x_m", "ros.k*")))
    assert list(found) == ["tick", "time_s", "ros.kind", "vehicle.x_m"]
    assert found["tick"] == list(range(1, 1001))
    assert found["time_s"] == [tick / 250 for tick in range(1, 1001)]
    assert found["vehicle.x_m"] == recording.vectors[:, COLUMNS.index("vehicle.x_m")].tolist()


def test_all_columns_unless_some_are_chosen(recording: MadeRecording) -> None:
    assert [column.name for column in ColumnTable(recording, TableChoice()).columns][2:] == list(COLUMNS)


@pytest.mark.parametrize(("rate_hz", "rows"), [(250.0, 1000), (100.0, 400), (1.0, 4), (30.0, 120), (0.3, 1)])
def test_a_rate_keeps_ticks_and_makes_none_up(recording: MadeRecording, rate_hz: float, rows: int) -> None:
    found = columns(recording, TableChoice(("vehicle.x_m",), rate_hz))
    assert len(found["tick"]) == rows
    assert found["vehicle.x_m"] == [0.1 * tick for tick in found["tick"] if isinstance(tick, np.integer)]


def test_rows_of_a_rate_are_the_ticks_in_which_a_topic_of_it_is_published(recording: MadeRecording) -> None:
    assert columns(recording, TableChoice(("ros.kind",), 50.0))["tick"] == list(range(5, 1001, 5))


def test_units_of_displays_change_name_and_value(recording: MadeRecording) -> None:
    found = columns(recording, TableChoice(("vehicle.yaw_rad", "vehicle.vx_mps", "driver.gear"), display=True))
    assert list(found)[2:] == ["driver.gear", "vehicle.yaw_deg", "vehicle.vx_kmh"]
    assert found["vehicle.yaw_deg"][99] == 0.1 * DEG_PER_RAD
    assert found["vehicle.vx_kmh"][0] == pytest.approx(12.0)
    units = {column.name: column.unit for column in ColumnTable(recording, TableChoice(display=True)).columns}
    assert (units["vehicle.yaw_deg"], units["vehicle.vx_kmh"], units["tick"]) == ("deg", "km/h", "ticks")


def test_labels_are_the_words_that_people_read(recording: MadeRecording) -> None:
    found = columns(recording, TableChoice(("arbitration.mode", "arbitration.reason", "vehicle.x_m"), labels=True))
    assert list(found)[2:] == ["arbitration.mode_label", "arbitration.reason_label", "vehicle.x_m"]
    assert found["arbitration.mode_label"][499:501] == ["MANUAL", "AUTONOMOUS"]
    assert set(found["arbitration.reason_label"]) == {"drive started"}


def test_every_labelled_field_exists() -> None:
    assert {name.partition(".")[2] for name in COLUMNS} >= set(LABELLED)


@pytest.mark.parametrize("rate_hz", [0.0, -1.0, 251.0, float("nan"), float("inf")])
def test_a_rate_that_is_none_is_refused(recording: MadeRecording, rate_hz: float) -> None:
    with pytest.raises(RecordingError, match=r"--rate: value .*: above 0 to 250"):
        ColumnTable(recording, TableChoice(rate_hz=rate_hz))


def test_a_pattern_that_fits_nothing_is_refused(recording: MadeRecording) -> None:
    with pytest.raises(RecordingError, match=r"--columns: value 'vehicle.wings': fits no column of sample, ros"):
        ColumnTable(recording, TableChoice(("vehicle.x_m", "vehicle.wings")))
