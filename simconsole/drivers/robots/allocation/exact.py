"""The optimum, by dynamic programming over sets of tasks.

For each robot and each set of tasks, Held and Karp's recursion (J. SIAM 1962) gives the cheapest tour through the set.
A second recursion deals the sets out: the best that the first r robots can do with a set is, over all parts of it that
robot r may take, the best of its own tour and what the others do with the rest. Both look at every possibility that
can be part of an optimum, so the result is one; work grows as 3^tasks.
"""

from itertools import combinations_with_replacement, pairwise, permutations
from typing import Final, NamedTuple

from simconsole.drivers.robots.allocation.problem import Allocation, Objective, Problem

MOST_TASKS: Final = 14
_NEVER: Final = float("inf")


class Tours(NamedTuple):
    """Of one robot: what the cheapest tour through each set of tasks costs, and that which ends at a task of it."""

    cheapest: list[float]  # by set, a bit for each task
    ends: list[list[float]]  # by set and last task


def optimum(problem: Problem, objective: Objective) -> Allocation:
    """Return an allocation that no other is better than.

    Raises:
        ValueError: more than MOST_TASKS tasks, or no robot.
    """
    if problem.tasks > MOST_TASKS or not problem.robots:
        raise ValueError(f"{problem.tasks} tasks for {problem.robots} robots: at most {MOST_TASKS}, at least one robot")
    table = [_tours(problem, robot) for robot in range(problem.robots)]
    every = (1 << problem.tasks) - 1
    costs = [table[0].cheapest]
    taken: list[list[int]] = [list(range(every + 1))]
    for tours in table[1:]:
        dealt, parts = _dealt(costs[-1], tours.cheapest, objective)
        costs.append(dealt)
        taken.append(parts)
    left, found = every, []
    for robot in reversed(range(problem.robots)):
        part = taken[robot][left]
        found.append(_read(problem, table[robot], part))
        left ^= part
    chosen = tuple(reversed(found))
    return Allocation(chosen, problem.cost(chosen, objective))


def _dealt(before: list[float], own: list[float], objective: Objective) -> tuple[list[float], list[int]]:
    """Return for each set what it costs when one more robot may take a part of it, and that part."""
    sums = objective is Objective.SUM
    costs, parts = [0.0] * len(own), [0] * len(own)
    for whole in range(len(own)):
        best, chosen, part = before[whole], 0, whole
        while part:  # all parts of `whole` but the empty one
            mine, others = own[part], before[whole ^ part]
            cost = mine + others if sums else (mine if mine > others else others)
            if cost < best:
                best, chosen = cost, part
            part = (part - 1) & whole
        costs[whole], parts[whole] = best, chosen
    return costs, parts


def _tours(problem: Problem, robot: int) -> Tours:
    """Return the cheapest tours of one robot."""
    tasks = problem.tasks
    start, between = problem.start[robot], problem.between
    ends = [[_NEVER] * tasks for _ in range(1 << tasks)]
    cheapest = [0.0] * (1 << tasks)
    for whole in range(1, 1 << tasks):
        row = ends[whole]
        members = [task for task in range(tasks) if whole >> task & 1]
        for task in members:
            before = ends[whole ^ 1 << task]
            ways = [before[other] + between[other][task] for other in members if other != task]
            row[task] = min(ways) if ways else start[task]
        cheapest[whole] = min(row)
    return Tours(cheapest, ends)


def _read(problem: Problem, tours: Tours, part: int) -> tuple[int, ...]:
    """Return the cheapest tour through a set, from its last task back."""
    tour: list[int] = []
    while part:
        row = tours.ends[part]
        tasks = [task for task in range(problem.tasks) if part >> task & 1]
        last = min(tasks, key=lambda task: row[task] + (problem.between[task][tour[-1]] if tour else 0.0))
        tour.append(last)
        part ^= 1 << last
    return tuple(reversed(tour))


def enumerated(problem: Problem, objective: Objective) -> Allocation:
    """Return the optimum by looking at every allocation there is: the proof of the other way, and far slower.

    Every sequence of tasks, cut into as many pieces as there are robots at every place, is one.
    """
    best: Allocation | None = None
    for order in permutations(range(problem.tasks)):
        for cuts in combinations_with_replacement(range(problem.tasks + 1), problem.robots - 1):
            tours = tuple(order[a:b] for a, b in pairwise((0, *cuts, problem.tasks)))
            cost = problem.cost(tours, objective)
            if best is None or cost < best.cost:
                best = Allocation(tours, cost)
    assert best is not None
    return best
