"""argparse with a suggestion for words that it does not know, and with the reason of a refusal in its exit."""

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NoReturn

from simconsole.values.errors import did_you_mean, near


class BadUsage(SystemExit):
    """A command line that cannot be read; `said` tells why, and has been printed."""

    def __init__(self, said: str) -> None:
        super().__init__(2)
        self.said = said


class Parser(argparse.ArgumentParser):
    """A parser that takes no shortened options, and guesses what was meant by a word that it refuses."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter, **settings)
        self.commands: Mapping[str, Parser] = {}
        """The parsers of its commands or actions, by name."""
        self.said_as = ""
        """Where the options keep which of them was said."""
        self.options: list[str] = []
        """The options that begin with two dashes."""

    def add_argument(self, *names: Any, **settings: Any) -> argparse.Action:
        """Add an argument as argparse does, and remember its long names."""
        added = super().add_argument(*names, **settings)
        # argparse adds --help before this class has its list
        self.__dict__.setdefault("options", []).extend(name for name in names if name.startswith("--"))
        return added

    def add_subparsers(self, **settings: Any) -> Any:
        """Let the parser have commands, as argparse does, and remember them."""
        added = super().add_subparsers(**settings)
        self.commands, self.said_as = added.choices, str(settings["dest"])
        return added

    def pages(self) -> "Iterator[Parser]":
        """Yield this parser, and those of all its commands and their actions."""
        yield self
        for command in self.commands.values():
            yield from command.pages()

    def options_of(self, words: Sequence[str]) -> argparse.Namespace:
        """Return the options that are meant by the words of a command line; leave with a guess where one is unknown.

        Raises:
            BadUsage: an argument is missing, unknown or not allowed; usage and reason are printed.
        """
        found, unknown = self.parse_known_args(words)
        if not unknown:
            return found
        reader = self
        while reader.commands:
            reader = reader.commands[getattr(found, reader.said_as)]
        reader.error(f"not known here: {' '.join(unknown)}; {_hint(reader, unknown)}")

    def error(self, message: str) -> NoReturn:
        """Print usage and problem, and leave with code 2.

        Raises:
            BadUsage: always.
        """
        self.print_usage(sys.stderr)
        self._print_message(f"{self.prog}: error: {message}\n", sys.stderr)
        raise BadUsage(message)

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            known = [str(choice) for choice in action.choices]
            raise argparse.ArgumentError(action, f"value {value}: {did_you_mean(str(value), known)}")


def _hint(reader: Parser, unknown: Sequence[str]) -> str:
    """Return what may have been meant by words that nobody knows."""
    options = [word.partition("=")[0] for word in unknown if word.startswith("-")]
    early = [option for option in options if option in reader.options]
    if early:
        return f"{' '.join(early)} belongs behind {reader.prog}"
    meant = " ".join(guess for guess in (near(option, reader.options) for option in options) if guess)
    return f"did you mean {meant}?" if meant else f"see {reader.prog} --help"
