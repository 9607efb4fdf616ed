"""The source files of the repository, for tests that read them."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

from tests.paths import ROOT


def module_name(path: Path, root: Path = ROOT) -> str:
    return ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__")


@cache
def modules() -> dict[str, Path]:
    """The modules of the package by name. Not to be changed."""
    return {module_name(path): path for path in sorted((ROOT / "simconsole").rglob("*.py"))}


class Facts(NamedTuple):
    """What tests ask of the syntax of a module; not its tree, for those of all modules are 150 MB."""

    imports: list[tuple[str, list[str]]]
    """Of each `from MODULE import NAMES`, anywhere in its text."""
    records: set[str]
    """The names of its record classes."""
    calls: list[tuple[str, int, int]]
    """Of each call of a plain name: that, the line, and how many values are given by position."""


def facts_of(tree: ast.AST) -> Facts:
    """Return them of one module."""
    found = Facts([], set(), [])
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            found.imports.append((node.module or "", [alias.name for alias in node.names]))
        elif isinstance(node, ast.ClassDef):
            if any(ast.unparse(base) == "NamedTuple" for base in node.bases):
                found.records.add(node.name)
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            values = [value for value in node.args if not isinstance(value, ast.Starred)]
            found.calls.append((node.func.id, node.lineno, len(values)))
    return found


@cache
def facts() -> dict[str, Facts]:
    """Those of all modules of the package by name. Not to be changed."""
    return {name: facts_of(ast.parse(path.read_text())) for name, path in modules().items()}


def trees(pattern: str) -> Iterator[tuple[str, ast.Module]]:
    """Yield the modules, each by its name, in whose text a regular expression is found."""
    for name, path in modules().items():
        text = path.read_text()
        if re.search(pattern, text):
            yield name, ast.parse(text)


def python_files() -> list[Path]:
    folders = ("simconsole", "tests", "benchmarks", "examples", "scripts")
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]
