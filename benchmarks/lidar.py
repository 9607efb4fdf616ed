"""Rays per second of CPU time on one core: the shipped arena, seen by three robots that see each other.

python benchmarks/lidar.py [--scans N]
"""

import argparse
import time

import numpy as np

from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import ArenaProfile
from simconsole.values.host.jit import compiled
from simconsole.world.arena.outlines import outlines_of
from simconsole.world.arena.raycast import cast_all, ray_grid

RAYS = 360
MOST_M = 3.5
ROBOT_M = 0.105


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scans", type=int, default=20_000)
    scans = parser.parse_args().scans
    profile = load_world("arena")
    assert isinstance(profile, ArenaProfile)
    grid = ray_grid(outlines_of(profile))
    rng = np.random.default_rng(1)
    free = [(s.x_m, s.y_m) for s in (*profile.starts, *profile.targets)]
    turns = np.linspace(0.0, 2.0 * np.pi, RAYS, endpoint=False)
    jobs = []
    for _ in range(64):
        robots = np.array([free[place] for place in rng.permutation(len(free))[:3]])
        others = np.column_stack((robots[1:], np.full(2, ROBOT_M)))
        yaw = rng.uniform(0.0, 6.3)
        rays = np.column_stack(
            (np.full(RAYS, robots[0, 0]), np.full(RAYS, robots[0, 1]), np.cos(turns + yaw), np.sin(turns + yaw))
        )
        jobs.append((rays, others))
    ranges, run = np.empty(RAYS), compiled(cast_all)
    run(jobs[0][0], MOST_M, grid, jobs[0][1], ranges)
    best = 0.0
    for _ in range(5):
        begin = time.process_time()
        for scan in range(scans // 5):
            rays, others = jobs[scan % len(jobs)]
            run(rays, MOST_M, grid, others, ranges)
        best = max(best, scans // 5 * RAYS / (time.process_time() - begin))
    print(f"{best / 1e6:.2f} million rays/s of CPU time, {len(grid.segments)} walls, {len(grid.circles)} pillars")


if __name__ == "__main__":
    main()
