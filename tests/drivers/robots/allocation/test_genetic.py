import numpy as np
import pytest

from simconsole.drivers.robots.allocation.exact import optimum
from simconsole.drivers.robots.allocation.genetic import GeneticSettings, crossed, genetic, tours_of
from simconsole.drivers.robots.allocation.problem import Objective
from tests.drivers.robots.allocation.made import scene
from tests.samples import Sample


@pytest.mark.parametrize("objective", Objective)
def test_over_many_scenes_it_is_mostly_optimal(objective: Objective, sample: Sample) -> None:
    rng, gaps = np.random.default_rng(sample.seed), []
    for seed in range(sample.of(40, 300)):
        problem = scene(rng)
        found = genetic(problem, objective, seed)
        assert problem.is_complete(found.tours)
        assert found.cost == problem.cost(found.tours, objective)
        gaps.append(found.cost / optimum(problem, objective).cost - 1.0)
    assert min(gaps) > -1e-9
    assert np.mean(gaps) < 0.03
    assert np.mean(np.array(gaps) < 1e-9) > 0.75


def test_equal_seeds_find_equal_allocations() -> None:
    problem = scene(np.random.default_rng(3), 4, 9)
    hasty = GeneticSettings(generations=2, annealing_steps=3)
    assert genetic(problem, Objective.SUM, 5, hasty) == genetic(problem, Objective.SUM, 5, hasty)
    assert len({genetic(problem, Objective.SUM, seed, hasty).cost for seed in range(6)}) > 1


def test_cuts_divide_a_sequence_among_robots() -> None:
    assert tours_of([2, 5, 0, 1, 6, 4, 3], 5) == ((2,), (0, 1), (4, 3))
    assert tours_of([5, 6, 0, 1, 2, 3, 4], 5) == ((), (), (0, 1, 2, 3, 4))


def test_a_child_has_everything_once() -> None:
    mother, father = [0, 1, 2, 3, 4, 5], [5, 4, 3, 2, 1, 0]
    assert crossed(mother, father, 3, 1) == [5, 1, 2, 3, 4, 0]
    assert sorted(crossed(mother, father, 0, 5)) == mother
