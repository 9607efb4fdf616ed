"""What a step of the gymnasium environment costs beside the ticks it is made of, in processor time of one process.

Run: python benchmarks/learning_step.py [--rounds N] [--step-ms MS ...]

The ticks alone are the same blocks of ticks on the same console, without action, observation and reward. Rounds are
interleaved; the least of them counts, for anything else on the machine only adds. The exit code is 1 above the bar.
"""

import argparse
import time

import numpy as np

from simconsole.cli.api.environment import DrivingEnvironment
from simconsole.tick.advance import advance_block
from simconsole.values.state_vector import LAYOUT

SEQUENCE = LAYOUT.ros.at("sequence")
STEPS = 400
BAR = 1.3


def main() -> None:
    words = argparse.ArgumentParser()
    words.add_argument("--rounds", type=int, default=15)
    words.add_argument("--step-ms", type=int, nargs="+", default=[20, 40, 100, 200])
    given = words.parse_args()
    ratios = []
    for step_ms in given.step_ms:
        whole, ticks = measured(DrivingEnvironment(speed_mps=8.0, step_ms=step_ms), given.rounds)
        ratios.append(whole / ticks)
        print(f"step of {step_ms:3d} ms: {whole:6.1f} us, its ticks alone {ticks:6.1f} us, ratio {ratios[-1]:.2f}")
    if max(ratios) > BAR:
        raise SystemExit(f"above the bar of {BAR:g}")


def measured(environment: DrivingEnvironment, rounds: int) -> tuple[float, float]:
    """Return the time in us of a step, and of its ticks."""
    action = np.zeros(1, np.float32)
    wholes, parts = [], []
    for _ in range(rounds):
        environment.reset(seed=1, options={"s_m": 0.0})
        began_s = time.process_time()
        for _ in range(STEPS):
            environment.step(action)
        wholes.append(time.process_time() - began_s)
        environment.reset(seed=1, options={"s_m": 0.0})
        for _ in range(STEPS // 2):  # at the same speeds as above
            environment.step(action)
        console, vector, rows = environment._console, environment._rows[0], environment._rows[1:]
        assert console is not None
        rows[:, SEQUENCE] += 1.0  # the command of a step is a new one
        began_s = time.process_time()
        for _ in range(STEPS):
            advance_block(vector, rows, console)
        parts.append(time.process_time() - began_s)
    return 1e6 * min(wholes) / STEPS, 1e6 * min(parts) / STEPS


if __name__ == "__main__":
    main()
