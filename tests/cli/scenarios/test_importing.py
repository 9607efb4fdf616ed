from pathlib import Path

from simconsole.evaluation.checks.scenario_check import check_scenario
from tests.drives.console import complaint, results, simconsole
from tests.evaluation.openscenario.files import NOT_UNDERSTOOD, UNDERSTOOD


def test_a_file_is_imported_and_can_be_checked(tmp_path: Path) -> None:
    (tmp_path / "cut_in.xosc").write_bytes(UNDERSTOOD["lane change to the right"]())
    words = "scenario", "import", tmp_path / "cut_in.xosc", "--out", tmp_path / "cut_in.yaml"
    done = results(simconsole(*words, "--json"))
    assert done["file"] == str(tmp_path / "cut_in.yaml")
    assert (done["actors"], done["left_out"]) == (1, [])
    assert "driven as cubic" in done["notes"][1]
    assert (tmp_path / "cut_in.yaml").read_text().startswith("# Made by `simconsole scenario import` from cut_in.xosc")
    assert check_scenario(str(tmp_path / "cut_in.yaml"), update_golden=True).passed
    assert "is there already" in complaint(simconsole(*words))


def test_what_is_left_out_is_listed(tmp_path: Path) -> None:
    element, make = NOT_UNDERSTOOD["a goal"]
    path, out = tmp_path / "goal.xosc", tmp_path / "goal.yaml"
    path.write_bytes(make())
    assert f"<{element}>: not understood" in complaint(simconsole("scenario", "import", path, "--out", out))
    assert not out.exists()
    done = simconsole("scenario", "import", path, "--out", out, "--partly")
    assert f"left out: line 91: <{element}>: not understood" in done.stdout
    assert f"# Left out: line 91: <{element}>: not understood" in out.read_text()


def test_another_file_is_refused(tmp_path: Path) -> None:
    assert "an OpenSCENARIO file, .xosc" in complaint(simconsole("scenario", "import", tmp_path / "a.xml"))
    (tmp_path / "a.xosc").write_text("<OpenDRIVE/>")
    assert "line 1: <OpenDRIVE>: value OpenDRIVE: <OpenSCENARIO>" in complaint(
        simconsole("scenario", "import", tmp_path / "a.xosc")
    )
