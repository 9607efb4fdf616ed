"""`simconsole list`: the names that commands and profiles take."""

from argparse import Namespace
from typing import Final

from simconsole.cli.outcome import Outcome, table
from simconsole.profiles.files.titles import listed
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
