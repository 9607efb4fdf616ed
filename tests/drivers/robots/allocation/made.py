"""Problems to allocate."""

import numpy as np

from simconsole.drivers.robots.allocation.problem import Problem, problem_of


def scene(rng: np.random.Generator, robots: int = 3, tasks: int = 5) -> Problem:
    """Robots and tasks anywhere in the arena, with straight ways."""
    places = [(float(x), float(y)) for x, y in rng.uniform((0.0, 0.0), (9.0, 6.0), (robots + tasks, 2))]
    return problem_of(places[:robots], places[robots:])


def one_way(rng: np.random.Generator, robots: int = 3, tasks: int = 5) -> Problem:
    """Costs of any size, other there than back: nothing that geometry would promise."""
    start, between = rng.uniform(0.0, 9.0, (robots, tasks)), rng.uniform(0.0, 9.0, (tasks, tasks))
    return Problem(tuple(map(tuple, start.tolist())), tuple(map(tuple, between.tolist())))
