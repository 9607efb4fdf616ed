import numpy as np

from simconsole.values.input_table import TICKS, InputTable
from simconsole.values.kernels import Row


def counted() -> tuple[InputTable, list[int]]:
    filled: list[int] = []

    def fill(tick: int, rows: Row) -> None:
        filled.append(tick)
        rows[:] = np.arange(tick, tick + len(rows))[:, np.newaxis]

    return InputTable(2, fill), filled


def test_every_tick_has_its_own_inputs_however_it_is_asked_for() -> None:
    one_by_one, at_once = counted()[0], counted()[0]
    rows = np.zeros((50, 2))
    tick = 1
    while tick < 3 * TICKS:
        count = at_once.foresee(tick, rows)
        assert count > 0
        assert rows[:count].tolist() == [one_by_one.values(tick + at) for at in range(count)]
        assert rows[:count, 0].tolist() == list(range(tick, tick + count))
        tick += count


def test_it_goes_no_further_than_its_piece() -> None:
    table, filled = counted()
    assert table.values(1) == [1.0, 1.0]
    rows = np.zeros((50, 2))
    assert table.foresee(TICKS - 9, rows) == 10
    assert filled == [1]
    assert table.foresee(TICKS + 1, rows) == 50
    assert filled == [1, TICKS + 1]


def test_a_tick_may_be_asked_for_again() -> None:
    table, filled = counted()
    assert [table.values(tick)[0] for tick in (5, 9, 7, 5)] == [5.0, 9.0, 7.0, 5.0]
    assert filled == [5]
