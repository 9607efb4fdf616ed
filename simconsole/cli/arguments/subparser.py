"""What the commands' arguments share."""

import argparse
from collections.abc import Callable
from typing import Any


def command(commands: Any, name: str, does: str, summary: str) -> argparse.ArgumentParser:
    """Add a command that the function `does` ("module:function" in `cli`) carries out.

    Args:
        commands: what the root parser's `add_subparsers` returned.
        name: of the command.
        does: where its function is, which is loaded when it is called.
        summary: one line for the help pages.
    """
    added: argparse.ArgumentParser = commands.add_parser(name, help=summary, description=summary)
    added.set_defaults(does=does)
    added.add_argument("--json", action="store_true", help="print the results as one JSON object on the last line")
    return added


def number(least: float, most: float, unit: str) -> Callable[[str], float]:
    """Return what reads a number within bounds."""

    def read(text: str) -> float:
        value = float(text)
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"{text}: {least:g} to {most:g} {unit}")
        return value

    return read
