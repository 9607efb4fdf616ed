"""argparse with a suggestion for words that it does not know."""

import argparse
from collections.abc import Mapping, Sequence
from typing import Any

from simconsole.values.errors import did_you_mean, near


class Parser(argparse.ArgumentParser):
    """A parser that takes no shortened options, and guesses what was meant by a word that it refuses."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(allow_abbrev=False, **settings)
        self.commands: Mapping[str, Parser] = {}
        """The parsers of the commands, of the one parser that has some."""
        self.options: list[str] = []
        """The options that begin with two dashes."""

    def add_argument(self, *names: Any, **settings: Any) -> argparse.Action:
        """Add an argument as argparse does, and remember its long names."""
        added = super().add_argument(*names, **settings)
        # argparse adds --help before this class has its list
        self.__dict__.setdefault("options", []).extend(name for name in names if name.startswith("--"))
        return added

    def options_of(self, words: Sequence[str]) -> argparse.Namespace:
        """Return the options that are meant by the words of a command line; leave with a guess where one is unknown.

        Raises:
            SystemExit: an argument is missing, unknown or not allowed; usage and reason are printed.
        """
        found, unknown = self.parse_known_args(words)
        if not unknown:
            return found
        reader = self.commands.get(getattr(found, "command", ""), self)
        guesses = [near(word.partition("=")[0], reader.options) for word in unknown if word.startswith("--")]
        meant = " ".join(guess for guess in guesses if guess)
        hint = f"did you mean {meant}?" if meant else f"see {reader.prog} --help"
        reader.error(f"not known here: {' '.join(unknown)}; {hint}")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            known = [str(choice) for choice in action.choices]
            raise argparse.ArgumentError(action, f"value {value}: {did_you_mean(str(value), known)}")
