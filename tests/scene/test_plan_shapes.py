import numpy as np

from simconsole.scene.plan_shapes import KEPT_NS, LIFT_M, Plans
from simconsole.values.planned_path import PlannedPath


def planned(t_ns: int, count: int = 3) -> PlannedPath:
    return PlannedPath(t_ns, np.arange(4.0 * count).reshape(count, 4))


def test_a_plan_is_its_places_a_little_above_the_road() -> None:
    found = Plans().until(300, [planned(100)])
    assert found.times_ns == [100]
    np.testing.assert_array_equal(found.points[0], planned(0).places[:, 1:] + (0.0, 0.0, LIFT_M))


def test_a_plan_that_nobody_renews_is_taken_away_once_its_time_is_over() -> None:
    plans = Plans()
    assert plans.until(100 + KEPT_NS, [planned(100)]).times_ns == [100]
    gone = plans.until(101 + KEPT_NS, ())
    assert (gone.times_ns, [len(points) for points in gone.points]) == ([100 + KEPT_NS], [0])
    assert plans.until(10 * KEPT_NS, ()).times_ns == []


def test_between_two_plans_far_apart_there_is_none_however_the_drive_is_cut() -> None:
    late = 5 * KEPT_NS
    whole = Plans().until(late, [planned(0), planned(late)])
    cut = Plans()
    parts = [cut.until(KEPT_NS // 2, [planned(0)]), cut.until(3 * KEPT_NS, ()), cut.until(late, [planned(late)])]
    assert whole.times_ns == [0, KEPT_NS, late] == [at for part in parts for at in part.times_ns]
    assert [len(points) for points in whole.points] == [3, 0, 3]


def test_who_has_no_plan_any_more_takes_it_away_at_once_and_nothing_is_taken_twice() -> None:
    plans = Plans()
    found = plans.until(300, [planned(100), planned(200, 0)])
    assert [len(points) for points in found.points] == [3, 0]
    assert plans.until(10 * KEPT_NS, ()).times_ns == []
