"""`import simconsole` is the API: what it offers, what it loads, what it tells type checkers."""

import ast
import subprocess
import sys

import pytest

import simconsole
from tests.paths import ROOT

OFFERED: dict[str, str] = vars(simconsole)["_OFFERED"]


def told() -> dict[str, str]:
    """What type checkers are told: the module of each name."""
    tree = ast.parse((ROOT / "simconsole" / "__init__.py").read_text())
    imports = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module != "importlib"]
    return {alias.name: str(node.module) for node in imports for alias in node.names}


def test_type_checkers_are_told_what_there_is_and_where() -> None:
    offered = {name: f"simconsole.{module}" for name, module in OFFERED.items()}
    assert offered == told()


@pytest.mark.parametrize("name", sorted(OFFERED))
def test_every_name_is_there(name: str) -> None:
    assert getattr(simconsole, name) is not None
    assert name in dir(simconsole)


def test_another_name_is_an_attribute_error() -> None:
    name = "lode"
    with pytest.raises(AttributeError, match="no attribute 'lode'"):
        getattr(simconsole, name)


def test_importing_it_loads_nothing_else() -> None:
    code = "import sys; before = set(sys.modules); import simconsole; print(*sorted(set(sys.modules) - before))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["simconsole"]
