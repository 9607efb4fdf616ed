"""Records in records, and a kernel that copies them: for plain and compiled reading and writing."""

from typing import NamedTuple

from simconsole.values.kernels import Row, kernel
from simconsole.values.layout import Part, lay_out, read, write


class Point(NamedTuple):
    x_m: float
    y_m: float


class Line(NamedTuple):
    """Of two records, and not of the same class."""

    begin: Point
    end: Point
    width: "Width"


class Width(NamedTuple):
    width_m: float


class Drawing(NamedTuple):
    point: Part[Point]
    line: Part[Line]


DRAWING = lay_out(Drawing)
SHIFTED = Part(Line, 3)


@kernel
def turned(row: Row, other: Row) -> float:
    """Copy the line backwards into another row; return the x of the point."""
    line = read(row, DRAWING.line)
    write(other, SHIFTED, Line(line.end, Point(line.begin.x_m, 7.0), Width(1)))
    return read(row, DRAWING.point).x_m
