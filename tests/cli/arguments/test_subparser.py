import argparse

import pytest

from simconsole.cli.arguments.subparser import command, number
from simconsole.cli.terminal.parser import Parser


def test_a_number_out_of_its_bounds_is_refused_with_them_and_the_unit() -> None:
    read = number(0.1, 20.0, "m/s2")
    assert (read("0.1"), read("20")) == (0.1, 20.0)
    for text in ("0", "20.5", "nan"):
        with pytest.raises(argparse.ArgumentTypeError, match=r"0\.1 to 20 m/s2"):
            read(text)


def test_every_command_knows_what_does_it_and_whether_to_print_json() -> None:
    root = Parser()
    command(root.add_subparsers(dest="command"), "go", "drive:drive", "goes", "", "fast")
    said = root.parse_args(["go", "--json"])
    assert (said.does, said.json) == ("drive:drive", True)
