"""`simconsole list`: the names that commands and profiles take."""

from argparse import Namespace
from itertools import takewhile
from typing import Final

from simconsole.cli.outcome import Outcome, table
from simconsole.profiles import strict_yaml
from simconsole.profiles.files.loader import names, read_text
from simconsole.values.errors import ProfileError, did_you_mean

KINDS: Final = {
    "sessions": "simconsole drive NAME",
    "worlds": "scenario.world of a session; simconsole world show NAME",
    "vehicles": "scenario.vehicle of a session",
    "scenarios": "simconsole check NAME",
    "cockpits": "simconsole drive --cockpit NAME",
    "languages": "simconsole drive --language NAME",
}
"""What can be listed, and what takes such a name."""
_FOLDERS: Final = {"cockpits": "devices"}


def listing(options: Namespace) -> Outcome:
    """List the profiles of one kind, or of all, each with its title.

    Raises:
        ProfileError: there is no such kind.
    """
    kind = options.kind if options.kind is None or options.kind in KINDS else f"{options.kind}s"
    if kind is not None and kind not in KINDS:
        raise ProfileError(f"command line: KIND: value {options.kind}: {did_you_mean(options.kind, list(KINDS))}")
    found = {one: listed(one) for one in KINDS if kind in (None, one)}
    parts = [f"{one} ({KINDS[one]})\n{listing_text(rows)}" for one, rows in found.items()]
    return Outcome(0, found, "\n\n".join(parts))


def listing_text(rows: list[dict[str, str]]) -> str:
    """Return rows of `listed` as a table."""
    return table([(row["name"], f"{row['kind']:<7} {row['title']}" if "kind" in row else row["title"]) for row in rows])


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
