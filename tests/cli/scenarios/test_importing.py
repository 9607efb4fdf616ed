from pathlib import Path

import pytest

from simconsole.evaluation.checks.scenario_check import check_scenario
from simconsole.evaluation.sweep.plan import load_plan
from tests.drives.console import complaint, results, simconsole, within
from tests.evaluation.openscenario.files import NOT_UNDERSTOOD, UNDERSTOOD, file_of, span


def test_a_file_is_imported_and_can_be_checked(tmp_path: Path) -> None:
    (tmp_path / "cut_in.xosc").write_bytes(UNDERSTOOD["lane change to the right"]())
    words = "scenario", "import", tmp_path / "cut_in.xosc", "--out", tmp_path / "cut_in.yaml"
    done = results(simconsole(*words, "--json"))
    assert done["file"] == str(tmp_path / "cut_in.yaml")
    assert (done["actors"], done["left_out"]) == (1, [])
    assert "driven as cubic" in done["notes"][1]
    assert (tmp_path / "cut_in.yaml").read_text().startswith("# Made by `simconsole scenario import` from cut_in.xosc")
    assert check_scenario(str(tmp_path / "cut_in.yaml"), update_golden=True).passed
    assert "is there already" in complaint(within(*words))


def test_what_is_left_out_is_listed(tmp_path: Path) -> None:
    element, make = NOT_UNDERSTOOD["a goal"]
    path, out = tmp_path / "goal.xosc", tmp_path / "goal.yaml"
    path.write_bytes(make())
    assert f"<{element}>: not understood" in complaint(within("scenario", "import", path, "--out", out))
    assert not out.exists()
    done = simconsole("scenario", "import", path, "--out", out, "--partly")
    assert f"left out: line 91: <{element}>: not understood" in done.stdout
    assert f"# Left out: line 91: <{element}>: not understood" in out.read_text()


def test_a_file_of_values_makes_a_scenario_for_each_and_their_sweep(tmp_path: Path) -> None:
    content = UNDERSTOOD["speed by time"]().replace(
        b'AbsoluteTargetSpeed value="0.0"', b'AbsoluteTargetSpeed value="$speed"'
    )
    (tmp_path / "slower.xosc").write_bytes(content)
    (tmp_path / "values.xosc").write_bytes(file_of(span(2, 4, 2)))
    out = tmp_path / "slower"
    words = "scenario", "import", tmp_path / "slower.xosc", "--values", tmp_path / "values.xosc", "--out", out
    done = results(simconsole(*words, "--json"))
    assert (done["plan"], done["scenarios"], done["left_out"]) == (str(out / "plan.yaml"), 2, [])
    assert "# slower-1.yaml: speed=4\n" in (out / "plan.yaml").read_text()
    plan = load_plan(out / "plan.yaml")
    assert [task.source for task in plan.tasks] == ["slower-0", "slower-1"]
    acts = [task.scenario.actors[0].acts[0] for task in plan.tasks if task.scenario is not None]
    assert [act.speed_kmh for act in acts] == pytest.approx([7.2, 14.4])
    assert "is there already" in complaint(within(*words))


def test_another_file_is_refused(tmp_path: Path) -> None:
    assert "an OpenSCENARIO file, .xosc" in complaint(within("scenario", "import", tmp_path / "a.xml"))
    (tmp_path / "a.xosc").write_text("<OpenDRIVE/>")
    assert "line 1: <OpenDRIVE>: value OpenDRIVE: <OpenSCENARIO>" in complaint(
        simconsole("scenario", "import", tmp_path / "a.xosc")
    )
