"""The documents say what is true: links resolve, and every file, function and value that they name exists."""

import ast
import re
import shlex
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from simconsole.cli.main import parser
from tests.paths import ROOT

PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))]
NAME_IN_FILE = re.compile(r"`([\w.]+)`\s+in\s+`([\w/]+\.py)`")
PATH = re.compile(r"`([\w./-]+\.(?:py|yaml|md|txt|toml))`|`([\w./-]+/)`")
IDENTIFIER = re.compile(r"`([A-Za-z_]\w*)`")
WRITTEN = re.compile(r"^```\w+ (\S+)$", re.MULTILINE)
"""A file that the page has the reader write: its name stands at the head of its text."""
LINK = re.compile(r"\[[^\]]*\]\(([^)#\s]+)[^)]*\)")
NOT_OURS = {"nan", "inf", "no", "fastmath", "min", "max", "abs", "odom", "map", "RecursionError", "json", "uv"}


def find(path: str) -> Path | None:
    """A path in a document is from the root, or below simconsole/."""
    for base in (ROOT, ROOT / "simconsole"):
        if (base / path).exists():
            return base / path
    return None


def defined(path: Path) -> set[str]:
    """Functions, classes, methods (`Class.method`), fields and constants of a file."""

    def visit(body: list[ast.stmt], prefix: str) -> Iterator[str]:
        for node in body:
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                yield prefix + node.name
            if isinstance(node, ast.ClassDef):
                yield from visit(node.body, f"{prefix}{node.name}.")
            if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                yield prefix + node.target.id
            if isinstance(node, ast.Assign):
                yield from (prefix + target.id for target in node.targets if isinstance(target, ast.Name))

    return set(visit(ast.parse(path.read_text()).body, ""))


@cache
def words_of_the_sources() -> frozenset[str]:
    texts = (path.read_text() for path in (ROOT / "simconsole").rglob("*.py"))
    return frozenset(word for text in texts for word in re.findall(r"\w+", text))


def page_id(path: Path) -> str:
    return str(path.relative_to(ROOT))


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_links_inside_the_project_resolve(page: Path) -> None:
    for target in LINK.findall(page.read_text()):
        if "://" not in target:
            assert (page.parent / target).exists(), target


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_every_file_and_folder_named_exists(page: Path) -> None:
    text = page.read_text()
    written = set(WRITTEN.findall(text))
    for file, folder in PATH.findall(text):
        assert file in written or find(file or folder) is not None, file or folder


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_every_name_stands_in_the_file_that_the_page_gives(page: Path) -> None:
    for name, file in NAME_IN_FILE.findall(page.read_text()):
        path = find(file)
        assert path is not None, file
        assert name in defined(path), f"`{name}` in `{file}`"


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_every_other_name_occurs_in_the_sources(page: Path) -> None:
    named = {name for name in IDENTIFIER.findall(page.read_text()) if not name.startswith("_")} - NOT_OURS
    assert named - words_of_the_sources() == set()


COMMANDS = [
    (page, line)
    for page in PAGES
    for line in re.findall(r"^(?:\$ |    )((?:yes '' \| )?simconsole [a-z].*)$", page.read_text(), re.MULTILINE)
]


@pytest.mark.parametrize(("page", "line"), COMMANDS, ids=lambda part: part if isinstance(part, str) else part.stem)
def test_the_command_line_understands_every_command(page: Path, line: str) -> None:
    """What a page shows is a command with its options; tests/test_readme.py and others run what can be run anywhere."""
    words = shlex.split(line.partition("simconsole ")[2], comments=True)
    words = [word for word in words if word != "&"]
    parser().parse_args(words)


def test_commands_of_many_pages_are_found() -> None:
    assert len(COMMANDS) > 40
    assert len({page for page, _ in COMMANDS}) > 10


def test_tick_page_names_a_place_for_every_step() -> None:
    pairs = NAME_IN_FILE.findall((ROOT / "docs" / "tick.md").read_text())
    assert len(pairs) >= 40
    stages = {"advance", "calibrate", "arbitrate", "gate", "step", "vehicle_state", "replay", "seal"}
    assert {name for name, _ in pairs} >= stages


def test_finder_of_names_sees_what_is_missing() -> None:
    names = defined(ROOT / "simconsole" / "tick" / "loop.py")
    assert {"run", "Components", "Components.devices", "Recorder.write"} <= names
    assert "walk" not in names


def test_the_index_names_every_page() -> None:
    index = (ROOT / "docs" / "README.md").read_text()
    folder = ROOT / "docs"
    pages = {path.relative_to(folder).as_posix() for path in folder.rglob("*.md") if path.parent.name != "decisions"}
    assert {page for page in pages - {"README.md"} if f"({page})" not in index} == set()
