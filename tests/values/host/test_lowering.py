"""What numba is taught compiles to what the plain functions do."""

import math

import numba
import numpy as np
import pytest
from numba.core.errors import TypingError

from simconsole.values.host import lowering
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import Row, foreseen, kernel
from simconsole.values.layout import write
from tests.values.drawing import SHIFTED, Line, Point, Width, turned


def test_compiled_code_reads_and_writes_the_same() -> None:
    row = np.arange(7.0)
    slow, fast = np.full(9, -1.0), np.full(9, -1.0)
    assert compiled(turned)(row, fast) == turned(row, slow) == 0.0
    assert fast.tolist() == slow.tolist() == [-1.0, -1.0, -1.0, 4.0, 5.0, 2.0, 7.0, 1.0, -1.0]


@kernel
def doubled_below_one(value: float) -> float:
    if value < 1.0:
        foreseen()
        value = 2.0 * value
    return value


@pytest.mark.parametrize(("value", "expected"), [(0.25, 0.5), (1.0, 1.0), (math.inf, math.inf)])
def test_a_foreseen_branch_gives_the_same_in_both_executions(value: float, expected: float) -> None:
    assert compiled(doubled_below_one)(value) == doubled_below_one(value) == expected


def test_a_foreseen_branch_stays_a_jump() -> None:
    lowering.teach()
    machine_code = numba.njit(numba.float64(numba.float64))(doubled_below_one)
    (intermediate,) = machine_code.inspect_llvm().values()
    assert " select " not in intermediate


@kernel
def half_written(row: Row) -> float:
    """Write a record whose floats are whole numbers and truths."""
    write(row, SHIFTED, Line(Point(1, 2), Point(True, False), Width(row[0])))
    return float(row[3])


def test_whole_numbers_and_truths_are_stored_as_floats() -> None:
    slow, fast = np.full(9, 5.5), np.full(9, 5.5)
    assert compiled(half_written)(fast) == half_written(slow) == 1.0
    assert fast.tolist() == slow.tolist() == [5.5, 5.5, 5.5, 1.0, 2.0, 1.0, 0.0, 5.5, 5.5]


@kernel
def misplaced(row: Row) -> None:
    write(row, SHIFTED, Point(1.0, 2.0))  # type: ignore[misc]  # what the compiler must refuse


def test_another_record_than_the_parts_is_refused_by_the_compiler() -> None:
    with pytest.raises(TypingError, match=r"No implementation of function .*write"):
        compiled(misplaced)(np.zeros(9))
