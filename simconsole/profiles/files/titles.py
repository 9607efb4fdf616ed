"""Names and titles of the shipped profiles."""

from itertools import takewhile
from typing import Final

from simconsole.profiles import strict_yaml
from simconsole.profiles.files.loader import names, read_text

_FOLDERS: Final = {"cockpits": "devices"}


def listed(kind: str) -> list[dict[str, str]]:
    """Return name and title of each shipped profile of a kind, of worlds also what kind of world it is."""
    return [_row(kind, name) for name in shipped(kind)]


def shipped(kind: str) -> list[str]:
    """Return the names of the shipped profiles of a kind; plans of worlds are none."""
    return [name for name in names(_FOLDERS.get(kind, kind)) if not name.endswith(".plan")]


def _row(kind: str, name: str) -> dict[str, str]:
    text = read_text(_FOLDERS.get(kind, kind), f"{name}.yaml")
    values = strict_yaml.parse(text, name)
    assert isinstance(values, dict)
    title = str(values.get("title") or _first_sentence(text))
    return {"name": name, "title": title, **({"kind": str(values.get("kind", "course"))} if kind == "worlds" else {})}


def _first_sentence(text: str) -> str:
    """Return what the comment at the head of a profile begins with."""
    head = [line[1:].strip() for line in takewhile(lambda line: line.startswith("#"), text.splitlines())]
    return " ".join(head).partition(": ")[0].partition(". ")[0].removesuffix(".")
