"""`simconsole explain`: keys in words, and schemas for editors."""

import json
from pathlib import Path

import pytest

from simconsole.cli.main import main
from simconsole.profiles.keys.kinds import KINDS
from tests.paths import ROOT


def test_a_key_is_told_as_the_page_shows_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "steering.ratio"]) == 0
    page = (ROOT / "docs" / "own" / "keys.md").read_text("utf-8")
    assert f"$ simconsole explain steering.ratio\n{capsys.readouterr().out}```\n" in page


def test_a_unit_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "steering.friction_deg"]) == 0
    assert "\n  unit     deg\n  bounds   0 to 1\n" in capsys.readouterr().out


def test_a_name_of_several_keys_lists_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "session.vehicle"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("session.vehicle: 2 keys\n  session.scenario.vehicle ")
    assert "\n  session.scenario.platforms[].vehicle  " in said


def test_keys_of_one_path_are_told_whole_each(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "session.scenario.faults.seed"]) == 0
    said = capsys.readouterr().out
    assert "  file     session, where its section is noise\n" in said
    assert "  file     session, where its section is burst\n" in said


def test_without_a_key_every_kind_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain"]) == 0
    said = capsys.readouterr().out
    assert all(f"{kind} (docs/" in said for kind in KINDS)
    assert main(["explain", "sweep", "--json"]) == 0
    found = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert [key["path"] for key in found["sweep"]][:2] == ["sweep.schema", "sweep.title"]


def test_a_section_tells_its_keys(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "session.mode"]) == 0
    assert "\nkeys\n  tick_hz " in capsys.readouterr().out


def test_for_programs(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "tick_hz", "--json"]) == 0
    (key,) = json.loads(capsys.readouterr().out.splitlines()[-1])["keys"]
    assert (key["path"], key["unit"], key["default"]) == ("session.mode.tick_hz", "Hz", "250")
    assert key["also_at"] == ["scenario.session.mode.tick_hz"]
    assert key["example"]["file"].startswith(("sessions/", "scenarios/"))


def test_a_key_that_is_none_gets_a_guess(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "ratoi"]) == 2
    assert capsys.readouterr().err == "simconsole explain: command line: KEY: value ratoi: did you mean ratio?\n"


def test_schemas_are_written_and_templates_name_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "--schemas", str(tmp_path / "schemas")]) == 0
    assert main(["new", "session", "mine", "--out", str(tmp_path)]) == 0
    capsys.readouterr()
    assert len(list((tmp_path / "schemas").iterdir())) == len(KINDS)
    first = (tmp_path / "mine.yaml").read_text("utf-8").partition("\n")[0]
    start, _, schema = first.partition("$schema=")
    assert start == "# yaml-language-server: "
    assert json.loads((tmp_path / schema).read_text("utf-8"))["title"] == "simconsole session"


def test_a_template_where_no_schema_is_names_none(tmp_path: Path) -> None:
    assert main(["new", "session", "mine", "--out", str(tmp_path)]) == 0
    assert "yaml-language-server" not in (tmp_path / "mine.yaml").read_text("utf-8")


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert main(["explain", "--schemas", str(tmp_path / "file")]) == 2
    assert "cannot be written" in capsys.readouterr().err
