from typing import Any

import numpy as np
import pytest

from simconsole.evaluation.metrics.table import drive_of
from simconsole.values.errors import RecordingError


def test_columns_by_name_and_time_by_tick(known: Any) -> None:
    drive = drive_of(known.vectors, known.columns, 50, first_tick=101)
    assert drive.column("vehicle.vx_mps").tolist() == [10.0] * 1500
    assert drive.time_s[0] == pytest.approx(2.02)
    with pytest.raises(RecordingError, match=r"vehicle\.nothing is missing"):
        drive.column("vehicle.nothing")


@pytest.mark.parametrize(
    ("rows", "words"), [(np.zeros((0, 2)), "0 ticks"), (np.zeros((5, 3)), "3 columns, must be 2"), ([], "0 ticks")]
)
def test_rows_that_fit_nothing_are_refused(rows: Any, words: str) -> None:
    with pytest.raises(RecordingError, match=words):
        drive_of(rows, ("a.a", "b.b"), 250)
