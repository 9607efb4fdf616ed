"""What a fleet on two threads does against two processes that step one car each, in the same run.

Run: python benchmarks/fleet.py [--rounds N] [--cars N]

Steps of 1 ms by the clock on the wall, in rounds that alternate; the bar is the median ratio of steps a second, fleet
to processes: 0.9. Every car drives at its own speed, steering and throttle, in ticks of 4 ms.
"""

import argparse
import os
import statistics
import subprocess
import sys
import time

SUBSTEPS = 4
TICKS = 250
THREADS = 2


def main() -> None:
    """Print both speeds and their ratio."""
    words = argparse.ArgumentParser()
    words.add_argument("--rounds", type=int, default=7)
    words.add_argument("--cars", type=int, default=1000)
    words.add_argument("--part", action="store_true", help="one of the two processes: step half the cars one by one")
    given = words.parse_args()
    os.environ["NUMBA_NUM_THREADS"] = str(THREADS)
    if given.part:
        _part(given.cars // THREADS)
        return
    fleet = _fleet(given.cars)
    command = [sys.executable, __file__, "--part", "--cars", str(given.cars)]
    parts = [
        subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) for _ in range(THREADS)
    ]
    for part in parts:
        assert part.stdout is not None
        part.stdout.readline()
    steps = given.cars * SUBSTEPS * TICKS
    together: list[float] = []
    apart: list[float] = []
    for _ in range(given.rounds):
        began = time.perf_counter()
        for _ in range(TICKS):
            fleet.step(SUBSTEPS)
        together.append(time.perf_counter() - began)
        began = time.perf_counter()
        for part in parts:
            assert part.stdin is not None
            part.stdin.write("go\n")
            part.stdin.flush()
        for part in parts:
            assert part.stdout is not None
            part.stdout.readline()
        apart.append(time.perf_counter() - began)
    for part in parts:
        part.communicate()
    for name, times in (("fleet, two threads", together), ("two processes, one car each at a time", apart)):
        print(f"  {name:40} {1e-6 * steps / statistics.median(times):6.2f} M steps/s")
    ratio = statistics.median(b / a for a, b in zip(together, apart, strict=True))
    print(f"fleet against processes, median of {given.rounds} rounds: {ratio:.2f} (hold 0.9)")


def _start(cars: int):  # type: ignore[no-untyped-def]  # noqa: ANN202  # numba is loaded after its environment is set
    import numpy as np

    from simconsole.profiles.files.loader import load
    from simconsole.profiles.vehicle import CarProfile
    from simconsole.values.platform import Ground, Pose
    from simconsole.values.state_vector import LAYOUT
    from simconsole.vehicle.platforms import build

    vehicle = build(load("vehicles", "hatchback", CarProfile), Pose(0.0, 0.0, 0.0), Ground(1.0, 0.0, 0.0))
    states = np.array([vehicle.initial_state] * cars)
    states[:, 3] += np.linspace(5.0, 20.0, cars)
    commands = np.zeros((cars, LAYOUT.command.width))
    commands[:, 0] = np.linspace(-0.05, 0.05, cars)
    commands[:, 1] = np.linspace(0.0, 1.0, cars)
    commands[:, 5:7] = 1.0
    return vehicle, states, commands


def _fleet(cars: int):  # type: ignore[no-untyped-def]  # noqa: ANN202
    from simconsole.vehicle.batch.fleet import Fleet

    vehicle, states, commands = _start(cars)
    fleet = Fleet([vehicle] * cars)
    fleet.restore(states)
    fleet.command(commands)
    fleet.step(SUBSTEPS)
    return fleet


def _part(cars: int) -> None:
    """Step cars one after the other in one compiled call for each tick, whenever a line comes."""
    import numba
    import numpy as np

    from simconsole.values.host.jit import compiled
    from simconsole.values.state_vector import LAYOUT, PLATFORM_AT

    vehicle, states, commands = _start(cars)
    step = compiled(vehicle.step)
    rows = np.zeros((cars, PLATFORM_AT + states.shape[1]))
    rows[:, PLATFORM_AT:] = states
    rows[:, LAYOUT.command.start : LAYOUT.command.start + commands.shape[1]] = commands

    @numba.njit
    def tick(rows, parameters, ground, substeps):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN202
        for index in range(len(rows)):
            step(rows[index], rows[index], parameters, ground, substeps)

    tick(rows, vehicle.parameters, vehicle.ground, SUBSTEPS)
    print("ready", flush=True)
    for _ in sys.stdin:
        for _ in range(TICKS):
            tick(rows, vehicle.parameters, vehicle.ground, SUBSTEPS)
        print("done", flush=True)


if __name__ == "__main__":
    main()
