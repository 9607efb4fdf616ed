"""The server of several platforms waits for a controller of each, and says where nobody came."""

from pathlib import Path

import pytest

from simconsole.session.fleet.fleet_drive import drive_fleet
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
