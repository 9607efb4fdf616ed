import pytest

from simconsole.drivers.robots.allocation.problem import Objective, problem_of

LINE = problem_of([(0.0, 0.0), (10.0, 0.0)], [(1.0, 0.0), (3.0, 0.0), (9.0, 0.0)])


def test_robots_stay_where_their_last_task_is() -> None:
    assert LINE.way(0, (1, 0)) == 5.0
    assert LINE.way(1, ()) == 0.0
    assert LINE.cost(((0, 1), (2,)), Objective.SUM) == 4.0
    assert LINE.cost(((0, 1), (2,)), Objective.MAKESPAN) == 3.0


@pytest.mark.parametrize(
    ("tours", "complete"),
    [
        (((0, 1), (2,)), True),
        (((0,), (2,)), False),
        (((0, 1), (1, 2)), False),
        (((0, 1, 2),), False),
    ],
)
def test_every_task_is_done_once(tours: tuple[tuple[int, ...], ...], complete: bool) -> None:
    assert LINE.is_complete(tours) == complete


def test_without_a_robot_that_has_failed_the_others_remain() -> None:
    left = LINE.without(0)
    assert (left.robots, left.tasks) == (1, 3)
    assert left.way(0, (2,)) == 1.0
