"""Cars in random states, left alone under full brake: compiled, so that thousands of them come to rest in seconds.

`python -m tests.vehicle.random_states 5000` does it for 5,000 cars and prints the fastest of them after 20 s.
"""

import random
import sys
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.host.jit import compiled
from simconsole.values.kernels import put
from simconsole.values.platform import Ground
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.car.car_step import step
from simconsole.vehicle.car.state import CarState
from tests.vehicle.driving import IDLE, platform

GROUNDS: Final = 100
SPREAD: Final = {
    "vx_mps": 25.0,
    "vy_mps": 8.0,
    "yaw_rate_radps": 2.0,
    "heave_m": 0.05,
    "heave_mps": 0.5,
    "roll_rad": 0.08,
    "pitch_rad": 0.05,
    "road_wheel_rad": 0.5,
}
WHEEL_SPREAD: Final = {
    "radps": 60.0,
    "deflection_x_m": 0.02,
    "deflection_y_m": 0.02,
    "lift_m": 0.03,
    "lift_mps": 0.5,
}
_step = compiled(step)


class Cars(NamedTuple):
    """Rows of cars, their parameters, and the ground that each stands on."""

    rows: NDArray[np.float64]
    parameters: NDArray[np.float64]
    grounds: NDArray[np.float64]


def settle(cars: Cars, seconds: float) -> None:
    """Hold what each car's row commands, at ticks of 0.2 s: so long that calling compiled code takes no time."""
    before = np.zeros_like(cars.rows[0])
    for row, ground in zip(cars.rows, cars.grounds, strict=True):
        for _ in range(round(seconds / 0.2)):
            before[:] = row
            _step(before, row, cars.parameters, ground, 200)


def random_cars(count: int, seed: int, steered_rad: float = 0.0, **command: float) -> Cars:
    """Return cars of random speeds, spins, leans, lifts, deflections, on ground of random friction and slope.

    The friction is 0.5 or more: on ice a car would still be sliding after 20 s.
    """
    rng = random.Random(seed)
    grounds = [
        platform(ground=Ground(rng.uniform(0.5, 1.2), rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1)))
        for _ in range(min(count, GROUNDS))
    ]
    spread = SPREAD | {f"{at}_{name}": size for at in ("fl", "fr", "rl", "rr") for name, size in WHEEL_SPREAD.items()}
    sizes = np.array([spread.get(name, 0.0) for name in CarState._fields])
    rows = np.zeros((count, PLATFORM_AT + len(sizes)))
    draw = np.random.default_rng(seed)
    rows[:, PLATFORM_AT:] = grounds[0].initial_state + sizes * draw.uniform(-1.0, 1.0, (count, len(sizes)))
    for row in rows:
        put(row, LAYOUT.command.start, IDLE._replace(road_wheel_rad=rng.uniform(-steered_rad, steered_rad), **command))
    on = np.array([grounds[index % len(grounds)].ground for index in range(count)])
    return Cars(rows, grounds[0].parameters, on)


def speeds_mps(cars: Cars) -> NDArray[np.float64]:
    """Return the speed of each car, a turn of 1 rad/s counted as 1 m/s."""
    now: Any = CarState(*cars.rows[:, PLATFORM_AT:].T)
    fastest: NDArray[np.float64] = np.abs(now.vx_mps) + np.abs(now.vy_mps) + np.abs(now.yaw_rate_radps)
    return fastest


if __name__ == "__main__":
    seed = random.SystemRandom().randrange(2**32)
    print(f"seed {seed}")
    drawn = random_cars(int(sys.argv[1]), seed, brake=1.0, clutch=1.0)
    settle(drawn, 20.0)
    left = speeds_mps(drawn)
    print(f"{len(left)} cars: at most {left.max():.2g} m/s after 20 s, {int((left >= 1e-6).sum())} at 1e-6 m/s or more")
