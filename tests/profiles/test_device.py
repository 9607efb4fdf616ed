"""Cockpit profiles: what is refused, and that every line of a shipped one says where it comes from."""

from typing import Any

import msgspec
import pytest
from msgspec.structs import replace

from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load, parse, profiles_folder, to_text
from simconsole.profiles.parts.axes import SteeringAssistance
from simconsole.values.errors import ProfileError

COCKPITS = ["t500rs_th8rs", "t300rs_th8a", "g29", "gamepad", "keyboard"]


@pytest.fixture(scope="module")
def t500() -> CockpitProfile:
    return load("devices", "t500rs_th8rs", CockpitProfile)


def test_every_shipped_cockpit_is_tested() -> None:
    shipped = {path.stem for path in (profiles_folder() / "devices").glob("*.yaml")}
    assert set(COCKPITS) == shipped


def leaves(value: Any, path: str = "") -> list[str]:
    if isinstance(value, list) and value and isinstance(value[0], dict):
        value = {str(index): inner for index, inner in enumerate(value)}
    if isinstance(value, dict):
        return [leaf for key, inner in value.items() for leaf in leaves(inner, f"{path}.{key}" if path else key)]
    return [] if value is None else [path]


def changed(profile: CockpitProfile, path: str, value: Any) -> str:
    plain = msgspec.to_builtins(profile)
    *steps, last = path.split(".")
    place = plain
    for step in steps:
        place = place[int(step)] if isinstance(place, list) else place[step]
    if isinstance(place, list):
        place[int(last)] = value
    else:
        place[last] = value
    return to_text(plain)


@pytest.mark.parametrize("name", COCKPITS)
def test_every_value_that_describes_hardware_has_a_provenance(name: str) -> None:
    profile = load("devices", name, CockpitProfile)
    plain = msgspec.to_builtins(profile)
    facts = {key: plain[key] for key in ("roles", "boot_modes", "wheel", "pedals", "shifter", "buttons") if plain[key]}
    for leaf in leaves(facts):
        steps = leaf.split(".")
        prefixes = {".".join(steps[:count]) for count in range(1, len(steps) + 1)}
        assert prefixes & profile.provenance.keys(), leaf
    paths = [leaf.split(".") for leaf in leaves(plain)]
    known = {".".join(steps[:count]) for steps in paths for count in range(1, len(leaf) + 1)}
    assert profile.provenance.keys() <= known


@pytest.mark.parametrize("name", COCKPITS)
def test_every_source_says_where_it_comes_from(name: str) -> None:
    for key, origin in load("devices", name, CockpitProfile).provenance.items():
        assert len(origin.source) >= 8, key


def test_what_nobody_has_measured_is_marked_unverified() -> None:
    provenance = load("devices", "t500rs_th8rs", CockpitProfile).provenance
    assert provenance["buttons"].status == "unverified"
    assert provenance["pedals.brake.rest_raw"].status == "unverified"


def test_a_button_is_called_by_its_label(t500: CockpitProfile) -> None:
    assert (t500.button_label("manual"), t500.button_label("reset"), t500.button_label("hazard")) == (
        "cross",
        "R2",
        "hat up",
    )
    assert t500.button_label("handbrake_button") == ""
    assert load("devices", "g29", CockpitProfile).button_label("manual") == "button 2"
    assert load("devices", "keyboard", CockpitProfile).button_label("manual") == "button 1"


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("roles.0.button_labels", ["x" * 17], "16"),
        ("pedals.throttle.full_raw", 1.0, "at least 0.2 apart"),
        ("pedals.brake.rest_raw", -1.5, "-1 to 1"),
        ("pedals.clutch.axis", 4, "pedals.clutch.axis 4 must be below 4"),
        ("wheel.axis", 9, "wheel.axis 9 must be below 4"),
        ("wheel.lock_to_lock_deg", 0.0, "40 to 2520"),
        ("wheel.grows_to", "up", "left, right"),
        ("shifter.gears.0", 1, "different buttons"),
        ("shifter.gears", [], "at least one button"),
        ("shifter.reverse", 10, "must be below 10"),
        ("buttons.reset.button", 13, "buttons.reset.button 13 must be below 13"),
        ("buttons.reset", {"hat": "up", "button": 3}, "button or hat must be given, and not both"),
        ("buttons.reset", {"on": "wheel"}, "button or hat must be given, and not both"),
        ("buttons.reset", {"hat": "up", "on": "shifter"}, "on must be wheel where hat is given"),
        ("roles.0.hats", 0, "buttons.fault.hat must not be given"),
        ("roles", [], None),
        ("roles.0.others", [{"vendor_id": 1, "product_id": 2, "name": "x", "axes": 9, "buttons": 9}], "only a shifter"),
        ("limits.stale_s", 0.0, "limits.stale_s"),
        ("pedals.throtle", {}, "did you mean"),
    ],
)
def test_profile_that_cannot_be_meant_is_refused(path: str, value: Any, message: str | None, t500: Any) -> None:
    text = changed(t500, path, value)
    if message is None:
        parse(text, CockpitProfile, "cockpit.yaml")
        return
    with pytest.raises(ProfileError) as caught:
        parse(text, CockpitProfile, "cockpit.yaml")
    assert message in str(caught.value)
    assert str(caught.value).startswith("cockpit.yaml: ")
    assert "\n" not in str(caught.value)


def test_role_bound_twice_is_refused(t500: CockpitProfile) -> None:
    twice = msgspec.to_builtins(t500.roles[0])
    with pytest.raises(ProfileError, match="once each"):
        parse(changed(t500, "roles.1", twice), CockpitProfile, "cockpit.yaml")


def test_more_meanings_than_a_state_vector_holds_are_refused(t500: CockpitProfile) -> None:
    plain = msgspec.to_builtins(t500)
    for role in plain["roles"]:
        role["buttons"] = 40
    names = list(plain["buttons"])
    plain["shifter"] |= {"on": "wheel", "gears": list(range(17, 24)), "reverse": 24}
    plain["buttons"] = {name: {"button": at} for at, name in enumerate(names)}
    with pytest.raises(ProfileError, match=r"buttons: 25 of the wheel have a meaning, must be at most 24"):
        parse(to_text(plain), CockpitProfile, "cockpit.yaml")
    del plain["buttons"][names[0]]
    parse(to_text(plain), CockpitProfile, "cockpit.yaml")


def test_a_wheel_with_a_motor_is_not_assisted(t500: CockpitProfile) -> None:
    with pytest.raises(ValueError, match=r"wheel\.assistance must not be given"):
        replace(t500, wheel=replace(t500.wheel, assistance=SteeringAssistance()))
