"""A drive in memory: every vector, and the hash that a log of it would have."""

import numpy as np
import pytest

from simconsole.evaluation.checks.memory_recorder import FIRST_TICKS, MemoryRecorder
from simconsole.recording.framing import START_OF_CHAIN, seal
from simconsole.values.state_vector import Snapshot


def vectors(ticks: int) -> np.ndarray:
    return np.arange(3.0 * ticks).reshape(ticks, 3)


def recorded(rows: np.ndarray, most: int, first_tick: int = 1, digest: bytes = START_OF_CHAIN) -> MemoryRecorder:
    recorder = MemoryRecorder(most, rows.shape[1], digest)
    for tick, row in enumerate(rows, first_tick):
        assert recorder.write(Snapshot(tick, 250, row)) == 0
    return recorder


@pytest.mark.parametrize("ticks", [1, FIRST_TICKS, FIRST_TICKS + 1, 2 * FIRST_TICKS + 1])
def test_every_vector_is_kept_however_often_room_is_made(ticks: int) -> None:
    rows = vectors(ticks)
    recorder = recorded(rows, 10 * FIRST_TICKS)
    assert recorder.ticks == ticks
    assert np.array_equal(recorder.vectors, rows)


def test_room_is_made_for_as_many_as_the_drive_may_have_and_no_more() -> None:
    rows = vectors(FIRST_TICKS + 10)
    recorder = recorded(rows, FIRST_TICKS + 10)
    assert recorder.vectors.base is not None
    assert len(recorder.vectors.base) == FIRST_TICKS + 10


def test_the_hash_is_that_of_a_log_and_goes_on_from_an_earlier_drive() -> None:
    rows = vectors(3)
    digest = START_OF_CHAIN
    for tick, row in enumerate(rows, 1):
        digest = seal(digest, tick, row.tobytes())[1]
    assert recorded(rows, 3).digest == digest
    half = recorded(rows[:2], 2)
    assert recorded(rows[2:], 1, 3, half.digest).digest == digest


def test_a_vector_is_kept_as_it_was_though_its_row_is_used_again() -> None:
    row = np.zeros(3)
    recorder = recorded(row[None], 2)
    row[:] = 9.0
    assert not recorder.vectors.any()
