"""The session: which names and files it may reach, and bounds that are refused by key and value."""

import pytest

from simconsole.profiles.files.loader import parse
from simconsole.profiles.session import Devices, Environment, FrictionPatch, Scenario, SessionProfile
from tests.profiles.refused import refusal


@pytest.mark.parametrize("name", ["../secret", "a/b", ".hidden", "", "x" * 65, "a b"])
def test_a_name_reaches_no_file_outside_the_profiles(name: str) -> None:
    assert "world: " in refusal(f"schema: 1\nenvironment: {{world: '{name}'}}\n", SessionProfile)
    assert "cockpit: " in refusal(f"schema: 1\ndevices: {{cockpit: '{name}'}}\n", SessionProfile)


@pytest.mark.parametrize(
    ("vehicle", "good"), [("ball", True), ("own/car.yaml", True), ("car.yml", True), ("a/b", False)]
)
def test_a_vehicle_is_a_name_or_a_yaml_file(vehicle: str, good: bool) -> None:
    text = f"vehicle: '{vehicle}'\n"
    if good:
        assert parse(text, Scenario, "f.yaml").vehicle == vehicle
    else:
        assert 'vehicle: value "a/b": ' in refusal(text, Scenario)


@pytest.mark.parametrize("driver", ["none", "sdl", "keyboard", "virtual", "trace:a.csv", "script:b.yaml"])
def test_drivers(driver: str) -> None:
    assert parse(f"driver: '{driver}'", Devices, "f.yaml").driver == driver


@pytest.mark.parametrize("driver", ["nobody", "sdl:0", "trace", "trace:", "script:", "Keyboard"])
def test_drivers_that_there_are_not(driver: str) -> None:
    assert f'driver: value "{driver}": ' in refusal(f"driver: '{driver}'", Devices)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("friction: 0", "friction: value 0: "),
        ("friction_right_share: 1.1", "friction_right_share: value 1.1: "),
        ("slope_x_percent: 41", "slope_x_percent: value 41: "),
        ("wind_to_deg: 181", "wind_to_deg: value 181: "),
        ("wind_mps: -1", "wind_mps: value -1: "),
        ("friction: .nan", "finite"),
        ("world_name: urban", "unknown key"),
    ],
)
def test_ground_and_wind_out_of_bounds_are_refused(text: str, told: str) -> None:
    assert told in refusal(text, Environment)


def test_more_than_four_patches_are_refused() -> None:
    patch = "{from_x_m: 0, to_x_m: 1, from_y_m: 0, to_y_m: 1, friction_share: 0.5}"
    four = parse(f"friction_patches: [{', '.join([patch] * 4)}]", Environment, "f.yaml")
    assert four.friction_patches == (FrictionPatch(from_x_m=0, to_x_m=1, from_y_m=0, to_y_m=1, friction_share=0.5),) * 4
    assert "friction_patches: " in refusal(f"friction_patches: [{', '.join([patch] * 5)}]", Environment)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("mode: {tick_hz: 300}", "mode.tick_hz: value 300: one of "),
        ("mode: {pacing: slow}", 'mode.pacing: value "slow": one of '),
        ("mode: {control_period_ms: 0}", "mode.control_period_ms: value 0: "),
        ("scenario: {duration_s: 0}", "scenario.duration_s: value 0: "),
        ("scenario: {start: {yaw_deg: 181}}", "scenario.start.yaw_deg: value 181: "),
        ("features: {commander: both}", 'features.commander: value "both": one of '),
    ],
)
def test_a_session_out_of_bounds_is_refused(text: str, told: str) -> None:
    assert told in refusal(f"schema: 1\n{text}\n", SessionProfile)


def test_another_schema_than_the_first_is_refused() -> None:
    assert "schema: value 2: " in refusal("schema: 2", SessionProfile)
    assert "schema: " in refusal("title: without", SessionProfile)
