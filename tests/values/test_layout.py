"""Places of records in a vector: they follow from the fields, in plain Python and compiled."""

import numpy as np
import pytest

from simconsole.values.layout import read, write
from tests.values.drawing import DRAWING, SHIFTED, Line, Point, Width


def test_parts_lie_one_behind_the_other() -> None:
    assert [(part.start, part.width, part.stop) for part in DRAWING] == [(0, 2, 2), (2, 5, 7)]
    assert DRAWING.line.names == ("begin.x_m", "begin.y_m", "end.x_m", "end.y_m", "width.width_m")
    assert DRAWING.line.slice == slice(2, 7)
    assert (DRAWING.point.at("y_m"), DRAWING.line.at("end.x_m"), SHIFTED.at("end.x_m")) == (1, 4, 5)
    with pytest.raises(ValueError, match="not in tuple"):
        DRAWING.point.at("z_m")


def test_what_is_written_is_read_and_nothing_else_is_touched() -> None:
    row = np.arange(10.0)
    line = Line(Point(20.0, 30.0), Point(40.0, 50.0), Width(60.0))
    write(row, SHIFTED, line)
    assert row.tolist() == [0.0, 1.0, 2.0, 20.0, 30.0, 40.0, 50.0, 60.0, 8.0, 9.0]
    assert read(row, SHIFTED) == line
    assert all(type(value) is float for value in read(row, SHIFTED).begin)
