import numpy as np
import pytest

from simconsole.drivers.robots.allocation.auction import auction
from simconsole.drivers.robots.allocation.exact import optimum
from simconsole.drivers.robots.allocation.problem import Objective, problem_of
from tests.drivers.robots.allocation.made import scene
from tests.samples import Sample


def gaps(objective: Objective, sample: Sample) -> list[float]:
    rng = np.random.default_rng(sample.seed)
    found = []
    for _ in range(300):
        problem = scene(rng)
        got = auction(problem, objective)
        assert problem.is_complete(got.tours)
        assert got.cost == problem.cost(got.tours, objective)
        found.append(got.cost / optimum(problem, objective).cost - 1.0)
    return found


def test_over_300_scenes_its_sum_is_near_the_optimum(sample: Sample) -> None:
    found = gaps(Objective.SUM, sample)
    assert min(found) > -1e-9
    assert np.mean(found) < 0.05
    assert np.mean(np.array(found) < 1e-9) > 0.5


def test_over_300_scenes_its_makespan_is_not(sample: Sample) -> None:
    found = gaps(Objective.MAKESPAN, sample)
    assert min(found) > -1e-9
    assert 0.05 < np.mean(found) < 0.4


def test_the_cheapest_task_is_sold_first_and_tours_take_others_on_their_way() -> None:
    line = problem_of([(0.0, 0.0), (20.0, 0.0)], [(4.0, 0.0), (2.0, 0.0), (18.0, 0.0)])
    assert auction(line, Objective.SUM).tours == ((1, 0), (2,))
    assert auction(line, Objective.SUM).cost == pytest.approx(6.0)
