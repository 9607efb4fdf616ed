from collections.abc import Iterator, Sequence
from typing import Any

import pytest

from simconsole.evaluation.metrics.marks import marks
from simconsole.evaluation.metrics.table import Array, Drive, drive_of
from simconsole.evaluation.metrics.track import track
from simconsole.values.signals import Button, Event


def in_blocks(drive: Drive, size: int) -> Drive:
    """Return the drive as one that is read in blocks of so many ticks."""

    def read(names: Sequence[str]) -> Iterator[Array]:
        for block in drive.read(names):
            yield from (block[at : at + size] for at in range(0, len(block), size))

    return drive._replace(read=read)


@pytest.mark.parametrize("size", [60, 10_000])
def test_marks_come_in_order_with_who_set_them_and_the_way_before(known: Any, size: int) -> None:
    vectors = known.vectors.copy()
    for tick, name, mask in (
        (100, "driver.edges", Button.MARK | Button.RESET),
        (50, "events.events", Event.MARK),
        (100, "events.ecu_events", Event.MARK),
        (70, "driver.edges", Button.RESET),
        (80, "events.events", Event.REQUEST_MANUAL),
    ):
        vectors[tick - 1, known.columns.index(name)] = float(mask)
    drive = drive_of(vectors, known.columns, 50)
    way = track(drive, None)
    found = marks(in_blocks(drive, size), way)
    assert [(mark["tick"], mark["t_s"], mark["by"]) for mark in found] == [
        (50, 1.0, "operator or ROS side"),
        (100, 2.0, "CAN"),
        (100, 2.0, "driver"),
    ]
    assert [mark["distance_m"] for mark in found] == [float(way.distance_m[at]) for at in (49, 99, 99)]


def test_a_recording_without_a_source_has_no_marks_of_it(known: Any) -> None:
    names = tuple(name for name in known.columns if not name.startswith("events."))
    vectors = known.vectors[:, [known.columns.index(name) for name in names]].copy()
    vectors[9, names.index("driver.edges")] = float(Button.MARK)
    drive = drive_of(vectors, names, 50)
    assert [(mark["tick"], mark["by"]) for mark in marks(drive, track(drive, None))] == [(10, "driver")]
