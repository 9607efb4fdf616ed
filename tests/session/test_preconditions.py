import errno
import re
import socket
from pathlib import Path

import pytest
import yaml

from simconsole.bridge.transport import sockets
from simconsole.cli.main import main
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.session import SessionProfile
from simconsole.session.preconditions import check_address, check_session, check_world
from simconsole.session.resolution import load_session, override, resolve
from simconsole.values.errors import ProfileError


@pytest.fixture
def session() -> SessionProfile:
    return load_session("can")


def test_shipped_session_can_be_driven(session: SessionProfile) -> None:
    assert session.features.commander == "can"
    check_session(session)  # it raises where the commander has no way in
    check_session(load_session("demo"))


@pytest.mark.parametrize("vehicle", ["hatchback", "ball"])
def test_only_robots_are_let_into_an_arena(vehicle: str) -> None:
    robot = load_session("turtlebot3_burger")
    check_world(resolve(robot))
    other = override(robot, scenario={"vehicle": vehicle, "start": None})
    told = rf"environment\.world: value arena: .* where scenario\.vehicle is {vehicle}: an arena's walls"
    with pytest.raises(ProfileError, match=told):
        check_world(resolve(other))
    check_world(resolve(override(other, environment={"world": "urban"})))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"outputs": {"can": None}}, r"features\.commander: value can: needs outputs\.can"),
        ({"mode": {"pacing": "lockstep"}}, r"mode\.pacing: value lockstep"),
    ],
)
def test_commander_with_no_way_in_is_refused(
    session: SessionProfile, changes: dict[str, dict[str, object]], words: str
) -> None:
    with pytest.raises(ProfileError, match=words):
        check_session(override(session, **changes))


@pytest.mark.parametrize(
    "changes",
    [
        {"mode": {"pacing": "realtime"}},
        {"mode": {"pacing": "lockstep"}},
        {"mode": {"pacing": "free"}, "features": {"commands": "bag:drive.mcap", "autopilot": "urban"}},
    ],
)
def test_a_bag_commands_only_where_no_other_controller_is_waited_for(changes: dict[str, dict[str, object]]) -> None:
    session = override(load_session("seated"), features={"commands": "bag:drive.mcap"})
    check_session(override(session, mode={"pacing": "free"}))
    with pytest.raises(ProfileError, match=r"features\.commands: value bag:drive\.mcap: mode\.pacing free"):
        check_session(override(session, **changes))


def test_an_autopilot_needs_a_pace_unless_own_code_commands() -> None:
    session = override(load_session("demo"), mode={"pacing": "free"})
    with pytest.raises(ProfileError, match=r"free \(with --headless realtime becomes free\): lockstep or realtime"):
        check_session(session)
    check_session(session, has_controller=True)


def test_a_client_that_comes_while_the_port_is_checked_is_not_let_in(monkeypatch: pytest.MonkeyPatch) -> None:
    answers: list[int] = []
    take = sockets.bind

    def visited(host: str, port: int) -> socket.socket:
        """Return the socket of the check, after a client has tried to come in."""
        taken = take(host, port)
        with socket.socket() as client:
            answers.append(client.connect_ex(taken.getsockname()))
        return taken

    monkeypatch.setattr(sockets, "bind", visited)
    check_address(BridgeProfile(port=0))
    assert answers == [errno.ECONNREFUSED]


@pytest.mark.parametrize(
    ("bridge", "words"),
    [
        ({"upstream": {"url": "ws://robot:9090"}}, r"value free .*: realtime, where outputs\.bridge\.upstream"),
        ({"ros2": {}}, r"value free .*: lockstep or realtime, where outputs\.bridge\.ros2"),
    ],
)
def test_links_that_a_drive_without_a_bridge_has_not_are_refused(
    bridge: dict[str, object], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "session.yaml"
    outputs = {"bridge": bridge, "hud": None, "scene": None, "report": False}
    told = {"schema": 1, "outputs": outputs, "devices": {"driver": "none"}, "mode": {"pacing": "free"}}
    path.write_text(yaml.safe_dump(told))
    assert main(["drive", str(path), "--headless", "--for", "1", "--out", str(tmp_path / "bundle")]) == 2
    assert re.search(rf"mode\.pacing: {words}", capsys.readouterr().err)
