"""A sequential auction: task after task goes to the robot that can fit it in most cheaply.

In each round every robot bids for every open task what it would add to the objective at the best place of its tour
(Lagoudakis et al., RSS 2005); the least bid wins. Fast, without any bound that would hold for a makespan.
"""

from simconsole.drivers.robots.allocation.problem import Allocation, Objective, Problem


def auction(problem: Problem, objective: Objective) -> Allocation:
    """Return the allocation of an auction."""
    tours: list[list[int]] = [[] for _ in range(problem.robots)]
    ways = [0.0] * problem.robots
    open_tasks = list(range(problem.tasks))
    while open_tasks:
        _, way, robot, place, task = min(
            _bid(problem, objective, tours, ways, robot, place, task)
            for task in open_tasks
            for robot in range(problem.robots)
            for place in range(len(tours[robot]) + 1)
        )
        tours[robot].insert(place, task)
        ways[robot] = way
        open_tasks.remove(task)
    found = tuple(map(tuple, tours))
    return Allocation(found, problem.cost(found, objective))


def _bid(
    problem: Problem,
    objective: Objective,
    tours: list[list[int]],
    ways: list[float],
    robot: int,
    place: int,
    task: int,
) -> tuple[float, float, int, int, int]:
    """Return what counts in the auction, the robot's way with the task, and what the bid is for."""
    tour = tours[robot]
    way = problem.way(robot, [*tour[:place], task, *tour[place:]])
    return way - ways[robot] if objective is Objective.SUM else way, way, robot, place, task
