"""Table I: methods of task allocation, on the shipped arena's paths and on random scenes, by CPU time.

python benchmarks/allocation.py [--scenes N]
"""

import argparse
import statistics
import time
from collections.abc import Callable

import numpy as np

from simconsole.drivers.robots.allocation.auction import auction
from simconsole.drivers.robots.allocation.exact import optimum
from simconsole.drivers.robots.allocation.genetic import genetic
from simconsole.drivers.robots.allocation.methods_table import MethodRow, methods_table
from simconsole.drivers.robots.allocation.path_costs import PathGrid, problem_on
from simconsole.drivers.robots.allocation.problem import Allocation, Objective, Problem, problem_of
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import ArenaProfile
from simconsole.world.arena.occupancy import FREE, grid_of

ROBOT_M = 0.155  # a Burger's radius and 5 cm
RUNS = 30
METHODS: dict[str, Callable[[Problem, Objective, int], Allocation]] = {
    "exact": lambda problem, objective, seed: optimum(problem, objective),
    "greedy auction": lambda problem, objective, seed: auction(problem, objective),
    "genetic and annealing": genetic,
}


def timed(method: str, problem: Problem, objective: Objective, seed: int) -> tuple[float, float]:
    """Return cost and CPU time of one run."""
    begin = time.process_time()
    found = METHODS[method](problem, objective, seed)
    return found.cost, time.process_time() - begin


def shipped() -> Problem:
    """Return the shipped arena's three robots and five targets, by paths."""
    profile = load_world("arena")
    assert isinstance(profile, ArenaProfile)
    grid = grid_of(profile, 0.05)
    paths = PathGrid(grid.cells == FREE, grid.resolution_m, (grid.x_m, grid.y_m), ROBOT_M)
    places = [[(spot.x_m, spot.y_m) for spot in spots] for spots in (profile.starts, profile.targets)]
    return problem_on(paths, *places)


def random_scene(rng: np.random.Generator) -> Problem:
    """Return three robots and five tasks anywhere in 6 x 9 m, with straight ways."""
    places = [(float(x), float(y)) for x, y in rng.uniform((0.0, 0.0), (9.0, 6.0), (8, 2))]
    return problem_of(places[:3], places[3:])


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=300)
    scenes = parser.parse_args().scenes
    problem = shipped()
    for objective in Objective:
        best = optimum(problem, objective)
        rows = []
        for method in METHODS:
            runs = [timed(method, problem, objective, seed) for seed in range(RUNS)]
            costs, times = zip(*runs, strict=True)
            rows.append(MethodRow(method, min(costs), best.cost, costs, times))
        print(methods_table(f"\nshipped arena, paths, {objective.value}: {best.tours}", rows))
    rng = np.random.default_rng(1)
    drawn = [
        problem_of(*(list(map(tuple, rng.uniform((0, 0), (9, 6), (n, 2)).tolist())) for n in (3, 5)))
        for _ in range(scenes)
    ]
    for objective in Objective:
        known = [optimum(scene, objective).cost for scene in drawn]
        print(
            f"\n{scenes} random scenes of 6 x 9 m, {objective.value}: optimum {statistics.mean(known):.2f} m on average"
        )
        for method in METHODS:
            runs = [timed(method, scene, objective, seed) for seed, scene in enumerate(drawn)]
            gaps = sorted(cost / least - 1.0 for (cost, _), least in zip(runs, known, strict=True))
            spent_ms = sorted(1000.0 * spent for _, spent in runs)
            print(
                f"{method:<22} median {statistics.median(spent_ms):.3f} ms, most {spent_ms[-1]:.3f} ms; gap mean "
                f"{100 * statistics.mean(gaps):.2f} %, p95 {100 * gaps[int(0.95 * len(gaps))]:.2f} %, most "
                f"{100 * gaps[-1]:.2f} %, optimal in {100 * sum(gap < 1e-9 for gap in gaps) / len(gaps):.0f} %"
            )


if __name__ == "__main__":
    main()
