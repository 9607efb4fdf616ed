"""`simconsole check`: the shipped scenarios keep their bounds and their goldens, and what changes is named."""

import shutil
from pathlib import Path
from xml.etree import ElementTree

import pytest

from simconsole.evaluation.checks.scenario_check import check_scenario
from simconsole.profiles.files import loader as profile_files
from tests.drives.console import complaint, results, simconsole, within
from tests.drives.fixtures import Checked

SHIPPED = sorted(path.stem for path in (profile_files.profiles_folder() / "scenarios").glob("*.yaml"))
QUICK = "roll_a_ball"


@pytest.fixture
def copied(tmp_path: Path) -> Path:
    """The shipped scenarios and goldens, to be altered."""
    return Path(shutil.copytree(profile_files.profiles_folder() / "scenarios", tmp_path / "scenarios"))


def alter(path: Path, before: str, after: str) -> str:
    text = path.read_text()
    assert text.count(before) == 1
    path.write_text(text.replace(before, after))
    return str(path)


def test_the_five_scenarios_of_the_first_drive_are_shipped() -> None:
    assert {"launch_and_stop", "hand_over", "command_lost", "emergency_stop", "roll_a_ball"} <= set(SHIPPED)


@pytest.mark.parametrize("scenario", SHIPPED)
def test_a_shipped_scenario_keeps_its_bounds_and_its_golden(scenario: str, checked: Checked) -> None:
    verdict = checked.scenarios[profile_files.profiles_folder() / "scenarios" / f"{scenario}.yaml"]
    assert verdict["passed"], "\n".join(verdict["problems"])
    assert verdict["scenario"] == scenario


def test_a_changed_control_value_is_named_with_tick_and_column(copied: Path) -> None:
    gentler = "{driver: none}\n  features: {control: {blind_stop_decel_mps2: 3.4}}"
    path = alter(copied / "command_lost.yaml", "{driver: none}", gentler)
    done = within("check", path, "--json")
    assert done.returncode == 1, done.stdout + done.stderr
    problem, heads, *columns = results(done)["scenarios"][0]["problems"]
    assert problem.startswith(f"{copied / 'golden' / 'command_lost.csv'}: tick ")
    tick, column = problem.split(": ")[1:3]
    assert 2800 < int(tick.removeprefix("tick ")) < 3500, "from the safe stop on, as sampled twice a second"
    assert column.startswith("memory."), "the arbiter's own columns come before what the car makes of them"
    assert "np.float64" not in problem
    assert problem in done.stderr
    assert heads.split()[:4] == ["column", "from", "accepted", "driven"]
    assert column in columns[0]


def test_a_changed_vehicle_value_is_named_with_tick_and_column(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    profiles = Path(shutil.copytree(profile_files.profiles_folder(), tmp_path / "profiles"))
    alter(profiles / "vehicles" / "hatchback.yaml", "mass_kg: 1300 ", "mass_kg: 1301 ")
    monkeypatch.setattr(profile_files, "profiles_folder", lambda: profiles)
    verdict = check_scenario("launch_and_stop")
    assert not verdict.passed
    (named,) = (problem for problem in verdict.problems if ".csv: tick " in problem)
    assert ": driven " in named
    column = named.split(": ")[2]
    assert column.split(".")[0] in ("vehicle", "platform")


def test_a_change_too_small_for_the_table_is_still_a_change(copied: Path) -> None:
    golden = copied / "golden" / f"{QUICK}.csv"
    head, rest = golden.read_text().split("\n", 1)
    golden.write_text(head[:-16] + "0" * 16 + "\n" + rest)
    verdict = check_scenario(str(copied / f"{QUICK}.yaml"))
    assert not verdict.passed
    assert verdict.problems == [f"{golden}: hash {verdict.digest}, accepted 0000000000000000; no sampled value differs"]


def test_a_missing_golden_fails_and_says_how_to_accept_one(copied: Path) -> None:
    golden = copied / "golden" / f"{QUICK}.csv"
    before = golden.read_bytes()
    golden.unlink()
    done = within("check", copied / f"{QUICK}.yaml")
    assert done.returncode == 1
    assert f"{golden}: no golden; accept one with --update-golden" in done.stdout
    assert not golden.exists(), "a check accepts nothing by itself"
    assert within("check", copied / f"{QUICK}.yaml", "--update-golden").returncode == 0
    assert golden.read_bytes() == before, "this machine drives what the golden's machine drove"


def test_a_broken_bound_fails_even_while_goldens_are_accepted(copied: Path) -> None:
    path = alter(copied / f"{QUICK}.yaml", "min: 2.99, max: 3.01", "min: 3.5, max: 3.6")
    verdict = check_scenario(path, update_golden=True)
    assert not verdict.passed
    (problem,) = verdict.problems
    assert problem.startswith("tick 1200: vehicle.x_m: 2.99")
    assert problem.endswith("not in 3.5 to 3.6")


def test_two_jobs_give_the_verdicts_of_one_and_a_junit_file(copied: Path, tmp_path: Path) -> None:
    alter(copied / "command_lost.yaml", "min: -4.5}", "min: -2.0}")
    names = [copied / "command_lost.yaml", copied / f"{QUICK}.yaml"]
    junit = tmp_path / "junit.xml"
    one = within("check", *names, "--json")
    two = simconsole("check", *names, "--json", "--jobs", 2, "--junit", junit)
    assert one.returncode == two.returncode == 1
    assert one.stdout == two.stdout
    assert [scenario["passed"] for scenario in results(two)["scenarios"]] == [False, True]
    suite = ElementTree.parse(junit).getroot()
    assert (suite.tag, suite.get("tests"), suite.get("failures")) == ("testsuite", "2", "1")
    assert [case.get("name") for case in suite] == ["command_lost", QUICK]
    failure = suite[0].find("failure")
    assert failure is not None
    assert "vehicle.ax_mps2" in str(failure.get("message"))
    assert suite[1].find("failure") is None


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("duration_s: 12", "duration_s: 0", "duration_s: value 0: a number, above 0 and 86400 or less"),
        ("kind: pose", "kind: wish", 'remote[0].kind: value "wish": '),
        ("event: request_autonomous", "event: explode", 'events[0].event: value "explode": '),
        (
            "column: vehicle.x_m",
            "column: vehicle.x_mm",
            "column: value vehicle.x_mm: a column of the state vector",
        ),
        ("vehicle: ball", "vehicle: bell", "bell"),
    ],
)
def test_a_scenario_that_cannot_be_driven_is_one_line(copied: Path, before: str, after: str, message: str) -> None:
    path = alter(copied / f"{QUICK}.yaml", before, after)
    assert message in complaint(within("check", path))


def test_a_golden_that_is_none_is_one_line(copied: Path) -> None:
    golden = copied / "golden" / f"{QUICK}.csv"
    golden.write_text("tick,vehicle.x_m\n1,0.0\n")
    assert f"{golden}: line 1: not a golden" in complaint(within("check", copied / f"{QUICK}.yaml"))
