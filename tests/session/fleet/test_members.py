"""A session of several platforms, taken apart: names, starts, errors; and what it cannot have."""

from pathlib import Path
from typing import Any

import msgspec
import pytest

from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load, to_text
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.validation import convert
from simconsole.session.fleet.members import members
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.values.errors import ProfileError


def team(**changes: dict[str, Any]) -> SessionProfile:
    return override(load_session("turtlebot3_team"), **changes)


def test_each_has_its_namespace_start_and_errors() -> None:
    parts = list(members(resolve(team())).values())
    bridges = [part.session.outputs.bridge for part in parts]
    assert [bridge.namespace for bridge in bridges if bridge] == ["/tb3_0", "/tb3_1", "/tb3_2"]
    assert len({bridge.link.seed for bridge in bridges if bridge}) == 3
    starts = [part.session.scenario.start for part in parts]
    assert [(start.x_m, start.y_m) for start in starts if start] == [(0.8, 0.8), (0.8, 1.8), (1.9, 0.8)]
    assert len({part.vehicle.odometry.seed for part in parts}) == 3  # type: ignore[union-attr]
    assert all(part.fleet == () for part in parts)


def test_a_start_is_taken_by_name_and_else_by_number() -> None:
    named = [{"name": "tb3_2"}, {"name": "other"}, {"name": "mine", "start": {"x_m": 4.0, "y_m": 2.0}}]
    starts = [part.session.scenario.start for part in members(resolve(team(scenario={"platforms": named}))).values()]
    assert [(start.x_m, start.y_m) for start in starts if start] == [(1.9, 0.8), (0.8, 1.8), (4.0, 2.0)]


def test_platforms_may_be_of_different_kinds() -> None:
    mixed = [{"name": "a"}, {"name": "b", "vehicle": "turtlebot3_waffle"}]
    parts = list(members(resolve(team(scenario={"platforms": mixed}))).values())
    assert [part.vehicle.wheel_separation_m for part in parts] == [0.16, 0.287]  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"mode": {"pacing": "realtime"}, "features": {"speed_advice": True}}, "features.speed_advice: false"),
        ({"mode": {"start": "on_request"}}, "mode.start: at_once"),
        ({"environment": {"traffic": {}}}, "environment.traffic: value given: none, or sumo"),
        ({"environment": {"traffic": {"sumo": {}}}}, "tb3_0: vehicle: no robot"),
        ({"outputs": {"bridge": None}}, "outputs.bridge"),
        ({"environment": {"world": None}}, "tb3_0: start: value missing: the session has no world"),
        ({"scenario": {"platforms": [{"name": f"r{number}"} for number in range(4)]}}, "r3: start: value missing"),
    ],
)
def test_what_several_platforms_cannot_have_is_refused(changes: dict[str, Any], said: str) -> None:
    with pytest.raises(ProfileError, match=said):
        members(resolve(team(**changes)))


def test_by_the_clock_each_window_is_whose_it_is() -> None:
    window = {"width_px": 640, "language": "german"}
    named = [{"name": "a"}, {"name": "b", "hud": window, "cockpit": "g29"}, {"name": "c"}]
    changes: dict[str, Any] = {
        "outputs": {"hud": {"width_px": 1000}},
        "mode": {"pacing": "realtime"},
        "scenario": {"platforms": named},
    }
    parts = members(resolve(team(**changes)))
    huds = [part.session.outputs.hud for part in parts.values()]
    assert [hud and hud.width_px for hud in huds] == [1000, 640, None]
    languages = [part.language.title for part in parts.values()]
    assert languages[0] == languages[2] != languages[1]
    assert parts["b"].cockpit.title == load("devices", "g29", CockpitProfile).title != parts["a"].cockpit.title
    assert [part.session.outputs.scene is None for part in parts.values()] == [False, True, True]


@pytest.mark.parametrize(
    ("cockpits", "ports", "refused"),
    [
        (("g29", "t500rs_th8rs"), ("", ""), False),
        (("g29", "g29"), ("", ""), True),
        (("g29", "g29"), ("1-2", ""), True),
        (("g29", "g29"), ("1-2", "1-3"), False),
    ],
)
def test_two_persons_do_not_sit_at_one_wheel(
    cockpits: tuple[str, str], ports: tuple[str, str], refused: bool, tmp_path: Path
) -> None:
    named = []
    for number, (cockpit, port) in enumerate(zip(cockpits, ports, strict=True)):
        profile = load("devices", cockpit, CockpitProfile)
        roles = [msgspec.structs.replace(role, port=port) for role in profile.roles]
        path = tmp_path / f"cockpit_{number}.yaml"
        path.write_text(to_text(msgspec.structs.replace(profile, roles=roles)))
        named.append({"name": f"r{number}", "driver": "sdl", "cockpit": str(path)})
    resolved = resolve(team(scenario={"platforms": named}))
    if refused:
        with pytest.raises(ProfileError, match="r1: cockpit: role wheel: value 046d:c24f: a device of its own"):
            members(resolved)
    else:
        assert [part.session.devices.driver for part in members(resolved).values()] == ["sdl", "sdl"]


def test_a_name_stands_once() -> None:
    plain = {"schema": 1, "scenario": {"platforms": [{"name": "a"}, {"name": "a"}]}}
    with pytest.raises(ProfileError, match="a name twice"):
        convert(plain, SessionProfile, "test")


def test_the_drive_of_one_platform_refuses_several(tmp_path: Any) -> None:
    with pytest.raises(ProfileError, match=r"scenario\.platforms"):
        drive(resolve(team()), tmp_path / "bundle")
