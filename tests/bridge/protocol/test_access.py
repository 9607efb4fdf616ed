import hashlib
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.protocol.access import OPEN, Access, Role, read_tokens
from simconsole.bridge.protocol.operations import Auth
from simconsole.values.errors import ProfileError, RemoteProtocolError

TOKENS = {"v" * 16: Role.VIEW, "p" * 16: Role.PUBLISH, "ü" * 16: Role.CONTROL}
CHATTER = {"topic": "/chatter", "type": "std_msgs/String"}


def mac(token: str, **fields: Any) -> Auth:
    """What rosauth's clients send: SHA-512 over the secret and the fields."""
    auth = Auth(client="me", dest="car", rand="r", t=5, level="admin", end=9)
    text = f"{token}{auth.client}{auth.dest}{auth.rand}{auth.t}{auth.level}{auth.end}"
    auth.mac = hashlib.sha512(text.encode()).hexdigest()
    for name, value in fields.items():
        setattr(auth, name, value)
    return auth


@pytest.mark.parametrize(("token", "role"), TOKENS.items())
def test_roles_of_tokens(token: str, role: Role) -> None:
    access = Access(TOKENS, Role.NONE)
    assert access.role_of(token) is role
    assert access.admit(Auth(token=token)) is role
    assert access.admit(mac(token)) is role
    assert access.admit(mac(token, mac=mac(token).mac.upper())) is role


@pytest.mark.parametrize(
    "auth", [Auth(), Auth(token="x"), Auth(mac="x"), mac("v" * 15), mac("v" * 16, end=10), mac("v" * 16, level="x")]
)
def test_what_shows_no_token(auth: Auth) -> None:
    with pytest.raises(RemoteProtocolError, match="not a token"):
        Access(TOKENS, Role.NONE).admit(auth)


def test_server_without_tokens_lets_everyone_do_everything() -> None:
    assert OPEN.anonymous is Role.CONTROL
    assert OPEN.admit(mac("anything")) is Role.CONTROL
    assert OPEN.admit(Auth(token="anything")) is Role.CONTROL


def test_file_of_tokens() -> None:
    text = f"# ours\n\nview {'a' * 16}\n  control {'b' * 16} # the autopilot\n"
    assert read_tokens(text, "f") == {"a" * 16: Role.VIEW, "b" * 16: Role.CONTROL}


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "f: no token in it"),
        ("owner " + "a" * 16, "line 1: expected a role"),
        ("view", "line 1: expected a role"),
        ("\nview short", "line 2: a token has at least 16"),
        (f"view {'a' * 16}\ncontrol {'a' * 16}", "line 2: .*stands once"),
        ("none " + "a" * 16, "expected a role"),
    ],
)
def test_bad_file_of_tokens(text: str, complaint: str) -> None:
    with pytest.raises(ProfileError, match=complaint):
        read_tokens(text, "f")


@pytest.fixture
def client(bridge: ConsoleBridge, join: Callable[..., Any]) -> Callable[[Role], Any]:
    def make(role: Role) -> Any:
        bridge.router.access = Access(TOKENS, role)
        return join(bridge)

    return make


@pytest.mark.parametrize("role", Role)
def test_each_role_may_do_its_part_and_no_more(
    client: Callable[[Role], Any], control: Callable[..., Any], role: Role
) -> None:
    peer = client(role)
    asked: dict[Role, list[dict[str, Any]]] = {
        Role.NONE: [{"op": "set_level", "level": "error"}],
        Role.VIEW: [{"op": "subscribe", "topic": "/odom"}, {"op": "unsubscribe", "topic": "/odom"}],
        Role.PUBLISH: [
            {"op": "advertise", **CHATTER},
            {"op": "publish", "topic": "/chatter", "msg": {}},
            {"op": "advertise_service", "service": "/s", "type": "std_srvs/Empty"},
        ],
        Role.CONTROL: [
            {"op": "publish", "topic": "/control/command/control_cmd", "msg": control()},
            {"op": "publish", "topic": "/console/request", "msg": {"data": "estop"}},
        ],
    }
    for needed, operations in asked.items():
        for operation in operations:
            outcome = peer.send(**operation)
            assert (outcome.kind != "refused") is (role >= needed), (operation, outcome)
            assert role >= needed or "this needs the role " in outcome.text
    assert peer.bridge.inputs.command.refused == 0.0


def test_role_grows_with_authentication(client: Callable[[Role], Any]) -> None:
    peer = client(Role.NONE)
    assert peer.send(op="subscribe", topic="/odom").kind == "refused"
    assert peer.send(op="auth", token="wrong", id="a").kind == "refused"
    assert peer.send(op="auth", token="v" * 16).kind == "done"
    assert peer.send(op="subscribe", topic="/odom").kind == "done"
    peer.heard()
    assert peer.send(op="call_service", service="/any").kind == "done"
    assert "role publish" in peer.heard()[0]["values"]
    auth = mac("ü" * 16)
    fields = {name: getattr(auth, name) for name in ("mac", "client", "dest", "rand", "t", "level", "end")}
    assert peer.send(op="auth", **fields).kind == "done"
    assert peer.session.role is Role.CONTROL


def test_service_of_the_console_for_some(client: Callable[[Role], Any]) -> None:
    viewer = client(Role.VIEW)
    viewer.bridge.router.calls.add_builtin("/set", "std_srvs/Empty", lambda args, dialect: {}, Role.CONTROL)
    viewer.bridge.router.calls.add_builtin("/get", "std_srvs/Empty", lambda args, dialect: {})
    for service in ("/set", "/get"):
        viewer.send(op="call_service", service=service)
    assert [answer["result"] for answer in viewer.heard()] == [False, True]
