"""How well the autopilot followed, while it had the car."""

import pytest

from simconsole.drivers.path_tracker.tracking_statistics import TrackingStatistics


def test_only_what_the_autopilot_drove_counts() -> None:
    kept = TrackingStatistics()
    for engaged, s_m, lateral_m, speed_mps in (
        (False, 90.0, 5.0, 30.0),
        (True, 100.0, 0.3, 10.0),
        (True, 104.0, -0.4, 20.0),
        (False, 200.0, 9.0, 0.0),
    ):
        kept.add(engaged, s_m, lateral_m, speed_mps)
    found = kept.results()
    assert (found["commands"], found["engaged_commands"], found["engaged_distance_m"]) == (4, 2, 4.0)
    assert found["lateral_rms_m"] == pytest.approx((0.5 * (0.09 + 0.16)) ** 0.5)
    assert (found["lateral_max_m"], found["mean_speed_mps"]) == (0.4, 15.0)


def test_a_drive_that_begins_at_the_courses_start_has_its_whole_distance() -> None:
    kept = TrackingStatistics()
    kept.add(True, 0.0, 0.0, 1.0)
    kept.add(True, 3.0, 0.0, 1.0)
    assert kept.results()["engaged_distance_m"] == 3.0


def test_without_an_engaged_autopilot_there_are_no_figures_and_no_division() -> None:
    kept = TrackingStatistics()
    kept.add(False, 1.0, 1.0, 1.0)
    found = kept.results()
    assert found.pop("commands") == 1
    assert (found.pop("skipped"), found.pop("engaged_commands"), found.pop("withheld")) == (0, 0, 0)
    assert found.pop("at_end") is False
    assert set(found.values()) == {None}
