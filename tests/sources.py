"""The source files of the repository, for tests that read them."""

from functools import cache
from pathlib import Path

from tests.paths import ROOT


def module_name(path: Path, root: Path = ROOT) -> str:
    return ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__")


@cache
def modules() -> dict[str, Path]:
    """The modules of the package by name. Not to be changed."""
    return {module_name(path): path for path in sorted((ROOT / "simconsole").rglob("*.py"))}


def python_files() -> list[Path]:
    folders = ("simconsole", "tests", "benchmarks", "examples", "scripts")
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]
