"""The twin: what it compiles, what its cache depends on, what it refuses."""

import dis
import gc
import math
import os
import pickle
import subprocess
import sys
import types
from collections.abc import Callable
from enum import IntEnum, IntFlag
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from numba.core.codegen import CPUCodeLibrary

from simconsole.values.host import jit
from simconsole.values.host.jit import compiled, digest, global_names, plain
from simconsole.values.kernels import Row, holding, kernel, stage
from simconsole.values.layout import Part, read
from tests.paths import ROOT

SCALE = 2.0
TABLE = (1.0, 2.0, 4.0)


class Triple(NamedTuple):
    a: float
    b: float
    c: float


class Level(IntEnum):
    LOW = 1
    HIGH = 2


class Bits(IntFlag):
    FIRST = 1
    SECOND = 2


TRIPLE = Part(Triple, 1)


@kernel
def scaled(value: float) -> float:
    return SCALE * value


@kernel
def summed(row: Row, factor: float) -> float:
    values = read(row, TRIPLE)
    return scaled(values.a) + values.b * TABLE[1] + values.c * factor


@kernel
def classified(level: float, bits: int) -> float:
    """Use members of an enumeration as numbers: compare, return and mask them."""
    if level in (Level.LOW, 7.0) and bits & Bits.SECOND:
        return Level.HIGH
    return 0.5


def make_curve(slope: Callable[[float], float], steepness: float) -> Callable[[float], float]:
    """Return a kernel that encloses another one and a number."""

    @kernel
    def curve(value: float) -> float:
        return slope(value) * steepness

    return curve


@kernel
def applied(function: Callable[[float], float], value: float) -> float:
    return function(value) + 1.0


def make_both(first: Callable[[float], float], second: Callable[[float], float]) -> Callable[[float], float]:
    """Return a kernel that hands what it encloses to another kernel."""

    @kernel
    def both(value: float) -> float:
        return applied(first, value) * applied(second, value)

    return both


class Point(NamedTuple):
    x: float
    y: float


class Placed(NamedTuple):
    place: Point
    size: float


@kernel
def reach(placed: Placed) -> float:
    return placed.place.x + placed.size


@stage
def halved(value: float) -> float:
    return 0.5 * scaled(value)


@kernel
def quartered(value: float) -> float:
    return halved(value) + halved(-0.5 * value)


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    for cached in (jit.digest, jit._entry, jit._inner, jit._prune):
        cached.cache_clear()
    return tmp_path / "simconsole" / "numba"


def altered(function: types.FunctionType, **replaced: object) -> types.FunctionType:
    """Return the same function among other globals, as if its sources had been edited."""
    copy = types.FunctionType(function.__code__, {**function.__globals__, **replaced}, function.__name__)
    copy.__qualname__ = function.__qualname__
    copy.__module__ = function.__module__
    copy.__annotations__ = function.__annotations__
    return kernel(copy)


def test_twin_gives_what_the_plain_function_gives() -> None:
    row = np.array([0.5, 1.5, 2.5, 3.5, 4.5])
    assert plain(summed) is summed
    for factor in (0.0, 1.0, -2.5):
        assert compiled(summed)(row, factor) == summed(row, factor)


def test_compiled_code_is_cached_for_the_entry_only(own_cache: Path) -> None:
    compiled(summed)(np.ones(4), 0.0)
    assert [folder.name for folder in own_cache.iterdir()] == [digest(summed)]
    assert list((own_cache / digest(summed)).rglob("*.nbc"))


def test_a_stage_is_compiled_once_for_all_that_call_it(own_cache: Path) -> None:
    assert compiled(quartered)(8.0) == quartered(8.0) == 4.0
    assert {folder.name for folder in own_cache.iterdir()} == {digest(quartered), digest(halved)}
    twin = compiled(halved)
    assert twin(8.0) == 8.0
    assert sum(twin.stats.cache_misses.values()) == 1  # type: ignore[attr-defined]  # compiled with its caller
    assert isinstance(halved, types.FunctionType)
    inlined = altered(halved)
    kernel(inlined)
    assert digest(inlined) != digest(halved)


def test_compiled_code_is_found_from_another_place(tmp_path: Path) -> None:
    compiled(summed)(np.ones(4), 0.0)
    assert isinstance(summed, types.FunctionType)
    moved = altered(summed)
    moved.__code__ = summed.__code__.replace(co_filename=str(tmp_path / "moved.py"), co_firstlineno=99)
    twin = compiled(moved)
    assert twin(np.ones(4), 0.0) == summed(np.ones(4), 0.0)
    assert sum(twin.stats.cache_hits.values()) == 1  # type: ignore[attr-defined]  # it is a dispatcher of numba


def test_digest_follows_callees_and_constants() -> None:
    assert isinstance(scaled, types.FunctionType)
    assert isinstance(summed, types.FunctionType)
    other_scaled = altered(scaled, SCALE=3.0)
    before = digest(summed)
    assert digest(altered(summed, SCALE=3.0)) == before, "a constant it does not use"
    assert digest(altered(summed, scaled=other_scaled)) != before, "a constant of a kernel that it calls"
    assert digest(altered(summed, TABLE=(1.0, 2.5, 4.0))) != before
    assert digest(altered(summed, TRIPLE=Part(Triple, 2))) != before


def test_digest_follows_records_that_a_kernel_is_only_given() -> None:
    """Machine code holds the places of their fields, and its index their names."""
    assert isinstance(reach, types.FunctionType)
    before = digest(reach)
    assert digest(altered(reach)) == before

    class Swapped(NamedTuple):
        y: float
        x: float

    class Edited(NamedTuple):
        place: Swapped
        size: float

    class Renamed(NamedTuple):
        place: Point
        size: float

    Swapped.__qualname__, Edited.__qualname__ = Point.__qualname__, Placed.__qualname__
    for record in (Edited, Renamed):
        edited = altered(reach)
        edited.__annotations__ = {**reach.__annotations__, "placed": record}
        assert digest(edited) != before


@pytest.mark.parametrize("modules", [vars(jit), vars(types), vars(dis)], ids=["jit", "types", "dis"])
def test_globals_are_those_that_python_itself_tells(modules: dict[str, Any]) -> None:
    for function in (value for value in modules.values() if isinstance(value, types.FunctionType)):
        told = [step.argval for step in dis.get_instructions(function) if step.opname == "LOAD_GLOBAL"]
        assert list(global_names(function.__code__)) == told


def test_globals_beyond_the_256th_name_are_told() -> None:
    names = [f"name_{number}" for number in range(70_000)]
    assert list(global_names(compile(f"lambda: ({', '.join(names)})", "", "eval").co_consts[0])) == names


def test_digest_is_the_same_in_another_process() -> None:
    code = "from simconsole.values.host.jit import digest; "
    code += "from simconsole.values.trigonometry import sin; print(digest(sin))"
    from simconsole.values.trigonometry import sin

    environment = {**os.environ, "PYTHONHASHSEED": "7", "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    assert done.stdout.strip() == digest(sin)


def test_members_of_enumerations_are_their_numbers() -> None:
    for level, bits in ((1.0, 2), (1.0, 1), (2.0, 2), (7.0, 3)):
        assert compiled(classified)(level, bits) == classified(level, bits)
    assert classified(1.0, 2) == 2.0


def test_digest_follows_the_values_of_an_enumeration() -> None:
    assert isinstance(classified, types.FunctionType)
    assert digest(altered(classified, Level=IntEnum("Level", {"LOW": 1, "HIGH": 3}))) != digest(classified)
    assert digest(altered(classified, Level=IntEnum("Level", {"LOW": 1, "HIGH": 2}))) == digest(classified)


def test_kernel_sees_what_its_factory_was_given() -> None:
    gentle, steep = make_curve(scaled, 3.0), make_curve(make_curve(scaled, 0.5), 4.0)
    for curve, expected in ((gentle, 6.0), (steep, 4.0), (make_both(gentle, steep), 35.0)):
        assert curve(1.0) == expected
        assert compiled(curve)(1.0) == expected


def test_digest_follows_what_a_kernel_encloses() -> None:
    assert isinstance(scaled, types.FunctionType)
    gentle = digest(make_curve(scaled, 3.0))
    assert digest(make_curve(scaled, 3.0)) == gentle
    assert digest(make_curve(scaled, 4.0)) != gentle
    assert digest(make_curve(altered(scaled, SCALE=3.0), 3.0)) != gentle
    with pytest.raises(TypeError, match="neither a kernel nor a constant"):
        digest(make_curve(lambda value: value, 3.0))


CALLS_A_CLOSURE = """
from simconsole.values.host.jit import compiled
from tests.values.host.test_jit import make_both, make_curve, scaled
twin = compiled(make_both(make_curve(scaled, 3.0), scaled))
print(twin(1.0), sum(twin.stats.cache_hits.values()))
"""


def test_compiled_closure_is_found_by_another_process() -> None:
    assert compiled(make_both(make_curve(scaled, 3.0), scaled))(1.0) == 21.0
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", CALLS_A_CLOSURE]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    assert done.stdout.split() == ["21.0", "1"]


def test_what_is_inlined_is_optimised_in_its_caller_only(monkeypatch: pytest.MonkeyPatch) -> None:
    optimise: Any = CPUCodeLibrary._optimize_final_module
    optimised: list[str] = []

    def counted(library: Any) -> None:
        optimised.append(library.name)
        optimise(library)

    monkeypatch.setattr(CPUCodeLibrary, "_optimize_final_module", counted)
    both = make_both(scaled, make_curve(scaled, 3.0))
    assert compiled(both)(1.0) == both(1.0) == 21.0
    assert len(optimised) == 1


def test_of_processes_that_start_together_one_compiles() -> None:
    code = """
from tests.values.host.test_jit import compiled, halved, quartered
assert compiled(quartered)(8.0) == 4.0
print(*(sum(compiled(each).stats.cache_misses.values()) for each in (quartered, halved)))
"""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
    running = [
        subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, env=environment) for _ in range(2)
    ]
    said = [process.communicate()[0].split() for process in running]
    assert [process.returncode for process in running] == [0, 0]
    assert sorted(misses for misses, _ in said) == [b"0", b"1"]


def test_only_kernels_and_constants_are_accepted() -> None:
    assert isinstance(summed, types.FunctionType)
    with pytest.raises(TypeError, match="is not a kernel"):
        compiled(plain)
    with pytest.raises(TypeError, match="neither a kernel nor a constant"):
        digest(altered(summed, TABLE=[1.0, 2.0]))


def test_unused_folders_are_removed_after_a_month(own_cache: Path) -> None:
    old, recent = own_cache / "old", own_cache / "recent"
    old.mkdir(parents=True)
    recent.mkdir()
    os.utime(old, (0.0, 0.0))
    compiled(scaled)
    assert not old.exists()
    assert recent.exists()


def test_importing_loads_no_numba() -> None:
    code = "import sys, simconsole.values.host.jit, simconsole.vehicle.car.car_step; sys.exit('numba' in sys.modules)"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    assert subprocess.run([sys.executable, "-c", code], check=False, env=environment).returncode == 0


class Grid(NamedTuple):
    rows: Row
    numbers: Row


class World(NamedTuple):
    grid: Grid
    share: float


@kernel
def summed_over(world: World, row: int, factor: float) -> float:
    """Sum a row of the grid, and count the call in its first number."""
    world.grid.numbers[0] += 1
    found = 0.0
    for value in world.grid.rows[row]:
        found += value
    return found * factor * world.share


def a_world(share: float = 0.5) -> World:
    return World(Grid(np.arange(6.0).reshape(2, 3), np.zeros(4, np.int64)), share)


@pytest.mark.parametrize("execution", [plain, compiled])
def test_arrays_that_are_held_are_seen_as_they_are_now(execution: Callable[..., Any]) -> None:
    one, other = a_world(), a_world(0.25)
    first, second = holding(execution(summed_over), one), holding(execution(summed_over), other)
    assert (first(1, 2.0), second(1, 2.0), first(0, 1.0)) == (12.0, 6.0, 1.5)
    one.grid.rows[1] = 8.0
    assert first(1, 2.0) == 24.0
    assert (one.grid.numbers[0], other.grid.numbers[0]) == (3, 1)


def test_held_arrays_live_as_long_as_the_call() -> None:
    call = holding(compiled(summed_over), a_world())
    gc.collect()
    waste = [np.full((2, 3), math.nan) for _ in range(100)]
    assert call(1, 2.0) == 12.0
    assert len(waste) == 100


def test_a_call_that_holds_arrays_stays_in_its_process() -> None:
    with pytest.raises(TypeError, match="another process"):
        pickle.dumps(holding(compiled(summed_over), a_world()))
