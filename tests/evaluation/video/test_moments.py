"""Frames of a recorded drive: which there are, and where the vehicle is in them."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.video.moments import _of_this_version, moments
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.matching import matched
from simconsole.recording.reading import Recording
from simconsole.values.errors import RecordingError
from simconsole.values.state_vector import PLATFORM_AT


@pytest.fixture(scope="module")
def log(short: Path) -> Recording:
    return open_bundle(short).log


def test_frames_come_at_their_rate_whatever_the_tick(log: Recording) -> None:
    found = list(moments(log, 0.0, None, 30))
    assert np.diff([moment.t_s for moment in found]) == pytest.approx(1.0 / 30.0)
    assert len(found) == 30 * 3
    assert all(0.0 <= moment.t_s - moment.snapshot.t_s < 1.0 / 250.0 for moment in found)


def test_the_vehicle_is_where_it_was_between_two_ticks(log: Recording) -> None:
    table = log.table(("vehicle.x_m", "vehicle.yaw_rad"))
    t_s = table.ticks / table.tick_hz
    for moment in moments(log, 1.0, 2.5, 170):
        assert moment.shown.x_m == pytest.approx(np.interp(moment.t_s, t_s, table.vectors[:, 0]), abs=1e-9)


def test_a_part_of_the_drive_can_be_chosen(log: Recording) -> None:
    found = list(moments(log, 1.0, 2.0, 25))
    assert len(found) == 26
    assert found[0].t_s == pytest.approx(1.0)
    assert found[-1].t_s == pytest.approx(2.0)


def test_more_frames_than_ticks_are_frames_between_ticks(log: Recording) -> None:
    found = list(moments(log, 2.0, 2.1, 1000))
    assert len(found) == 101
    assert len({moment.shown.x_m for moment in found}) == len(found)


def test_after_the_end_there_is_nothing_to_see(log: Recording) -> None:
    with pytest.raises(RecordingError, match=r"nothing to see from 9 s: the drive ends at 3 s"):
        next(moments(log, 9.0, None, 30))


def test_a_vector_of_another_version_is_read_by_name() -> None:
    match = matched(("a", "b", "c"), ("c", "x", "a"))
    now = _of_this_version(np.array((3.0, 9.0, 1.0)), match)
    assert len(now) == PLATFORM_AT
    assert now[:3].tolist() == [1.0, 0.0, 3.0]
