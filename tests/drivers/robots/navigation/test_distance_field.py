import math

import numpy as np
import pytest

from simconsole.drivers.robots.navigation.distance_field import FAR, distances
from simconsole.values.host.jit import compiled, plain
from tests.samples import Sample


def test_distances_are_those_to_the_nearest_obstacle(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    for _ in range(sample.of(20, 500)):
        obstacles = rng.random((rng.integers(1, 30), rng.integers(1, 30))) < rng.choice((0.01, 0.1, 0.5))
        if not obstacles.any():
            continue
        places = np.argwhere(obstacles)
        rows, columns = obstacles.shape
        known = [[min(math.dist((r, c), place) for place in places) for c in range(columns)] for r in range(rows)]
        assert distances(obstacles, compiled) == pytest.approx(np.array(known), abs=1e-9)


def test_both_executions_agree_and_an_empty_grid_is_far_from_everything() -> None:
    obstacles = np.zeros((7, 9), dtype=bool)
    assert (distances(obstacles, plain) >= math.sqrt(FAR)).all()
    obstacles[3, 2] = obstacles[6, 8] = True
    assert (distances(obstacles, plain) == distances(obstacles, compiled)).all()
