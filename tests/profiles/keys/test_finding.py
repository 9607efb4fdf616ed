"""Keys are found by a path, its end, or some of its names."""

import pytest

from simconsole.profiles.keys.finding import find_keys, keys_below, places, top_keys
from simconsole.values.errors import ProfileError


@pytest.mark.parametrize(
    ("asked", "found"),
    [
        ("steering.ratio", ["vehicle.steering.ratio"]),
        ("session.vehicle", ["session.scenario.vehicle", "session.scenario.platforms[].vehicle"]),
        ("scenario.faults.at_s", ["session.scenario.faults[].at_s"]),
        ("scenario.faults[0].raw", ["session.scenario.faults[].raw"]),
        ("provenance.status", ["cockpit.provenance{}.status"]),
        ("session.title", ["session.title"]),
        ("tick_hz", ["session.mode.tick_hz"]),
    ],
)
def test_a_key_is_found(asked: str, found: list[str]) -> None:
    assert [key.path for key in find_keys(asked)] == found


def test_a_name_of_several_keys_finds_all() -> None:
    paths = [key.path for key in find_keys("s_m")]
    assert "world.path[].s_m" in paths
    assert "world.roundabouts[].s_m" in paths


@pytest.mark.parametrize(
    ("asked", "guess"),
    [
        ("ratoi", "did you mean ratio?"),
        ("stering.ratio", "did you mean vehicle.steering.ratio?"),
        ("sesion", "did you mean session?"),
        ("qqqqqq", "a key, or one of session, scenario, "),
        ("", "a key, or one of session, scenario, "),
        ("..", "a key, or one of session, scenario, "),
    ],
)
def test_a_key_that_is_none_gets_a_guess(asked: str, guess: str) -> None:
    with pytest.raises(ProfileError, match="command line: KEY: value ") as refused:
        find_keys(asked)
    assert guess in str(refused.value)


def test_a_key_of_several_places_names_them() -> None:
    (key,) = find_keys("tick_hz")
    assert places(key) == ["session.mode.tick_hz", "scenario.session.mode.tick_hz"]


def test_a_section_has_keys_below() -> None:
    (key,) = find_keys("session.mode")
    assert [one.name for one in keys_below(key)][:2] == ["tick_hz", "pacing"]
    assert [one.name for one in top_keys("script")] == ["schema", "title", "points"]
