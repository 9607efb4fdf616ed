"""State vectors into a view: what a block adds, and that its size changes nothing of it."""

from typing import Any, cast

import numpy as np

from simconsole.scene.timeline import Piece
from simconsole.scene.viewer.scene_writer import SceneWriter
from simconsole.values.planned_path import PlannedPath
from tests.scene.drives import job, rows

TICKS = 900
ROWS = rows(TICKS)


class Kept:
    """A view that keeps what it is given."""

    def __init__(self) -> None:
        self.pieces: list[Piece] = []
        self.plans_ns: list[int] = []
        self.others: list[Any] = []

    def add(self, piece: Piece) -> None:
        self.pieces.append(piece)

    def add_plans(self, shapes: Any) -> None:
        self.plans_ns += shapes.times_ns

    def add_road_users(self, shapes: Any) -> None:
        self.others.append(shapes)

    def whole(self, field: str) -> np.ndarray:
        """That field of all pieces, one behind the other."""
        return np.concatenate([getattr(piece, field) for piece in self.pieces])


def written(block: int, kind: str = "car") -> Kept:
    view = Kept()
    writer = SceneWriter(job(kind), cast("Any", view))
    for at in range(0, TICKS, block):
        ticks = np.arange(at + 1, min(at + block, TICKS) + 1)
        plans = [PlannedPath(int(ticks[0]) * 4_000_000, np.ones((3, 4)))]
        writer.add(ticks, ROWS[at : at + block], plans=plans if kind == "car" else ())
    return view


def test_the_size_of_the_blocks_changes_no_pose_and_no_line() -> None:
    whole, parts = written(TICKS), written(350)
    for field in ("ticks", "positions", "quaternions"):
        assert np.array_equal(whole.whole(field), parts.whole(field)), field
    assert len(whole.whole("ticks")) == 180, "3.6 s at 50 Hz"
    entries = [[entry for piece in view.pieces for entry in piece.entries] for view in (whole, parts)]
    assert entries[0] == entries[1] != []


def test_plans_are_written_as_they_come_each_for_a_second_and_nobody_on_an_empty_road() -> None:
    view = written(450)
    assert view.plans_ns == [1_000_000 * t_ms for t_ms in (4, 1004, 1804, 2804)]
    assert not view.others


def test_an_empty_block_writes_nothing() -> None:
    view = Kept()
    SceneWriter(job(), cast("Any", view)).add(np.arange(0), ROWS[:0])
    assert view.pieces == []
