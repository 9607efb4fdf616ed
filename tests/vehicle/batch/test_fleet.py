"""A fleet: each vehicle bit for bit as alone, in any number, with any command, on any number of threads."""

import os
import random
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from simconsole.values.host.jit import compiled
from simconsole.values.kernels import put
from simconsole.values.platform import Ground, Platform, Pose
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.batch.fleet import Fleet
from tests.bits import difference
from tests.samples import Sample
from tests.vehicle.driving import LEVEL, platform
from tests.vehicle.fuzzing import ground
from tests.vehicle.test_car_twin import commands

TICKS = 400


def mixed(
    count: int, rng: random.Random, names: tuple[str, ...] = ("hatchback", "commonroad_bmw320i")
) -> list[Platform]:
    """Return vehicles that differ in profile, place and ground."""
    return [
        platform(rng.choice(names), ground(rng), Pose(rng.uniform(-9.0, 9.0), 0.0, rng.uniform(-3.0, 3.0)))
        for _ in range(count)
    ]


def shaken(state: tuple[float, ...], rng: random.Random) -> list[float]:
    """Return a state in which everything moves."""
    return [value + rng.choice([0.0, rng.gauss(0.0, 0.02), rng.gauss(0.0, 10.0)]) for value in state]


def differing(vehicles: list[Platform], seed: int, substeps: int = 3) -> list[tuple[int, int]]:
    """Drive a fleet and every vehicle alone; return (tick, vehicle) wherever a bit differs."""
    rng = random.Random(seed)
    fleet = Fleet(vehicles)
    states = [shaken(vehicle.initial_state, rng) for vehicle in vehicles]
    fleet.restore(states)
    rows = np.zeros((len(vehicles), PLATFORM_AT + len(states[0])))
    for row, state in zip(rows, states, strict=True):
        put(row, PLATFORM_AT, state)
    step = compiled(vehicles[0].step)
    found = []
    given = zip(*(commands(seed + index, TICKS, bad=True) for index in range(len(vehicles))), strict=True)
    for tick, asked in enumerate(given):
        fleet.command(asked)
        fleet.step(substeps)
        vehicles_now, states_now = fleet.vehicles, fleet.states
        for index, (vehicle, command) in enumerate(zip(vehicles, asked, strict=True)):
            previous = rows[index].copy()
            put(rows[index], LAYOUT.command.start, command)
            step(previous, rows[index], vehicle.parameters, vehicle.ground, substeps)
            alone = rows[index]
            seen = alone[LAYOUT.vehicle.slice].tobytes() == vehicles_now[index].tobytes()
            if not seen or alone[PLATFORM_AT:].tobytes() != states_now[index].tobytes():
                found.append((tick, index))
    moving = np.abs(fleet.states - states).max(axis=1)
    assert np.isfinite(fleet.states).all()
    assert (moving > 0.1).all(), "nothing was driven"
    return found


@pytest.mark.parametrize("count", [1, 8, 21])
def test_every_car_of_a_fleet_is_the_car_alone_to_the_last_bit(count: int, sample: Sample) -> None:
    for seed in range(sample.seed, sample.seed + sample.of(1, 10)):
        assert differing(mixed(count, random.Random(seed)), seed) == []


def test_cars_that_share_their_parameters_are_the_car_alone_too(sample: Sample) -> None:
    assert differing([platform(ground=Ground(0.8, 0.05, -0.03))] * 11, sample.seed) == []


def test_another_platform_needs_nothing_of_its_own() -> None:
    assert differing([platform("ball", pose=Pose(float(index), 2.0, 0.5)) for index in range(11)], 5) == []


def test_a_fleet_can_be_put_back_to_try_again() -> None:
    fleet = Fleet([platform()] * 9)
    before = fleet.states
    command = np.zeros((9, LAYOUT.command.width))
    command[:, 1], command[:, 5], command[:, 6] = np.linspace(0.0, 1.0, 9), 1.0, 1.0
    fleet.command(command)
    fleet.step(1500)
    after = fleet.states
    assert (np.diff(after[2:, 3]) >= 0.0).all(), "more throttle, more speed"
    fleet.restore(before)
    fleet.step(1500)
    assert not difference(after, fleet.states)


def test_what_is_no_fleet_is_refused() -> None:
    with pytest.raises(ValueError, match="all of one kind"):
        Fleet([platform(), platform("ball")])
    with pytest.raises(ValueError, match="at least one"):
        Fleet([])
    with pytest.raises(ValueError, match=rf"shape \(3,\), must be \(2, {LAYOUT.command.width}\)"):
        Fleet([platform(ground=LEVEL)] * 2).command(np.zeros(3))


def test_compiled_fleet_is_found_by_another_process(tmp_path: Path) -> None:
    """The second process loads what the first compiled, and steps to the same bits, on one thread as on two."""
    code = (
        "from tests.vehicle.driving import platform\n"
        "from simconsole.vehicle.batch.fleet import Fleet\n"
        "fleet = Fleet([platform('ball')] * 5)\n"
        "fleet.step(3)\n"
        "print(fleet.states.tobytes().hex(), sum(fleet._step.stats.cache_hits.values()))\n"
    )
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path), "PYTHONPATH": os.pathsep.join(sys.path)}
    seen = []
    for threads in ("2", "1"):
        environment["NUMBA_NUM_THREADS"] = threads
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
        seen.append(done.stdout.split())
    (first, compiled_here), (second, found) = seen
    assert (compiled_here, found) == ("0", "1")
    assert first == second
