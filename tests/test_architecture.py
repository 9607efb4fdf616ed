"""The rooms: who may import whom, what may touch the machine, and what loads when."""

import ast
import graphlib
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.paths import ROOT
from tests.patience import Stopwatch
from tests.sources import facts, modules, trees

CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
LAYERS, FORBIDDEN, INDEPENDENT = CONTRACTS
ROOMS = [re.findall(r"\w+", layer) for layer in LAYERS["layers"]]
"""The rooms from top to bottom, those side by side together."""
MODULES_OF_A_PACKAGE = 20
HEAVY = ["pygame", "rerun", "numba", "matplotlib"]
LINUX_ONLY = {"evdev", "fcntl", "grp", "posix", "pty", "pwd", "resource", "syslog", "termios", "tty", "udev", "pyudev"}


def matches(module: str, pattern: str) -> bool:
    """Whether a module is meant by a pattern of a contract: `*` is one name, `**` any number of them."""
    regex = re.escape(pattern).replace(r"\.\*\*", r"(\.\w+)*").replace(r"\*", r"\w+")
    return re.fullmatch(regex, module) is not None


@cache
def pure() -> list[str]:
    """The modules that may not touch the machine. Not to be changed."""
    return [name for name in modules() if any(matches(name, pattern) for pattern in FORBIDDEN["source_modules"])]


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


def test_the_root_holds_rooms_only() -> None:
    entries = {path.name for path in (ROOT / "simconsole").iterdir()} - {"__pycache__", "py.typed"}
    assert {name for name in entries if name.endswith(".py")} == {"__init__.py", "__main__.py"}
    assert len(entries) <= 20


def packages() -> list[Path]:
    return [path.parent for path in sorted((ROOT / "simconsole").rglob("__init__.py"))]


@pytest.mark.parametrize("package", packages(), ids=lambda path: str(path.relative_to(ROOT)))
def test_package_is_small_enough_to_overlook(package: Path) -> None:
    held = [path for path in package.glob("*.py") if path.name != "__init__.py"]
    assert len(held) <= MODULES_OF_A_PACKAGE


def test_packages_do_not_import_each_other_in_circles() -> None:
    """Folders as they lie: a room's own modules and each of its sub-packages are one node each."""
    known = modules()

    def package(module: str) -> str:
        return module if known[module].name == "__init__.py" else module.rpartition(".")[0]

    graph: dict[str, set[str]] = {package(name): set() for name in known}
    for name, targets in imports().items():
        graph[package(name)] |= {package(target) for target in targets} - {package(name)}
    order = graphlib.TopologicalSorter(graph).static_order()  # it raises where there is a circle, and names it
    assert set(order) == set(graph)


@cache
def imports() -> dict[str, set[str]]:
    """The modules of ours that each module imports, anywhere in its text. Not to be changed."""
    known = modules()
    found: dict[str, set[str]] = {name: set() for name in known}
    for name, module in facts().items():
        for source, names in module.imports:
            if f"{source}.".startswith("simconsole."):
                targets = [f"{source}.{imported}" for imported in names]
                found[name] |= {to if to in known else source for to in targets}
    return found


def test_modules_do_not_import_each_other_in_circles() -> None:
    graph = imports()
    assert set(graphlib.TopologicalSorter(graph).static_order()) == set(graph)


def test_contracts_are_short_and_name_folders() -> None:
    text = (ROOT / "pyproject.toml").read_text()
    contracts = text[text.index("[[tool.importlinter.contracts]]") :]
    assert len([line for line in contracts.splitlines() if line and not line.startswith("#")]) <= 40
    assert not set(FORBIDDEN["source_modules"]) & modules().keys()


def test_folders_with_pure_modules_hold_nothing_else() -> None:
    """A reader sees from the path whether a module may touch the machine."""
    clean = set(pure())
    folders = {modules()[name].parent for name in clean if modules()[name].name != "__init__.py"}
    mixed = [name for name, path in modules().items() if path.parent in folders and name not in clean]
    assert [name for name in mixed if modules()[name].name != "__init__.py"] == []


def test_package_that_holds_both_kinds_imports_nothing_itself() -> None:
    clean = set(pure())
    kinds: dict[Path, set[bool]] = {}
    for name, path in modules().items():
        for folder in path.parents:
            kinds.setdefault(folder, set()).add(name in clean)
    mixed = [package for package in packages() if len(kinds[package]) > 1]
    assert len(mixed) > 1
    for package in mixed:
        assert list(top_level_imports(ast.parse((package / "__init__.py").read_text()))) == [], package


class PackageCopy(NamedTuple):
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
def package_copy(tmp_path: Path) -> PackageCopy:
    shutil.copytree(ROOT / "simconsole", tmp_path / "simconsole", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    return PackageCopy(tmp_path)


def some_module(room: str) -> str:
    """A module of a room that is not a package."""
    return next(
        name
        for name, path in modules().items()
        if f"{name}.".startswith(f"simconsole.{room}.") and path.name != "__init__.py"
    )


def test_contracts_hold_in_this_tree(package_copy: PackageCopy) -> None:
    code, output = package_copy.lint()
    assert code == 0, output
    assert "3 kept, 0 broken" in output


def test_planted_upward_imports_are_found(package_copy: PackageCopy) -> None:
    """One import from each layer of rooms to the one above, all at once: each is named."""
    steps = []
    for above, below in itertools.pairwise(ROOMS[1:]):
        upper, lower = some_module(above[0]), some_module(below[-1])
        package_copy.plant(lower, f"import {upper}")
        steps.append((lower, upper))
    code, output = package_copy.lint()
    assert code == 1
    assert "Rooms import downwards only BROKEN" in output
    for lower, upper in steps:
        assert f"{lower} -> {upper}" in output


def test_planted_imports_between_rooms_side_by_side_are_found(package_copy: PackageCopy) -> None:
    apart = [room for layer in ROOMS for room in layer if len(layer) > 1]
    pairs = [(some_module(room), some_module(other)) for layer in ROOMS for room, other in itertools.pairwise(layer)]
    assert len(apart) > 8
    for importer, imported in pairs:
        package_copy.plant(importer, f"import {imported}")
    _, output = package_copy.lint()
    for importer, imported in pairs:
        assert f"{importer} -> {imported}" in output


def test_planted_forbidden_imports_are_found(package_copy: PackageCopy) -> None:
    """Each forbidden module, in a pure module of its own, hidden in a function: each is named."""
    cores = [name for name in pure() if modules()[name].name != "__init__.py"]
    planted = list(zip(cores[:: len(cores) // 20], itertools.cycle(FORBIDDEN["forbidden_modules"])))  # one is endless
    assert {forbidden for _, forbidden in planted} == set(FORBIDDEN["forbidden_modules"])
    for core, forbidden in planted:
        package_copy.plant(core, f"def planted() -> None:\n    import {forbidden}\n")
    code, output = package_copy.lint()
    assert code == 1
    assert f"{FORBIDDEN['name']} BROKEN" in output
    for core, forbidden in planted:
        assert f"{core} -> {forbidden}" in output


@pytest.mark.parametrize("clock", ["monotonic", "monotonic_ns", "perf_counter", "perf_counter_ns", "time", "sleep"])
@pytest.mark.parametrize("code", ["import time\ntime.{}(1)\n", "from time import {0}\n{0}(1)\n"])
def test_planted_clock_in_a_test_is_refused(clock: str, code: str) -> None:
    def codes(path: str) -> set[str]:
        words = [str(Path(sys.executable).parent / "ruff"), "check", "--output-format=json", "--stdin-filename", path]
        done = subprocess.run([*words, "-"], cwd=ROOT, input=code.format(clock), capture_output=True, text=True)
        return {found["code"] for found in json.loads(done.stdout)}

    assert "TID251" in codes("tests/control/test_new.py")
    assert "TID251" not in codes("tests/patience.py")
    assert "TID251" not in codes("simconsole/session/new.py")


def test_a_new_room_must_find_its_place(package_copy: PackageCopy) -> None:
    (package_copy.root / "simconsole" / "annexe.py").write_text('"""A module at the root."""\n')
    code, output = package_copy.lint()
    assert code == 1
    assert "simconsole.annexe" in output


def test_planted_imports_between_outside_rooms_are_found(package_copy: PackageCopy) -> None:
    rooms = INDEPENDENT["modules"]
    assert rooms == [f"simconsole.{room}" for room in ("devices", "bridge", "canbus", "hud", "scene")]
    for importer, imported in itertools.permutations(rooms, 2):
        package_copy.plant(importer, f"import {imported}")
    code, output = package_copy.lint()
    assert code == 1
    assert f"{INDEPENDENT['name']} BROKEN" in output
    for importer, imported in itertools.permutations(rooms, 2):
        assert f"{importer} is not allowed to import {imported}" in output


def test_the_picture_of_the_rooms_is_up_to_date() -> None:
    command = [sys.executable, str(ROOT / "scripts" / "make_architecture.py")]
    drawn = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert drawn == (ROOT / "docs" / "images" / "rooms.svg").read_text(), "python scripts/make_architecture.py"


def loaded_by(code: str, *, forbid: list[str]) -> set[str]:
    """Which of `forbid` a fresh interpreter has loaded after `code`."""
    script = f"import sys\n{code}\nprint('LOADED', *sys.modules.keys() & set({forbid}))"
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return set(done.stdout.partition("LOADED")[2].split())


@pytest.mark.parametrize("words", [["--help"], ["drive", "--help"], ["doctor", "--help"]])
def test_help_loads_no_heavy_library(words: list[str]) -> None:
    code = "import contextlib\nfrom simconsole.cli.main import main\n"
    code += f"with contextlib.suppress(SystemExit):\n    main({words})"
    assert loaded_by(code, forbid=[*HEAVY, "numpy", "websockets", "asyncio"]) == set()


def test_help_is_there_and_its_time_is_printed(record_property: Callable[[str, object], None]) -> None:
    times = Stopwatch()
    for _ in range(5):
        times.start()
        done = subprocess.run([sys.executable, "-m", "simconsole", "--help"], cwd=ROOT, capture_output=True, text=True)
        times.lap()
        assert done.returncode == 0
        assert "demo" in done.stdout
    record_property("simconsole --help, median of 5", f"{times.median} (aim 0.3 s)")


def test_importing_every_core_loads_no_heavy_library() -> None:
    code = "\n".join(f"import {name}" for name in pure())
    assert loaded_by(code, forbid=[*HEAVY, "websockets", "asyncio"]) == set()


def test_importing_every_shell_loads_no_heavy_library() -> None:
    """Shells load what they need when they are opened, so that a machine without it can run the rest."""
    code = "\n".join(f"import {name}" for name in modules() if name != "simconsole.__main__")
    assert loaded_by(code, forbid=[*HEAVY]) == set()


def test_profiles_are_the_only_door_to_yaml() -> None:
    users = {
        name
        for name, tree in trees("yaml")
        for node in ast.walk(tree)
        if isinstance(node, ast.Import | ast.ImportFrom)
        if "yaml"
        in {alias.name.partition(".")[0] for alias in node.names}
        | {(getattr(node, "module", "") or "").partition(".")[0]}
    }
    assert users == {"simconsole.profiles.strict_yaml"}


def test_nothing_linux_only_is_imported_at_module_level() -> None:
    found = {
        (module, name)
        for module, tree in trees("|".join(LINUX_ONLY))
        for name in top_level_imports(tree)
        if name.partition(".")[0] in LINUX_ONLY
    }
    assert found == set()


def test_finder_of_module_level_imports_looks_into_blocks_but_not_into_functions() -> None:
    source = (
        "try:\n    import fcntl\nexcept ImportError:\n    pass\ndef f():\n    import pwd\nclass C:\n    import tty\n"
    )
    assert list(top_level_imports(ast.parse(source))) == ["fcntl", "tty"]
