import numpy as np
import pytest

from simconsole.checking import drive_scenario, judge
from simconsole.errors import ProfileError
from simconsole.profiles.scenario import Check, ScenarioProfile
from simconsole.profiles.session import Devices, ModeSection, Scenario, SessionProfile

COLUMNS = ("a", "b")
ROWS = np.column_stack([np.arange(1.0, 101.0), np.zeros(100)])  # one second at 100 Hz: a is the tick


@pytest.fixture
def scenario() -> ScenarioProfile:
    session = SessionProfile(
        schema=1, scenario=Scenario(vehicle="ball"), devices=Devices(driver="none"), mode=ModeSection(tick_hz=100)
    )
    return ScenarioProfile(schema=1, title="a second", duration_s=1.0, session=session)


@pytest.mark.parametrize(
    "check",
    [
        Check(column="a", at_s=0.5, min=50.0, max=50.0),
        Check(column="a", at_s=1.0, min=100.0, max=100.0),
        Check(column="a", from_s=0.5, min=51.0),
        Check(column="a", from_s=0.2, until_s=0.4, min=21.0, max=40.0),
        Check(column="b", min=0.0, max=0.0),
    ],
)
def test_a_bound_that_holds(check: Check) -> None:
    assert judge(check, ROWS, COLUMNS, 100, "s.yaml") is None


@pytest.mark.parametrize(
    ("check", "problem"),
    [
        (Check(column="a", at_s=0.5, max=49.0), "tick 50: a: 50.0 not in -inf to 49.0"),
        (Check(column="a", max=90.0), "tick 91: a: 91.0 not in -inf to 90.0"),
        (Check(column="a", from_s=0.5, min=60.0), "tick 51: a: 51.0 not in 60.0 to inf"),
        (Check(column="a", at_s=2.0, min=0.0), "a: no tick from 200 to 200, the drive has 100"),
    ],
)
def test_a_broken_bound_is_named_with_its_first_tick(check: Check, problem: str) -> None:
    assert judge(check, ROWS, COLUMNS, 100, "s.yaml") == problem


def test_what_is_no_number_is_outside_every_bound() -> None:
    rows = ROWS.copy()
    rows[10, 1] = np.nan
    assert judge(Check(column="b"), rows, COLUMNS, 100, "s.yaml") == "tick 11: b: nan not in -inf to inf"


def test_an_unknown_column_is_refused() -> None:
    with pytest.raises(ProfileError, match=r"^s\.yaml: checks: column: value c: a column of a row"):
        judge(Check(column="c"), ROWS, COLUMNS, 100, "s.yaml")


def test_a_scenario_without_person_and_controller_is_driven_too(scenario: ScenarioProfile) -> None:
    recorder, columns = drive_scenario(scenario)
    assert recorder.ticks == 100
    assert recorder.rows.shape == (100, len(columns))
    assert np.isfinite(recorder.rows).all()
    again, _ = drive_scenario(scenario)
    assert again.digest == recorder.digest
