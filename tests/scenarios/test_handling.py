"""Every shipped test manoeuvre: the default car is inside all limits, and what a scenario can get wrong is named."""

from collections.abc import Callable
from pathlib import Path

import pytest

from simconsole.evaluation.checks.scenario_check import check_scenario
from simconsole.profiles.files.loader import profiles_folder
from simconsole.session.resolution import load_scenario
from simconsole.values.errors import ProfileError
from tests.drives.console import results, within
from tests.drives.fixtures import REPEATED, Checked
from tests.samples import Sample

FOLDER = profiles_folder() / "scenarios" / "handling"
SHIPPED = sorted(FOLDER.glob("*.yaml"))
DRIVEN = [path for path in SHIPPED if f"handling/{path.stem}" not in REPEATED]
KINDS = {
    *(
        "steady_state_circle",
        "step_steer",
        "sine_with_dwell",
        "sine_with_dwell_van",
        "double_lane_change",
        "severe_double_lane_change",
    ),
    *("straight_braking", "split_friction_braking", "coast_down", "launch", "stall", "hill_start", "reverse"),
    *(
        "parking_creep",
        "parking_hold",
        "parking_effort",
        "weave",
        "creep",
        "creep_van",
        "upshift",
        "upshift_van",
        "light_throttle",
        "clutch_protection",
    ),
    *("hill_van_20", "hill_van_25", "hill_slippery", "launch_slippery", "hill_start_25", "hill_wheelspin_25"),
    *("straight_braking_30", "straight_braking_60", "dive", "bend_braking", "bend_braking_van", "lift_off"),
}


@pytest.fixture
def altered(tmp_path: Path) -> Callable[[str, str, str], Path]:
    """Return a copy of a shipped scenario with one text replaced."""

    def alter(name: str, before: str, after: str) -> Path:
        text = (FOLDER / f"{name}.yaml").read_text()
        assert text.count(before) == 1
        path = tmp_path / f"{name}.yaml"
        path.write_text(text.replace(before, after))
        return path

    return alter


def test_all_manoeuvres_are_shipped_and_have_limits() -> None:
    assert {path.stem for path in SHIPPED} == KINDS
    assert all(load_scenario(str(path))[0].limits for path in SHIPPED)


@pytest.mark.parametrize("path", DRIVEN, ids=lambda path: path.stem)
def test_the_default_car_is_inside_all_limits(
    path: Path, checked: Checked, record_property: Callable[[str, object], None]
) -> None:
    """Those that repeat another are driven with --long, in tests/drives/test_shipped_scenarios.py."""
    verdict, limits = checked.scenarios[path], load_scenario(str(path))[0].limits
    assert limits
    limited = {limit.value: verdict["values"].get(limit.value) for limit in limits}
    record_property(path.stem, ", ".join(f"{name} {value:.3g}" for name, value in limited.items() if value is not None))
    assert verdict["passed"], "\n".join(verdict["problems"])


def test_manoeuvres_have_panels_for_a_report(sample: Sample) -> None:
    for path in SHIPPED[sample.of(9, 0) :: sample.of(9, 1)]:
        verdict = check_scenario(str(path))
        assert verdict.result is not None
        assert verdict.result.panels


def test_the_same_drive_gives_the_same_bits_and_values() -> None:
    one, two = (check_scenario(str(FOLDER / "steady_state_circle.yaml")) for _ in range(2))
    assert (one.digest, one.ticks) == (two.digest, two.ticks)
    assert one.result is not None
    assert two.result is not None
    assert one.result.values == two.result.values


def test_without_esc_the_sine_with_dwell_fails(altered: Callable[[str, str, str], Path]) -> None:
    path = altered("sine_with_dwell", "  devices: {driver: none}", "  features: {aids: {stability_control: false}}")
    text = path.read_text().replace("session:\n", "session:\n  devices: {driver: none}\n")
    path.write_text(text.replace("{kind: sine_with_dwell}", "{kind: sine_with_dwell, factors: [6.5]}"))
    verdict = check_scenario(str(path))
    assert not verdict.passed
    assert any(problem.startswith("yaw_rate_ratio_100: ") for problem in verdict.problems)


def test_without_abs_split_friction_turns_the_car(altered: Callable[[str, str, str], Path]) -> None:
    path = altered("split_friction_braking", "session:\n", "session:\n  features: {aids: {anti_lock: false}}\n")
    verdict = check_scenario(str(path))
    assert any(problem.startswith("largest_yaw_angle_deg: ") for problem in verdict.problems)


def test_a_value_beyond_its_limit_fails_and_is_in_the_report(
    altered: Callable[[str, str, str], Path], tmp_path: Path
) -> None:
    path = altered("stall", "end_engine_running, max: 0", "end_engine_running, min: 1")
    done = within("check", path, FOLDER / "launch.yaml", "--report", tmp_path / "report.html", "--json")
    assert done.returncode == 1
    stall, launch = results(done)["scenarios"]
    assert (stall["passed"], launch["passed"]) == (False, True)
    assert stall["problems"] == ["end_engine_running: 0 not in 1 to inf"]
    assert launch["values"]["engine_stalled"] == 0.0
    assert "  end_engine_running         0" in done.stderr
    page = (tmp_path / "report.html").read_text()
    assert page.count("<svg") == 2
    assert "stall: NOT inside its limits" in page
    assert "launch: inside its limits" in page
    assert "<td>engine_stalled</td><td class=n>0</td><td class=n>at most 0</td>" in page


def test_a_value_that_there_is_not_is_one_line(altered: Callable[[str, str, str], Path]) -> None:
    path = altered("stall", "distance_m, max", "distnace_m, max")
    with pytest.raises(ProfileError, match=r"stall\.yaml: limits: value: value distnace_m: one of clutch_over"):
        check_scenario(str(path))


def test_a_car_that_never_gets_fast_enough_is_told(altered: Callable[[str, str, str], Path]) -> None:
    path = altered("step_steer", "speed_kmh: 100", "speed_kmh: 240")
    verdict = check_scenario(str(path))
    assert verdict.problems == ["step steer: the car has not held 240 km/h, where the manoeuvre begins"]


def test_a_watched_script_must_be_there(altered: Callable[[str, str, str], Path]) -> None:
    path = altered("coast_down", "{kind: coast_down, from_kmh: 100, to_kmh: 20}", "{kind: observed}")
    with pytest.raises(ProfileError, match="script: value missing"):
        check_scenario(str(path))
