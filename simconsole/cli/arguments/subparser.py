"""What the commands' arguments share."""

import argparse
from collections.abc import Callable
from typing import Any

from simconsole.cli.terminal.parser import Parser


def command(commands: Any, name: str, does: str, summary: str, *examples: str) -> Parser:
    """Add a command, or an action of one, that the function `does` ("module:function" in `cli`) carries out.

    Args:
        commands: what `add_subparsers` of the root parser, or `actions`, returned.
        name: of the command or action.
        does: where its function is, which is loaded when it is called.
        summary: one line for the help pages.
        examples: what follows its name on the command line; shown at the end of its page.
    """
    added: Parser = commands.add_parser(name, help=summary, description=summary)
    added.epilog = "\n".join(("for example:", *(f"  {added.prog} {example}".rstrip() for example in examples)))
    added.set_defaults(does=does)
    added.add_argument("--json", action="store_true", help="print the results as one JSON object, and nothing else")
    added.add_argument("--quiet", "-q", action="store_true", help="say nothing that is no error; the exit code tells")
    added.add_argument("--verbose", "-v", action="store_true", help="tell each step and its time, errors at length")
    return added


def actions(commands: Any, name: str, summary: str, word: str = "action") -> Any:
    """Add a command that has actions; return what takes them, each with its own options and page of help.

    Args:
        commands: what the root parser's `add_subparsers` returned.
        name: of the command.
        summary: one line for the help pages.
        word: what its actions are called there, and where the options keep which it is.
    """
    added: Parser = commands.add_parser(name, help=summary, description=summary)
    added.epilog = f"{added.prog} {word.upper()} --help: its options, with an example"
    return added.add_subparsers(dest=word, required=True, metavar=word.upper(), title=f"{word}s")


def number(least: float, most: float, unit: str) -> Callable[[str], float]:
    """Return what reads a number within bounds."""

    def read(text: str) -> float:
        value = float(text)
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"{text}: {least:g} to {most:g} {unit}")
        return value

    return read
