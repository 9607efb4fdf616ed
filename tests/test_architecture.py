"""The house rules: who may import whom, and what every source file must look like."""

import ast
import itertools
import os
import re
import shutil
import statistics
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple, get_type_hints

import pytest

from simconsole import signals

ROOT = Path(__file__).resolve().parents[1]
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
LAYERS, FORBIDDEN, INDEPENDENT = CONTRACTS
FLOORS = [re.findall(r"[\w.]+", layer) for layer in LAYERS["layers"]]
FIRST_PURE_FLOOR = next(index for index, floor in enumerate(FLOORS) if "simconsole.pipeline" in floor)
HEAVY = ["pygame", "rerun", "numba", "matplotlib"]
LINUX_ONLY = {"evdev", "fcntl", "grp", "posix", "pty", "pwd", "resource", "syslog", "termios", "tty", "udev", "pyudev"}

UNITS = ("_rad", "_radps", "_m", "_mps", "_mps2", "_nm", "_ticks")
UNITLESS = {
    # pedals, authority and other shares 0..1; raw axes -1..1
    *("throttle", "brake", "clutch", "handbrake", "remote_lateral", "remote_longitudinal", "shared_trade"),
    "remote_guidance",
    *("person_throttle", "person_brake", "remote_throttle", "remote_brake"),
    *("ros_throttle", "ros_brake", "ecu_throttle", "ecu_brake"),
    *("wheel_axis", "throttle_axis", "brake_axis", "clutch_axis", "handbrake_axis", "hat_x", "hat_y"),
    # counts, flags and masks
    *("sequence", "refused", "refused_seen", "sequence_seen", "invalid_run", "automatic", "engine_running"),
    *("wheel_buttons", "shifter_buttons", "pressed", "edges", "events", "faults", "gate_active", "throttle_override"),
    *("wheel_motor", "ramp", "clipped", "enabled", "hands_on", "live", "ecu_events", "fresh", "invalid", "lever_fault"),
    "implausible",
    *("anti_lock_off", "traction_off", "stability_off", "gear_fault"),
    *("turn_indicators", "hazard_lights", "stalk", "hazard_switch"),
    # members of an enumeration
    *("kind", "mode", "reason", "refusal", "notice", "gear", "direction", "takeover_stage", "commander", "state"),
    *("restarted", "stop_steered"),
    *("wheel_validity", "throttle_validity", "brake_validity", "clutch_validity", "shifter_validity"),
    "handbrake_validity",
}  # fmt: skip


def module_name(path: Path, root: Path = ROOT) -> str:
    return ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__")


def modules() -> dict[str, Path]:
    return {module_name(path): path for path in sorted((ROOT / "simconsole").rglob("*.py"))}


def owners(module: str, listed: list[str]) -> list[str]:
    return [entry for entry in listed if module == entry or module.startswith(f"{entry}.")]


def python_files() -> list[Path]:
    folders = ("simconsole", "tests", "benchmarks", "examples", "scripts")
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]


def top_level_imports(tree: ast.AST) -> Iterator[str]:
    """Names of the modules that importing this file imports."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            continue
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            continue
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module or ""
        else:
            yield from top_level_imports(node)


def test_every_module_stands_on_one_floor() -> None:
    listed = list(itertools.chain(*FLOORS))
    split_rooms = {entry.rpartition(".")[0] for entry in listed}
    homeless = [name for name in modules() if not owners(name, listed) and name not in split_rooms]
    assert homeless == [], "add them to the layers contract in pyproject.toml"
    twice = [name for name in modules() if len(owners(name, listed)) > 1]
    assert twice == []


def test_package_with_modules_on_several_floors_imports_nothing_itself() -> None:
    split_rooms = {entry.rpartition(".")[0] for entry in itertools.chain(*FLOORS)}
    for room in split_rooms:
        tree = ast.parse((ROOT / Path(*room.split(".")) / "__init__.py").read_text())
        assert list(top_level_imports(tree)) == [], room


def test_pure_floors_are_the_ones_that_the_forbidden_contract_covers() -> None:
    pure = set(itertools.chain(*FLOORS[FIRST_PURE_FLOOR:]))
    assert pure == set(FORBIDDEN["source_modules"])


class House(NamedTuple):
    """A copy of the package in which violations can be planted."""

    root: Path

    def plant(self, module: str, line: str) -> None:
        path = self.root / Path(*module.split("."))
        path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
        path.write_text(f"{path.read_text()}\n{line}\n")

    def lint(self) -> tuple[int, str]:
        command = [str(Path(sys.executable).parent / "lint-imports"), "--no-logo", "--no-cache"]
        done = subprocess.run(command, cwd=self.root, capture_output=True, text=True, check=False)
        return done.returncode, " ".join((done.stdout + done.stderr).split())


@pytest.fixture
def house(tmp_path: Path) -> House:
    shutil.copytree(ROOT / "simconsole", tmp_path / "simconsole", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    return House(tmp_path)


def some_module(entry: str) -> str:
    """A module that is not a package, in this entry of a contract."""
    return next(name for name, path in modules().items() if owners(name, [entry]) and path.name != "__init__.py")


def test_contracts_hold_in_this_tree(house: House) -> None:
    code, output = house.lint()
    assert code == 0, output
    assert "3 kept, 0 broken" in output


def test_planted_upward_imports_are_found(house: House) -> None:
    """One import from each floor to the one above, all at once: each is named."""
    steps = []
    for above, below in itertools.pairwise(FLOORS):
        upper = some_module(next(entry for entry in above if entry != "simconsole.__main__"))
        lower = some_module(below[0])
        house.plant(lower, f"import {upper}")
        steps.append((lower, upper))
    code, output = house.lint()
    assert code == 1
    assert "Downwards only BROKEN" in output
    for lower, upper in steps:
        assert f"{lower} -> {upper}" in output


def test_planted_forbidden_imports_are_found(house: House) -> None:
    """Each forbidden module, in a core of its own where there are enough, hidden in a function: each is named."""
    cores = [some_module(entry) for entry in FORBIDDEN["source_modules"] if entry.count(".") > 1]
    planted = list(zip(itertools.cycle(cores), FORBIDDEN["forbidden_modules"]))  # one side is endless
    for core, forbidden in planted:
        house.plant(core, f"def planted() -> None:\n    import {forbidden}\n")
    code, output = house.lint()
    assert code == 1
    assert f"{FORBIDDEN['name']} BROKEN" in output
    for core, forbidden in planted:
        assert f"{core} -> {forbidden}" in output


def test_planted_imports_between_outside_rooms_are_found(house: House) -> None:
    rooms = INDEPENDENT["modules"]
    assert rooms == [f"simconsole.{room}" for room in ("devices", "bridge", "canbus", "hud", "scene")]
    for importer, imported in itertools.permutations(rooms, 2):
        house.plant(importer, f"import {imported}")
    code, output = house.lint()
    assert code == 1
    assert f"{INDEPENDENT['name']} BROKEN" in output
    for importer, imported in itertools.permutations(rooms, 2):
        assert f"{importer} is not allowed to import {imported}" in output


def loaded_by(code: str, *, forbid: list[str]) -> set[str]:
    """Which of `forbid` a fresh interpreter has loaded after `code`."""
    script = f"import sys\n{code}\nprint('LOADED', *sys.modules.keys() & set({forbid}))"
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return set(done.stdout.partition("LOADED")[2].split())


@pytest.mark.parametrize("words", [["--help"], ["drive", "--help"], ["doctor", "--help"]])
def test_help_loads_no_heavy_library(words: list[str]) -> None:
    code = (
        f"import contextlib\nfrom simconsole.cli import main\nwith contextlib.suppress(SystemExit):\n    main({words})"
    )
    assert loaded_by(code, forbid=[*HEAVY, "numpy", "websockets", "asyncio"]) == set()


def test_help_is_there_and_its_time_is_printed(record_property: Callable[[str, object], None]) -> None:
    times_s = []
    for _ in range(5):
        began_s = time.perf_counter()
        done = subprocess.run([sys.executable, "-m", "simconsole", "--help"], cwd=ROOT, capture_output=True, text=True)
        times_s.append(time.perf_counter() - began_s)
        assert done.returncode == 0
        assert "demo" in done.stdout
    record_property("simconsole --help, median of 5", f"{statistics.median(times_s):.2f} s (aim 0.3 s)")


def test_importing_every_core_loads_no_heavy_library() -> None:
    pure = list(itertools.chain(*FLOORS[FIRST_PURE_FLOOR:]))
    code = "\n".join(f"import {name}" for name in modules() if owners(name, pure))
    assert loaded_by(code, forbid=[*HEAVY, "websockets", "asyncio"]) == set()


def test_importing_every_shell_loads_no_heavy_library() -> None:
    """Shells load what they need when they are opened, so that a machine without it can run the rest."""
    code = "\n".join(f"import {name}" for name in modules() if name != "simconsole.__main__")
    assert loaded_by(code, forbid=[*HEAVY]) == set()


def test_nothing_linux_only_is_imported_at_module_level() -> None:
    found = {
        (module_name(path), name)
        for path in modules().values()
        for name in top_level_imports(ast.parse(path.read_text()))
        if name.partition(".")[0] in LINUX_ONLY
    }
    assert found == set()


def test_finder_of_module_level_imports_looks_into_blocks_but_not_into_functions() -> None:
    source = (
        "try:\n    import fcntl\nexcept ImportError:\n    pass\ndef f():\n    import pwd\nclass C:\n    import tty\n"
    )
    assert list(top_level_imports(ast.parse(source))) == ["fcntl", "tty"]


def signal_fields() -> list[tuple[str, str]]:
    classes: list[Any] = [
        value for value in vars(signals).values() if isinstance(value, type) and hasattr(value, "_fields")
    ]
    return [(record.__name__, field) for record in classes for field in record._fields]


@pytest.mark.parametrize(("record", "field"), signal_fields())
def test_every_number_of_a_tick_says_its_unit(record: str, field: str) -> None:
    assert field.endswith(UNITS) or field in UNITLESS
    assert get_type_hints(getattr(signals, record))[field] is float


def test_list_of_unitless_numbers_holds_nothing_superfluous() -> None:
    assert {field for _, field in signal_fields()} >= UNITLESS


@pytest.mark.parametrize("path", python_files(), ids=lambda path: str(path.relative_to(ROOT)))
def test_file_is_short_enough_to_read(path: Path) -> None:
    assert len(path.read_text().splitlines()) <= 400


@pytest.mark.parametrize("path", modules().values(), ids=modules().keys())
def test_module_says_what_it_is(path: Path) -> None:
    assert (ast.get_docstring(ast.parse(path.read_text())) or "").strip()
