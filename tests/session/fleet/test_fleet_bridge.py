"""The server of several platforms waits for a controller of each, and says where nobody came."""

from pathlib import Path
from typing import Any

import pytest

from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.session import PlatformSection
from simconsole.session.fleet import fleet_bridge
from simconsole.session.fleet.fleet_drive import drive_fleet
from simconsole.session.fleet.members import members
from simconsole.session.resolution import load_session, override, resolve
from simconsole.values.errors import BridgeError


def test_a_platform_that_nobody_hears_is_an_error_and_leaves_nothing(tmp_path: Path) -> None:
    session = load_session("turtlebot3_team")
    session = override(session, mode={"wait_for_controller_s": 0.05}, outputs={"bridge": {"port": 0}})
    told: list[str] = []
    with pytest.raises(BridgeError, match="not every platform's odometry"):
        drive_fleet(resolve(session), tmp_path / "bundle", on_bridge=told.append)
    assert told
    assert told[0].startswith("ws://127.0.0.1:")
    assert not (tmp_path / "bundle").exists()


def test_one_program_drives_all_cars_of_a_profile(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[tuple[str, list[str]]] = []

    def start(url: str, session: Any, *rest: Any, namespaces: list[str]) -> str:
        started.append((session.scenario.vehicle, namespaces))
        return "program"

    monkeypatch.setattr(fleet_bridge, "start_autopilot", start)
    vans = {"c": "light_van"}
    platforms = tuple(PlatformSection(name=name, vehicle=vans.get(name), autopilot=name != "d") for name in "abcde")
    session = override(
        load_session("demo"),
        scenario={"platforms": platforms},
        environment={"traffic": None},
        devices={"driver": "none", "person": None},
        outputs={"bridge": BridgeProfile(), "hud": None, "scene": None, "report": False},
    )
    programs: list[Any] = []
    fleet_bridge._start_autopilots(list(members(resolve(session)).values()), "ws://127.0.0.1:9", "nonce", programs)
    assert started == [("hatchback", ["/a", "/b", "/e"]), ("light_van", ["/c"])]
    assert programs == ["program", "program"]
