"""Plain and compiled: equal bits, on this processor and as for a generic one, and no fused operations."""

import hashlib
import math
import os
import random
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from itertools import chain, repeat
from typing import Any

import numpy as np
import pytest

from simconsole.values.host.jit import _cached, _twin, compiled
from simconsole.values.kernels import Row, put
from simconsole.values.platform import Ground, Platform
from simconsole.values.signals import VehicleCommand
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.car.state import CarState
from tests.bits import difference
from tests.samples import Sample
from tests.vehicle.driving import IDLE, Drive, platform

SEED = 38
FUSED = re.compile(r"\bv?f?n?m(?:add|sub)\d*[sp][sd]\b|\bfmadd\b|\bfmsub\b|\bfmla\b")


@pytest.fixture(scope="module")
def fresh(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The step as `compiled` compiles it, but from the compiler and not from the cache: its assembly can be read."""
    vehicle = platform()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        step = _cached(_twin(vehicle.step), "fresh")
        next(rows(vehicle, step, commands(SEED, 1), 1))  # compiles it
    return step


def commands(seed: int, ticks: int, bad: bool = False) -> Iterator[VehicleCommand]:
    """Yield what a restless person, an automatic and nobody would do, each held for a while."""
    rng = random.Random(seed)
    left = 0
    command = IDLE
    for _ in range(ticks):
        if left == 0:
            left = rng.randrange(5, 300)
            automatic = rng.choice([0.0, 1.0])
            command = IDLE._replace(
                road_wheel_rad=rng.choice([0.0, rng.uniform(-0.7, 0.7)]),
                throttle=rng.choice([0.0, rng.random(), 1.0]),
                brake=rng.choice([0.0, 0.0, rng.random(), 1.0]),
                clutch=rng.choice([0.0, rng.random(), 1.0]),
                handbrake=rng.choice([0.0, 0.0, 0.0, 1.0]),
                gear=rng.choice([-1.0, 0.0, 1.0]) if automatic else float(rng.randrange(-1, 8)),
                automatic=automatic,
            )
            if bad and rng.random() < 0.3:
                field = rng.choice(["road_wheel_rad", "throttle", "brake", "clutch", "handbrake", "gear"])
                command = command._replace(**{field: rng.choice([math.nan, math.inf, -math.inf, 1e300, -5.0])})
        left -= 1
        yield command


def stall() -> Iterator[VehicleCommand]:
    """Yield first gear with the brake pressed, and then the clutch let go of: at rest, the engine stalls."""
    braked = IDLE._replace(brake=1.0, gear=1.0)
    return chain(repeat(braked._replace(clutch=1.0), 250), repeat(braked, 250))


def rows(
    vehicle: Platform, step: Callable[..., None], given: Iterator[VehicleCommand], substeps: int, speed_mps: float = 0.0
) -> Iterator[Row]:
    """Drive from a rolling start and yield every row."""
    wheel = speed_mps / 0.306
    start = CarState(*vehicle.initial_state)._replace(
        vx_mps=speed_mps, fl_radps=wheel, fr_radps=wheel, rl_radps=wheel, rr_radps=wheel
    )
    previous: Row = np.zeros(PLATFORM_AT + len(start))
    put(previous, PLATFORM_AT, start)
    for command in given:
        row = np.zeros_like(previous)
        put(row, LAYOUT.command.start, command)
        step(previous, row, vehicle.parameters, vehicle.ground, substeps)
        yield row
        previous = row


def test_plain_and_compiled_are_equal_to_the_last_bit(fresh: Any, sample: Sample) -> None:
    ticks = sample.of(2_000, 12_500)
    vehicle = platform(ground=Ground(0.9, 0.04, -0.02))
    met = dict.fromkeys(("still", "reverse", "stalled", "automatic", "fast", "sliding"), 0)
    for seed, speed in enumerate((0.0, 35.0, -8.0, 0.0), SEED):
        print(f"seed {seed}")
        given = [*(stall() if seed == SEED else ()), *commands(seed, ticks)]
        pairs = zip(
            rows(vehicle, vehicle.step, iter(given), 2, speed),  # four drives, of two steps a tick
            rows(vehicle, fresh, iter(given), 2, speed),
            strict=True,
        )
        for tick, (slow, fast) in enumerate(pairs):
            assert not difference(slow, fast), tick
            state = CarState(*slow[PLATFORM_AT:].tolist())
            met["still"] += abs(state.vx_mps) < 1e-3
            met["reverse"] += state.vx_mps < -1.0
            met["stalled"] += state.engine_running == 0.0
            met["automatic"] += state.lever_adopted == 0.0
            met["fast"] += state.vx_mps > 20.0
            met["sliding"] += abs(state.vy_mps) > 2.0
    print(met)
    assert min(met.values()) > 50, f"the drives have not met everything: {met}"


def test_no_fused_operation_is_in_the_compiled_step(fresh: Any) -> None:
    (assembly,) = fresh.inspect_asm().values()
    assert re.search(r"mulsd|\bfmul\b", assembly), "this is the assembly of arithmetic"
    assert not FUSED.findall(assembly)
    assert FUSED.search("vfmadd213sd %xmm1, %xmm2, %xmm3")


def fingerprint() -> str:
    """Return the hash of a short compiled drive; also what the child process prints."""
    vehicle = platform(ground=Ground(0.9, 0.06, -0.02))
    digest = hashlib.blake2b(digest_size=8)
    for row in rows(vehicle, compiled(vehicle.step), commands(SEED, 2000), 4):
        digest.update(row.tobytes())
    return digest.hexdigest()


def test_a_generic_processor_gives_the_same_bits() -> None:
    code = (
        "import importlib.util, sys; spec = importlib.util.spec_from_file_location('vehicle', sys.argv[1] + "
        "'/driving.py', submodule_search_locations=[sys.argv[1]]); package = importlib.util.module_from_spec(spec); "
        "sys.modules['vehicle'] = package; spec.loader.exec_module(package); "
        "from vehicle.test_car_twin import fingerprint; print(fingerprint())"
    )
    folder = os.path.dirname(__file__)  # noqa: PTH120  # handed to a child as text
    environment = {**os.environ, "NUMBA_CPU_NAME": "generic", "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "-c", code, folder], capture_output=True, text=True, check=True, env=environment
    )
    assert done.stdout.strip() == fingerprint()


def test_after_anything_it_comes_to_rest() -> None:
    vehicle = platform(ground=Ground(0.8, 0.05, 0.05))
    drive = Drive(vehicle)
    for command in commands(SEED + 1, 5000):
        drive.tick(command)
    drive.hold(40.0, brake=1.0, clutch=1.0)
    seen = drive.hold(10.0, brake=1.0, clutch=1.0)
    assert abs(seen.vx_mps) + abs(seen.vy_mps) + abs(seen.yaw_rate_radps) < 1e-9


def test_tick_rate_does_not_change_the_physics() -> None:
    """Four ticks of 1 ms, or one of 4 ms: the same car to the last bit while the command holds."""
    vehicle = platform(ground=Ground(0.9, 0.03, 0.01))
    coarse = list(rows(vehicle, compiled(vehicle.step), commands(SEED, 1500), 4))
    repeated = (command for command in commands(SEED, 1500) for _ in range(4))
    fine = list(rows(vehicle, compiled(vehicle.step), repeated, 1))
    for row, same in zip(coarse, fine[3::4], strict=True):
        assert not difference(row[LAYOUT.vehicle.start :], same[LAYOUT.vehicle.start :])
