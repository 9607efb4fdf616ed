import json
import random

import pytest

from simconsole.bridge.protocol.fragments import MAX_OPEN, TIMEOUT_NS, FragmentAssembler, split
from simconsole.bridge.protocol.operations import Fragment
from simconsole.values.errors import RemoteProtocolError


def pieces(text: str, size: int, identifier: str = "a") -> list[Fragment]:
    made = [json.loads(piece) for piece in split(text.encode(), size, identifier)]
    return [Fragment(piece["data"], piece["num"], piece["total"], piece["id"]) for piece in made]


@pytest.mark.parametrize("size", [1, 2, 3, 7, 100])
def test_what_is_split_comes_together_in_any_order(size: int) -> None:
    chance = random.Random(size)
    text = '{"é":"€𝄞", "x": [1, 2]}'
    assembler = FragmentAssembler(1000, 100)
    made = pieces(text, size) + pieces(text[::-1], size, "b")
    assert all(len(piece.data) <= size for piece in made)
    chance.shuffle(made)
    whole = [joined for piece in made if (joined := assembler.add(piece, 0)) is not None]
    assert sorted(whole) == sorted([text.encode(), text[::-1].encode()])
    assert assembler.held == 0


@pytest.mark.parametrize(
    ("more", "complaint"),
    [
        (Fragment("x", 1, 4, "a"), "total is 4, was 3"),
        (Fragment("x", 3, 3, "a"), "whole number below 3"),
        (Fragment("x", 0.5, 3, "a"), "whole number below 3"),
        (Fragment("x", 0, 3, "a"), "piece 0 is given twice"),
        (Fragment("x" * 95, 1, 3, "a"), "longer than 100 bytes"),
    ],
)
def test_wrong_piece_ends_its_message_and_leaves_nothing(more: Fragment, complaint: str) -> None:
    assembler = FragmentAssembler(100, 8)
    assert assembler.add(Fragment("123456", 0, 3, "a"), 0) is None
    with pytest.raises(RemoteProtocolError, match=complaint):
        assembler.add(more, 0)
    assert assembler.held == 0


def test_number_of_pieces_and_of_unfinished_messages_is_bounded() -> None:
    assembler = FragmentAssembler(100, 8)
    with pytest.raises(RemoteProtocolError, match="more than 8 fragments"):
        assembler.add(Fragment("", 0, 9, "a"), 0)
    for number in range(MAX_OPEN):
        assembler.add(Fragment("x", 0, 2, number), 0)
    with pytest.raises(RemoteProtocolError, match="are unfinished"):
        assembler.add(Fragment("x", 0, 2, "more"), TIMEOUT_NS)
    assert assembler.add(Fragment("x", 0, 2, "more"), TIMEOUT_NS + 1) is None
    assert assembler.held == 1
