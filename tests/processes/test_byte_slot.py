"""Pieces of bytes between processes."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.processes.byte_slot import ByteSlot, Piece
from simconsole.values.errors import WorkerError

MOST = 9_216


def test_the_newest_piece_arrives_whole_and_an_unread_one_is_replaced(tmp_path: Path) -> None:
    slot = ByteSlot.create(tmp_path / "slot", MOST)
    reader = ByteSlot.open(tmp_path / "slot")
    assert reader.newest() is None
    generator = np.random.Generator(np.random.PCG64(1))
    for number, length in enumerate((1, 7, 9_000, MOST), start=1):
        content = generator.bytes(length)
        slot.write(number, b"never read")
        slot.write(number, content)
        assert reader.newest() == reader.newest() == Piece(number, content)


def test_pieces_are_taken_once_and_in_order_as_far_as_they_are_still_there(tmp_path: Path) -> None:
    slot = ByteSlot.create(tmp_path / "slot", MOST)
    reader = ByteSlot.open(tmp_path / "slot")
    assert reader.take() == []
    slot.write(7, b"a")
    slot.write(5, b"bc")
    assert reader.take() == [Piece(7, b"a"), Piece(5, b"bc")]
    assert reader.take() == []
    for number in range(9):
        slot.write(number, b"d")
    assert [piece.number for piece in reader.take()] == [6, 7, 8]
    assert reader.newest() == Piece(8, b"d")


def test_a_piece_that_is_too_long_is_refused(tmp_path: Path) -> None:
    slot = ByteSlot.create(tmp_path / "slot", MOST)
    with pytest.raises(WorkerError, match="9217 bytes: at most 9216"):
        slot.write(1, bytes(MOST + 1))
    assert slot.newest() is None


def test_what_is_not_there_cannot_be_opened(tmp_path: Path) -> None:
    with pytest.raises(WorkerError):
        ByteSlot.open(tmp_path / "nothing")
