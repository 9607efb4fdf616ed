"""The result of a command."""

from typing import Any, Final, NamedTuple

RECORDING_FAILED: Final = "RECORDING FAILED"


class Outcome(NamedTuple):
    """The end of a command: its exit code (see cli/main.py), its results for `--json`, its text."""

    code: int
    results: dict[str, Any]
    text: str = ""


def table(rows: list[tuple[str, str]]) -> str:
    """Return two aligned columns, one row a line."""
    width = max((len(name) for name, _ in rows), default=0)
    return "\n".join(f"  {name:<{width}}  {value}" for name, value in rows)
