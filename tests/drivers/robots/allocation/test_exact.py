"""The optimum against every allocation that there is."""

import numpy as np
import pytest

from simconsole.drivers.robots.allocation.exact import MOST_TASKS, enumerated, optimum
from simconsole.drivers.robots.allocation.problem import Objective, Problem, problem_of
from tests.drivers.robots.allocation.made import one_way, scene
from tests.samples import Sample


@pytest.mark.parametrize("objective", Objective)
@pytest.mark.parametrize("make", [scene, one_way])
def test_no_allocation_is_better_than_the_optimum(make: object, objective: Objective, sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    for _ in range(sample.of(6, 300)):
        problem = make(rng)  # type: ignore[operator]  # one of the two functions
        found = optimum(problem, objective)
        assert problem.is_complete(found.tours)
        assert found.cost == problem.cost(found.tours, objective)
        assert found.cost == pytest.approx(enumerated(problem, objective).cost, rel=1e-12)


@pytest.mark.parametrize(("robots", "tasks"), [(1, 4), (2, 1), (4, 2), (3, 0), (2, 6)])
@pytest.mark.parametrize("objective", Objective)
def test_any_number_of_robots_and_tasks(robots: int, tasks: int, objective: Objective) -> None:
    rng = np.random.default_rng(robots + tasks)
    problem = scene(rng, robots, tasks)
    found = optimum(problem, objective)
    assert problem.is_complete(found.tours)
    assert found.cost == pytest.approx(enumerated(problem, objective).cost)


def test_the_two_objectives_want_different_things() -> None:
    together = problem_of([(0.0, 0.0), (0.0, 1.0)], [(5.0, 0.0), (6.0, 0.0)])
    assert sorted(map(len, optimum(together, Objective.SUM).tours)) == [0, 2], "one robot drives by both"
    apart = problem_of([(0.0, 0.0), (0.5, 0.0)], [(1.0, 0.0), (-1.0, 0.0)])
    assert sorted(map(len, optimum(apart, Objective.MAKESPAN).tours)) == [1, 1]


def test_too_many_tasks_and_no_robots_are_refused() -> None:
    with pytest.raises(ValueError, match=f"at most {MOST_TASKS}"):
        optimum(scene(np.random.default_rng(1), 1, MOST_TASKS + 1), Objective.SUM)
    with pytest.raises(ValueError, match="at least one robot"):
        optimum(Problem((), ()), Objective.SUM)


def test_a_way_that_does_not_exist_is_not_taken() -> None:
    never = float("inf")
    blocked = Problem(((never, 1.0), (5.0, never)), ((0.0, never), (never, 0.0)))
    assert optimum(blocked, Objective.SUM).tours == ((1,), (0,))
