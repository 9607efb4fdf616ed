"""What a command hands back to the command line."""

from typing import Any, Final, NamedTuple

INTERRUPTED: Final = 130
"""Exit code of what SIGINT or SIGTERM ended, as a shell reports a Ctrl-C; a drive's bundle is whole all the same."""

RECORDING_FAILED: Final = "RECORDING FAILED"


class Outcome(NamedTuple):
    """The end of a command: its exit code (see cli.py), its results for `--json`, its text."""

    code: int
    results: dict[str, Any]
    text: str = ""


def table(rows: list[tuple[str, str]]) -> str:
    """Return two aligned columns, one row a line."""
    width = max((len(name) for name, _ in rows), default=0)
    return "\n".join(f"  {name:<{width}}  {value}" for name, value in rows)
