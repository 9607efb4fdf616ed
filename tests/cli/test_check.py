from argparse import Namespace
from pathlib import Path
from xml.etree import ElementTree

import pytest

from simconsole.cli import check as commands
from simconsole.cli.check import check
from simconsole.evaluation.checks.scenario_check import Verdict
from tests.drives.console import complaint, results, simconsole, within


def test_a_file_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    done = simconsole("check", "launch_and_stop", "--junit", tmp_path / "nowhere" / "junit.xml")
    assert "No such file or directory" in complaint(done)


def test_the_command_line_selects_by_words(tmp_path: Path) -> None:
    for name in ("slow_start", "slow_stop"):
        assert within("new", "scenario", name, "--out", tmp_path).returncode == 0
    done = within("check", tmp_path, "-k", "slow and not stop", "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    assert [one["scenario"] for one in results(done)["scenarios"]] == ["slow_start"]
    assert "-k: value fast" in complaint(within("check", tmp_path, "-k", "fast"))


VERDICTS = {
    "good": Verdict("good", True, 500, "aa", []),
    "bad": Verdict("bad", False, 7, "bb", ["vehicle.vx_mps: 9 > 8 at 1 s", "and <more>"]),
}


@pytest.fixture
def options(monkeypatch: pytest.MonkeyPatch) -> Namespace:
    def check_scenario(name: str, update_golden: bool) -> Verdict:
        return VERDICTS[name]

    monkeypatch.setattr(commands, "check_scenario", check_scenario)
    return Namespace(
        scenarios=["good", "bad"], jobs=1, update_golden=False, junit=None, report=None, review=None, select=None
    )


def test_one_bad_scenario_is_code_1_with_its_problems_below_it(options: Namespace) -> None:
    outcome = check(options)
    assert outcome.code == 1
    assert outcome.text.splitlines() == [
        "pass  good  500 ticks  aa",
        "FAIL  bad  7 ticks  bb",
        "      vehicle.vx_mps: 9 > 8 at 1 s",
        "      and <more>",
    ]
    assert [entry["passed"] for entry in outcome.results["scenarios"]] == [True, False]
    options.scenarios = ["good"]
    assert check(options).code == 0


def test_junit_names_every_case_and_what_failed(options: Namespace, tmp_path: Path) -> None:
    options.junit = str(tmp_path / "junit.xml")
    check(options)
    suite = ElementTree.parse(options.junit).getroot()
    assert (suite.get("tests"), suite.get("failures")) == ("2", "1")
    good, bad = suite.findall("testcase")
    assert good.find("failure") is None
    failure = bad.find("failure")
    assert failure is not None
    assert failure.get("message") == "vehicle.vx_mps: 9 > 8 at 1 s"
    assert str(failure.text).endswith("and <more>")
