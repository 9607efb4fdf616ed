"""A genetic method whose best are annealed, as the literature on several robots and tasks has it.

An individual is a sequence of tasks and of cuts between robots. Parents win tournaments, children take a stretch of one
parent and the order of the other (order crossover, Davis 1985), some are changed at random; the best of each generation
is annealed (Kirkpatrick, Gelatt, Vecchi, Science 1983). All is drawn from the seed.
"""

import math
from collections.abc import Callable
from typing import Final, NamedTuple

from simconsole.drivers.robots.allocation.problem import Allocation, Objective, Problem, Tours
from simconsole.values.draws import Channel, even

Order = list[int]
"""Tasks by number; numbers from the count of tasks on are cuts: behind each the next robot begins."""
Cost = Callable[[Order], float]


class GeneticSettings(NamedTuple):
    """How long and how hard it looks."""

    population: int = 24
    generations: int = 20
    tournament: int = 3
    mutation_share: float = 0.3
    annealing_steps: int = 40
    hot: float = 0.3  # temperature at first, as a share of the best cost
    cold: float = 0.01


DEFAULTS: Final = GeneticSettings()


class _Dice:
    """Numbers from a seed, one after the other."""

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self._count = 0

    def share(self) -> float:
        """Return a number from 0 to 1, 1 excluded."""
        self._count += 1
        return even(self._seed, Channel.ALLOCATION, self._count)

    def below(self, count: int) -> int:
        """Return a whole number from 0 to `count` - 1."""
        return int(self.share() * count)

    def shuffled(self, count: int) -> Order:
        """Return the numbers below `count` in an order."""
        order = list(range(count))
        for place in range(count - 1, 0, -1):
            other = self.below(place + 1)
            order[place], order[other] = order[other], order[place]
        return order


def genetic(problem: Problem, objective: Objective, seed: int, settings: GeneticSettings = DEFAULTS) -> Allocation:
    """Return the best allocation that this method finds; equal seeds find equal ones."""
    dice = _Dice(seed)
    length = problem.tasks + problem.robots - 1

    def cost(order: Order) -> float:
        return problem.cost(tours_of(order, problem.tasks), objective)

    drawn = [dice.shuffled(length) for _ in range(settings.population)]
    population = sorted((cost(order), order) for order in drawn)

    def parent() -> Order:
        return min(population[dice.below(len(population))] for _ in range(settings.tournament))[1]

    for _ in range(settings.generations):
        children = [population[0]]
        while len(children) < settings.population:
            child = crossed(parent(), parent(), dice.below(length), dice.below(length))
            if dice.share() < settings.mutation_share:
                child = _changed(child, dice)
            children.append((cost(child), child))
        children.sort()
        children[0] = min(children[0], _annealed(children[0], cost, dice, settings))
        population = children
    best = tours_of(population[0][1], problem.tasks)
    return Allocation(best, population[0][0])


def tours_of(order: Order, tasks: int) -> Tours:
    """Return the tours that a sequence with cuts means."""
    tours: list[list[int]] = [[]]
    for item in order:
        if item < tasks:
            tours[-1].append(item)
        else:
            tours.append([])
    return tuple(map(tuple, tours))


def crossed(mother: Order, father: Order, first: int, second: int) -> Order:
    """Return the stretch between two places of the mother where it was, the rest in the father's order."""
    low, high = min(first, second), max(first, second) + 1
    kept = set(mother[low:high])
    rest = [item for item in father if item not in kept]
    return [*rest[:low], *mother[low:high], *rest[low:]]


def _changed(order: Order, dice: _Dice) -> Order:
    """Return the order with two items swapped, one moved, or a stretch turned round."""
    a, b = dice.below(len(order)), dice.below(len(order))
    low, high = min(a, b), max(a, b) + 1
    kind = dice.below(3)
    if kind == 0:
        changed = list(order)
        changed[a], changed[b] = changed[b], changed[a]
        return changed
    if kind == 1:
        changed = list(order)
        changed.insert(b, changed.pop(a))
        return changed
    return [*order[:low], *reversed(order[low:high]), *order[high:]]


def _annealed(begin: tuple[float, Order], cost: Cost, dice: _Dice, settings: GeneticSettings) -> tuple[float, Order]:
    """Return the best of a walk that takes worse steps less and less often."""
    here = best = begin
    scale = max(begin[0], 1e-9)
    for step in range(settings.annealing_steps):
        share = step / settings.annealing_steps
        temperature = scale * settings.hot * (settings.cold / settings.hot) ** share
        order = _changed(here[1], dice)
        there = (cost(order), order)
        worse = there[0] - here[0]
        if worse <= 0.0 or dice.share() < math.exp(-worse / temperature):
            here = there
        best = min(best, here)
    return best
