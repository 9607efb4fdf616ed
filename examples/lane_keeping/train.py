"""Learn to hold the lane: the cross-entropy method on a linear law, in environments that run in processes of their own.

python examples/lane_keeping/train.py [--generations N]
"""

import argparse
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simconsole import vector_environment

CANDIDATES, ELITE, PLACES = 24, 5, 4
OPTIONS: dict[str, Any] = {"speed_mps": 6.0, "longest_s": 20.0}
SCALE = np.array([0.0, 1.0, 1.0, 1.0, 0.0, 10.0, 10.0, 10.0])
"""What of an observation steers: lateral offset, heading, yaw rate and the curvature ahead, each of about 1."""

Law = NDArray[np.float64]


def returns(environments: Any, law: Law, seeds: Sequence[int]) -> Law:
    """Drive an episode by a law [8] from the place of each seed, one in each environment; return what each collects."""
    seen, _ = environments.reset(seed=list(seeds))
    collected, driving = np.zeros(len(seeds)), np.ones(len(seeds), bool)
    while driving.any():
        wheel = np.tanh(seen * SCALE @ law)[:, None].astype(np.float32)
        seen, reward, terminated, truncated, _ = environments.step(wheel)
        collected += reward * driving
        driving &= ~(terminated | truncated)
    return collected


def train(environments: Any, generations: int, seed: int = 1) -> Law:
    """Return the law that the best of the last generation agree on; every generation drives from other places."""
    random = np.random.default_rng(seed)
    mean, spread = np.zeros(len(SCALE)), np.ones(len(SCALE))
    for generation in range(generations):
        seeds = range(PLACES * generation, PLACES * (generation + 1))
        laws = mean + spread * random.standard_normal((CANDIDATES, len(SCALE)))
        collected = np.array([returns(environments, law, seeds).mean() for law in laws])
        best = laws[np.argsort(collected)[-ELITE:]]
        mean, spread = best.mean(0), best.std(0) + 0.3 / (1 + generation)
        print(f"generation {generation + 1:2d}: mean return {collected.mean():6.1f}, best {collected.max():6.1f}")
    return mean


def main() -> None:
    """Train, and show what was learned at places that were not trained on."""
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--generations", type=int, default=12)
    learners = vector_environment(PLACES, **OPTIONS)
    law = train(learners, words.parse_args().generations)
    unseen = range(900, 900 + PLACES)
    print("before:", returns(learners, np.zeros(len(SCALE)), unseen).round(1))
    print("after: ", returns(learners, law, unseen).round(1), "law", law.round(2))
    learners.close()


if __name__ == "__main__":
    main()
