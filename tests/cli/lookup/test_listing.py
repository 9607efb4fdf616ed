"""`simconsole list`: every name that a command takes."""

import json

import pytest

from simconsole.cli.lookup.listing import KINDS
from simconsole.cli.main import main
from simconsole.profiles.files.titles import listed, shipped


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_has_names_with_titles(kind: str) -> None:
    rows = listed(kind)
    assert rows
    assert [row["name"] for row in rows] == shipped(kind)
    assert all(row["title"] for row in rows)


def test_names_are_those_that_commands_take(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "--json"]) == 0
    found = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert set(found) == set(KINDS)
    names = {kind: [row["name"] for row in rows] for kind, rows in found.items()}
    assert {"demo", "seated"} <= set(names["sessions"])
    assert "urban" in names["worlds"]
    assert not [name for name in names["worlds"] if "plan" in name]
    assert "t500rs_th8rs" in names["cockpits"]
    assert {"kind": "arena", "name": "arena", "title": "Arena, 6 x 9 m"} in found["worlds"]


def test_one_kind_by_one_or_many(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "vehicle"]) == 0
    said = capsys.readouterr().out
    assert "hatchback  " in said
    assert "urban" not in said


def test_a_kind_that_is_none_gets_a_guess(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "wrolds"]) == 2
    assert capsys.readouterr().err == "simconsole list: command line: KIND: value wrolds: did you mean worlds?\n"
