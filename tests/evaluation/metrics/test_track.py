"""Where a drive was, tick by tick, however it is read."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pytest

from simconsole.evaluation.metrics.drive_metrics import metrics, mode_changes
from simconsole.evaluation.metrics.table import Array, Drive, drive_of
from simconsole.evaluation.metrics.track import track
from simconsole.values.signals import Mode
from simconsole.world.course import Course
from tests.bits import difference


def in_blocks(drive: Drive, size: int) -> Drive:
    """Return the same drive, read in blocks of so many ticks."""

    def read(names: Sequence[str]) -> Iterator[Array]:
        (whole,) = drive.read(names)
        return (whole[at : at + size] for at in range(0, len(whole), size))

    return drive._replace(read=read)


def test_distance_speed_and_side_of_a_known_drive(known: Any, course: Course) -> None:
    way = track(drive_of(*known), course)
    assert way.distance_m[0] == 0.0
    assert way.distance_m[-1] == pytest.approx(300.0, abs=1.5)
    assert (np.diff(way.distance_m) > 0.0).all()
    assert way.speed_mps == pytest.approx(10.0)
    assert np.flatnonzero(way.autonomous).tolist() == list(range(250, 1250))
    assert way.mode[0] == Mode.MANUAL
    assert way.lateral_m[:250] == pytest.approx(0.3, abs=1e-6)
    assert len(track(drive_of(*known), None).lateral_m) == 0


def test_a_vehicle_that_was_put_elsewhere_did_not_drive_there(known: Any) -> None:
    rows = known.vectors.copy()
    rows[750:, known.columns.index("vehicle.x_m")] += 40.0
    way = track(drive_of(rows, known.columns, 50), None)
    assert way.distance_m[750] == way.distance_m[749]


@pytest.mark.parametrize("size", [1, 7, 250, 1499])
def test_the_blocks_in_which_it_is_read_change_no_bit(known: Any, course: Course, size: int) -> None:
    drive = drive_of(*known)
    parts = in_blocks(drive, size)
    whole, way = track(drive, course), track(parts, course)
    for one, other in ((getattr(whole, name), getattr(way, name)) for name in whole._fields):
        assert not difference(one, other)
    assert mode_changes(parts, way) == mode_changes(drive, whole)
    assert metrics(parts, course) == metrics(drive, course)
