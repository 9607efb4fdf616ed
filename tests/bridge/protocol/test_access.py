import hashlib
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.protocol.access import OPEN, WRONG_TOKENS_PER_S, Access, Role, message_limit, read_tokens
from simconsole.bridge.protocol.operations import Auth
from simconsole.profiles.bridge import BridgeLimits, BridgeProfile
from simconsole.values.errors import ProfileError, RemoteProtocolError

TOKENS = {"v" * 16: Role.VIEW, "p" * 16: Role.PUBLISH, "ü" * 16: Role.CONTROL}
CHATTER = {"topic": "/chatter", "type": "std_msgs/String"}


def mac(token: str, **fields: Any) -> Auth:
    """What rosauth's clients send: SHA-512 over the secret and the fields."""
    auth = Auth(client="me", dest="car", rand="r", t=5, level="admin", end=9)
    for name in ("t", "rand", "end"):
        setattr(auth, name, fields.pop(f"signed_{name}", getattr(auth, name)))
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
    other = mac(token, signed_rand="s")
    other.mac = other.mac.upper()
    assert access.admit(other) is role


@pytest.mark.parametrize(
    ("signed", "now_s", "complaint"),
    [
        ({"signed_t": 1000, "signed_end": 2000}, 1005.0, None),
        ({"signed_t": 1000, "signed_end": 2000}, 995.0, None),
        ({"signed_t": 1000, "signed_end": 2000}, 1005.1, "t is not within 5 s"),
        ({"signed_t": 1000, "signed_end": 2000}, 994.9, "t is not within 5 s"),
        ({"signed_t": 1000, "signed_end": 1001}, 1001.0, "end is over"),
        ({"signed_t": 1000, "signed_end": 0}, 1000.0, "end is over"),
    ],
)
def test_times_of_a_mac_are_checked(signed: dict[str, int], now_s: float, complaint: str | None) -> None:
    access, auth = Access(TOKENS, Role.NONE, lambda: now_s), mac("v" * 16, **signed)
    if complaint is None:
        assert access.admit(auth) is Role.VIEW
        return
    with pytest.raises(RemoteProtocolError, match=complaint):
        access.admit(auth)


def test_mac_is_good_once() -> None:
    clock = [5.0]
    access = Access(TOKENS, Role.NONE, lambda: clock[0])
    access.admit(mac("v" * 16))
    for clock[0] in (5.0, 8.0):
        with pytest.raises(RemoteProtocolError, match="shown before"):
            access.admit(mac("v" * 16))
    upper = mac("v" * 16)
    upper.mac = upper.mac.upper()
    with pytest.raises(RemoteProtocolError, match="shown before"):
        access.admit(upper)
    assert access.admit(mac("v" * 16, signed_rand="another")) is Role.VIEW


def test_wrong_tokens_are_looked_at_a_hundred_times_a_second() -> None:
    clock = [0.0]
    access = Access(TOKENS, Role.NONE, lambda: clock[0])
    for _ in range(WRONG_TOKENS_PER_S):
        with pytest.raises(RemoteProtocolError, match="not a token"):
            access.role_of("x")
    with pytest.raises(RemoteProtocolError, match="too many wrong tokens"):
        access.role_of("v" * 16)
    clock[0] = 1.0
    assert access.role_of("v" * 16) is Role.VIEW


def test_one_connection_may_try_five_wrong_tokens(join: Callable[..., Any]) -> None:
    bridge = ConsoleBridge(BridgeProfile(port=0))
    bridge.router.access = Access(TOKENS, Role.NONE)
    peer = join(bridge)
    peer.session.has_token = False
    for _ in range(5):
        peer.send(op="auth", token="x" * 16)
    peer.send(op="auth", token="v" * 16)
    told = peer.statuses()
    assert ["not a token" in text for text in told] == [True] * 5 + [False]
    assert "too many wrong tokens: connect anew" in told[5]
    assert not peer.session.has_token
    again = join(bridge)
    again.send(op="auth", token="v" * 16)
    assert (again.session.role, again.session.has_token) == (Role.VIEW, True)


@pytest.mark.parametrize(("role", "most"), [(Role.NONE, 2000), (Role.VIEW, 2000), (Role.PUBLISH, 9000)])
def test_length_of_messages_by_role(role: Role, most: int) -> None:
    assert message_limit(role, BridgeLimits(message_bytes=9000, viewer_message_bytes=2000)) == most
    assert message_limit(role, BridgeLimits(message_bytes=1500)) == 1500


@pytest.mark.parametrize(
    "auth",
    [
        Auth(end=9),
        Auth(token="x"),
        Auth(mac="x", end=9),
        mac("v" * 15),
        mac("v" * 16, end=10),
        mac("v" * 16, level="x"),
    ],
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
