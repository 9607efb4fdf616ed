"""A session of several platforms, taken apart: names, starts, errors; and what it cannot have."""

from typing import Any

import pytest

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
        ({"mode": {"pacing": "realtime"}}, "mode.pacing: lockstep"),
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


def test_a_name_stands_once() -> None:
    plain = {"schema": 1, "scenario": {"platforms": [{"name": "a"}, {"name": "a"}]}}
    with pytest.raises(ProfileError, match="a name twice"):
        convert(plain, SessionProfile, "test")


def test_the_drive_of_one_platform_refuses_several(tmp_path: Any) -> None:
    with pytest.raises(ProfileError, match=r"scenario\.platforms"):
        drive(resolve(team()), tmp_path / "bundle")
