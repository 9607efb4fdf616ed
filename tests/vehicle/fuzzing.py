"""Millions of steps of cars that anything happens to: `python -m tests.vehicle.fuzzing --steps N --seed N --car tir`.

A fleet of cars on any ground, in any wind, with any commands (all axes, gears and both modes, nonsense and NaN among
them), hit now and then: velocities of up to 60 m/s out of nothing, spins, leans. After every tick each state is
compared with its bound; at the end all cars are put on level asphalt with the brake pressed and must come to rest.
"""

import argparse
import math
import random
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from time import process_time
from typing import Final, NamedTuple

import msgspec
import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from simconsole.profiles.files.loader import load, profiles_folder
from simconsole.profiles.tyre import TirTyre, parse_tir
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Ground, Patch, Platform
from simconsole.values.signals import VehicleCommand
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.batch.fleet import Fleet
from simconsole.vehicle.car.state import CarState
from simconsole.vehicle.platforms import build
from tests.vehicle.driving import LEVEL, ORIGIN, platform

CARS: Final = 1024
SUBSTEPS: Final = 4
HIT_MPS: Final = 60.0
NONSENSE: Final = (math.nan, math.inf, -math.inf, 1e300, -1e300, -5.0, 0.5, 99.0)
REST_S: Final = 40.0
REST_MPS: Final = 1e-6
WHEELS: Final = ("fl", "fr", "rl", "rr")
AT: Final = {name: index for index, name in enumerate(CarState._fields)}
COMMAND: Final = {name: index for index, name in enumerate(VehicleCommand._fields)}

Table = NDArray[np.float64]


BOUNDS: Final[dict[str, tuple[float, float]]] = {
    **dict.fromkeys(("x_m", "y_m"), (-1e5, 1e5)),  # some 100 s at 100 m/s, ten times over
    "yaw_rad": (-math.pi, math.pi),
    **dict.fromkeys(
        ("vx_mps", "vy_mps"), (-100.0, 100.0)
    ),  # both hits at once are 85 m/s; a hill of 42 % adds the rest
    "yaw_rate_radps": (-20.0, 20.0),  # grip of 1.2 turns the car by 12 rad/s2, hits by 6 rad/s
    **dict.fromkeys(("ax_mps2", "ay_mps2"), (-100.0, 100.0)),  # 1.2 times four times the weight, and landings
    **dict.fromkeys(("heave_m", "fl_lift_m", "fr_lift_m", "rl_lift_m", "rr_lift_m"), (-0.5, 0.5)),  # end of the model
    "heave_mps": (-10.0, 10.0),  # hits of 3 m/s, springs of 1.5 Hz over 0.5 m
    **dict.fromkeys(("roll_rad", "pitch_rad"), (-0.5, 0.5)),  # end of the model
    **dict.fromkeys(("roll_radps", "pitch_radps"), (-10.0, 10.0)),
    "distance_m": (0.0, 1e5),
    "road_wheel_rad": (-0.6284, 0.6284),  # max_road_wheel_deg: 36
    "road_wheel_radps": (-1.2218, 1.2218),  # max_road_wheel_degps: 70
    "patch_twist_rad": (-0.2, 0.2),  # FULL_TWIST_RAD
    "rim_friction_share": (-1.0, 1.0),
    "hand_wheel_torque_nm": (-14.9, 14.9),  # most_nm: 14, rim friction and damping of the fastest rack
    **dict.fromkeys(("fl_radps", "fr_radps", "rl_radps", "rr_radps"), (-330.0, 330.0)),  # 100 m/s over 0.306 m
    # slide_demand * grip / stiffness where a falling line leaves its least share, at three static loads (tyre.py);
    # grip is the tyre's 1.05 times the ground's 1.2
    **dict.fromkeys([f"{wheel}_deflection_x_m" for wheel in WHEELS], (-0.2646, 0.2646)),
    **dict.fromkeys([f"{wheel}_deflection_y_m" for wheel in WHEELS], (-0.4767, 0.4767)),
    **dict.fromkeys([f"{wheel}_lift_mps" for wheel in WHEELS], (-50.0, 50.0)),  # 37 kg thrown by a stop over 0.5 m
    **dict.fromkeys([f"{wheel}_brake_nm" for wheel in WHEELS], (0.0, 3600.0)),  # pedal 1700 N m and ESC 1900
    "engine_radps": (-4750.0, 4750.0),  # 330 rad/s at a wheel in first gear, clutch closed
    "engine_running": (0.0, 1.0),
    "engine_impulse_nms": (-0.27, 0.27),  # friction at that speed, in 1 ms
    "clutch_impulse_nms": (-0.28, 0.28),  # clutch_nm: 280
    **dict.fromkeys(("left_impulse_nms", "right_impulse_nms"), (-3.9, 3.9)),  # pedal 1650 N m, ESC 1900, rolling, gears
    "clutch_heat": (0.0, 2.0),  # burnt
    "clutch_hot": (0.0, 1.0),
    "lock_impulse_nms": (0.0, 0.0),  # an open differential
    **dict.fromkeys(("gear", "wanted_gear"), (-1.0, 6.0)),
    **dict.fromkeys(("clutch", "lever_adopted", "throttle_share", "hold_brake"), (0.0, 1.0)),
    "gear_fault": (0.0, 8.0),  # three bits, and the automatic's own
    "shift_left_s": (0.0, 0.25),
    "since_shift_s": (0.0, 10.0),
    "stability_nm": (-1900.0, 1900.0),
    "hold_left_s": (0.0, 2.0),
}
"""What each state of the hatchback may be, and why."""

# slide_demand 3.59 * peak / stiffness * relaxation length, largest along without load: 1.08 * 1.26 / 14.7 * 0.25 m;
# across at twice the nominal load with 0.6 rad of camber: 0.91 * 1.26 / 6.4 * 0.3 m (tir_tyre.py, example.tir)
TIR_BOUNDS: Final = BOUNDS | {
    **dict.fromkeys([f"{wheel}_deflection_x_m" for wheel in WHEELS], (-0.0835, 0.0835)),
    **dict.fromkeys([f"{wheel}_deflection_y_m" for wheel in WHEELS], (-0.2, 0.2)),
}
"""The same of the hatchback on example.tir: all but its contact patches is the same car."""


def on_tir(ground: Ground = LEVEL) -> Platform:
    """Return the hatchback on the shipped example of a PAC2002 tyre."""
    path = profiles_folder() / "vehicles" / "tyres" / "example.tir"
    tyre = TirTyre(tir=path.name, coefficients=parse_tir(path.read_text(), path.name))
    return build(msgspec.structs.replace(load("vehicles", "hatchback", CarProfile), tyre=tyre), ORIGIN, ground)


class Singles:
    """Cars with the ways of a `Fleet`, stepped one by one: a tyre's code is long, and lanes would compile it anew."""

    def __init__(self, platforms: Sequence[Platform]) -> None:
        self._constants = [(one.parameters, one.ground) for one in platforms]
        self._step = compiled(platforms[0].step)
        self._rows = np.zeros((len(platforms), PLATFORM_AT + len(AT)))
        self.restore([one.initial_state for one in platforms])

    @property
    def states(self) -> Table:
        return self._rows[:, PLATFORM_AT:].copy()

    @property
    def vehicles(self) -> Table:
        return self._rows[:, LAYOUT.vehicle.slice].copy()

    def command(self, commands: ArrayLike) -> None:
        self._rows[:, LAYOUT.command.slice] = commands

    def restore(self, states: ArrayLike) -> None:
        self._rows[:, PLATFORM_AT:] = states

    def step(self, substeps: int) -> None:
        for row, constants in zip(self._rows, self._constants, strict=True):
            self._step(row, row, *constants, substeps)


class Subject(NamedTuple):
    """What is fuzzed."""

    build: Callable[..., Platform]
    bounds: dict[str, tuple[float, float]]
    cars: int
    fleet: Callable[[Sequence[Platform]], Fleet | Singles]


SUBJECTS: Final = {
    "hatchback": Subject(platform, BOUNDS, CARS, Fleet),
    "tir": Subject(on_tir, TIR_BOUNDS, 32, Singles),
}


class Report(NamedTuple):
    """What a run found."""

    steps: int
    lowest: dict[str, float]
    highest: dict[str, float]
    beyond: list[str]  # states that left their bounds or are no number
    rest_mps: float  # of the fastest car at the end, its yaw rate counted as metres
    cpu_s: float


def commands(rng: np.random.Generator, count: int) -> Table:
    """Return what persons and automatics may ask for; one in ten asks for nonsense."""
    table = np.zeros((count, len(COMMAND)))
    resting = rng.random((count, 5)) < 0.4
    table[:, COMMAND["road_wheel_rad"]] = rng.uniform(-0.8, 0.8, count)
    for name in ("throttle", "brake", "clutch", "handbrake"):
        table[:, COMMAND[name]] = np.clip(rng.uniform(-0.2, 1.3, count), 0.0, 1.0)
    table[:, :5][resting] = 0.0
    table[:, COMMAND["automatic"]] = rng.integers(0, 2, count)
    table[:, COMMAND["gear"]] = np.where(
        table[:, COMMAND["automatic"]] == 1.0, rng.integers(-1, 2, count), rng.integers(-1, 8, count)
    )
    mad = rng.random(count) < 0.1
    table[mad, rng.integers(0, 7, mad.sum())] = rng.choice(NONSENSE, mad.sum())
    return table


def hit(rng: np.random.Generator, states: Table) -> Table:
    """Return these states after something has changed all their motion at once."""
    most = {"vx_mps": HIT_MPS, "vy_mps": HIT_MPS, "yaw_rate_radps": 6.0}
    most |= {"roll_radps": 3.0, "pitch_radps": 3.0, "heave_mps": 3.0, "roll_rad": 0.3, "pitch_rad": 0.2, "heave_m": 0.2}
    for wheel in WHEELS:
        most |= {f"{wheel}_radps": 200.0, f"{wheel}_lift_m": 0.1, f"{wheel}_lift_mps": 5.0}
    struck = states.copy()
    for name, size in most.items():
        struck[:, AT[name]] = rng.uniform(-size, size, len(states))
    struck[:, AT["engine_radps"]] = rng.uniform(0.0, 690.0, len(states))
    return struck


@contextmanager
def threads_for(cars: int) -> Iterator[None]:
    """Let one thread step few cars: several would wait for each other, busily, for longer than they work."""
    before = numba.get_num_threads()
    numba.set_num_threads(before if cars >= CARS else 1)
    try:
        yield
    finally:
        numba.set_num_threads(before)


def fuzz(steps: int, seed: int, subject: Subject = SUBJECTS["hatchback"]) -> Report:
    """Drive cars for `steps` steps of 1 ms in all, then let them come to rest."""
    with threads_for(subject.cars):
        return _fuzz(steps, seed, subject)


def _fuzz(steps: int, seed: int, subject: Subject) -> Report:
    bounds, cars = subject.bounds, subject.cars
    assert bounds.keys() == AT.keys(), f"every state needs a bound: {bounds.keys() ^ AT.keys()}"
    began_s = process_time()
    rng = np.random.default_rng(seed)
    spread = random.Random(seed)
    fleet = subject.fleet([subject.build(ground=ground(spread)) for _ in range(cars)])
    asked = commands(rng, cars)
    seen = True
    lowest, highest = np.full((2, len(AT)), [[np.inf], [-np.inf]])
    ticks = -(-steps // (cars * SUBSTEPS))
    for _ in range(ticks):
        new = rng.random(cars) < 0.01
        asked[new] = commands(rng, int(new.sum()))
        fleet.command(asked)
        struck = rng.random(cars) < 0.0005
        if struck.any():
            states = fleet.states
            states[struck] = hit(rng, states[struck])
            fleet.restore(states)
        fleet.step(SUBSTEPS)
        states = fleet.states
        seen = seen and bool(np.isfinite(fleet.vehicles).all())
        lowest = np.minimum(lowest, states.min(axis=0))  # a NaN stays one
        highest = np.maximum(highest, states.max(axis=0))
    beyond = [
        f"{name}: {lowest[at]:.6g} to {highest[at]:.6g}, allowed {bounds[name][0]:g} to {bounds[name][1]:g}"
        for name, at in AT.items()
        if not bounds[name][0] <= lowest[at] <= highest[at] <= bounds[name][1]
    ]
    if not seen:
        beyond.append("what others see of the car (VehicleState) is no number somewhere")
    return Report(
        ticks * cars * SUBSTEPS,
        dict(zip(AT, lowest.tolist(), strict=True)),
        dict(zip(AT, highest.tolist(), strict=True)),
        beyond,
        rest(fleet.states, subject),
        process_time() - began_s,
    )


def ground(spread: random.Random) -> Ground:
    """Return any ground: friction, hills, wind, and now and then a patch of another friction."""
    patch = Patch(spread.uniform(-50.0, 0.0), spread.uniform(0.0, 50.0), -5.0, spread.uniform(-2.0, 5.0), 0.3)
    return Ground(
        spread.uniform(0.05, 1.2),
        spread.uniform(-0.3, 0.3),
        spread.uniform(-0.3, 0.3),
        spread.choice([1.0, 0.3]),
        spread.uniform(-20.0, 20.0),
        spread.uniform(-20.0, 20.0),
        spread.choice([(), (patch,)]),
    )


def rest(states: Table, subject: Subject) -> float:
    """Return how fast the fastest car still is when all have braked on level asphalt."""
    fleet = subject.fleet([subject.build()] * len(states))
    fleet.restore(states)
    stop = np.zeros((len(states), len(COMMAND)))
    stop[:, [COMMAND["brake"], COMMAND["clutch"]]] = 1.0
    fleet.command(stop)
    fleet.step(round(REST_S * 1000))
    moving = np.abs(fleet.states[:, [AT["vx_mps"], AT["vy_mps"], AT["yaw_rate_radps"]]]).sum(axis=1)
    return float(moving.max())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=100_000_000)
    parser.add_argument("--car", choices=SUBJECTS, default="hatchback")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(2**32))
    given = parser.parse_args()
    print(f"seed {given.seed}")
    subject = SUBJECTS[given.car]
    found = fuzz(given.steps, given.seed, subject)
    for name in AT:
        low, high = subject.bounds[name]
        print(f"  {name:22} {found.lowest[name]:12.5g} to {found.highest[name]:12.5g}   allowed {low:g} to {high:g}")
    print(f"{found.steps} steps in {found.cpu_s:.0f} s CPU; at rest within {REST_S:g} s to {found.rest_mps:.2g} m/s")
    for line in found.beyond:
        print(f"BEYOND {line}")
    return 1 if found.beyond or not found.rest_mps < REST_MPS else 0


if __name__ == "__main__":
    sys.exit(main())
