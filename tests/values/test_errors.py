"""The tree of exceptions in the docstring of errors.py is the tree in its code."""

import inspect
import re

from simconsole.values import errors


def test_docstring_draws_exactly_the_tree() -> None:
    drawn: dict[str, str] = {}
    above = {0: "SimConsoleError"}
    for bars, name in re.findall(r"^    ((?:\|   |    )*\+-- )(\w+)", errors.__doc__ or "", re.MULTILINE):
        depth = len(bars) // 4
        drawn[name] = above[depth - 1]
        above[depth] = name
    written = {
        name: kind.__base__.__name__
        for name, kind in inspect.getmembers(errors, inspect.isclass)
        if kind is not errors.SimConsoleError and kind.__base__ is not None
    }
    assert drawn == written


def test_every_error_ends_the_program_with_a_documented_code() -> None:
    for _, kind in inspect.getmembers(errors, inspect.isclass):
        assert issubclass(kind, errors.SimConsoleError)
        assert kind.exit_code in (1, 2)
