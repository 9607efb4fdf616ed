import json
from typing import Any

import pytest

from simconsole import __version__
from simconsole.bridge.protocol.access import OPEN, Access, Role
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.handshake import (
    DRIVE_HEADER,
    Admission,
    HandshakeRequest,
    Places,
    Refusal,
    admit,
    check_exposure,
    dialect_of,
    handshake_request,
    is_host_allowed,
    is_origin_allowed,
    places,
    tokens_at,
)
from simconsole.profiles.bridge import BridgeLimits, BridgeProfile
from simconsole.values.errors import ProfileError


@pytest.mark.parametrize("origin", [None, "http://localhost:8080", "https://127.0.0.1", "http://[::1]:1"])
def test_programs_and_pages_of_this_machine_may_connect(origin: str | None) -> None:
    assert is_origin_allowed([] if origin is None else [origin], BridgeProfile())


@pytest.mark.parametrize(
    "origin", ["null", "", "http://evil.example", "http://localhost.evil.example", "file://", "http://localhost:80/x"]
)
def test_other_pages_may_not(origin: str) -> None:
    assert not is_origin_allowed([origin], BridgeProfile())


def test_who_names_two_origins_has_none() -> None:
    assert not is_origin_allowed(["http://localhost", "http://localhost"], BridgeProfile())


def test_page_that_the_profile_names_may() -> None:
    profile = BridgeProfile(allowed_origins=("https://lab.example",))
    assert is_origin_allowed(["https://lab.example"], profile)
    assert not is_origin_allowed(["https://lab.example.evil"], profile)


@pytest.mark.parametrize(
    "host", ["127.0.0.1:9090", "localhost", "LOCALHOST:1", "[::1]:9090", "10.0.0.5:80", "rig:9090"]
)
def test_own_names_are_answered(host: str) -> None:
    assert is_host_allowed(host, BridgeProfile(host="10.0.0.5", allowed_hosts=("rig",)))


@pytest.mark.parametrize("host", ["", "evil.example", "evil.example:9090", "127.0.0.1.evil.example", "localhost:x"])
def test_other_names_are_not(host: str) -> None:
    assert not is_host_allowed(host, BridgeProfile())


def test_address_of_version_6_is_written_in_brackets() -> None:
    assert is_host_allowed("[fe80::1]:9090", BridgeProfile(host="fe80::1"))


@pytest.mark.parametrize(
    ("path", "dialect"), [("/", "ros2"), ("/ros1", "ros1"), ("/ros1/?x=1", "ros1"), ("/ros12", "ros2"), ("", "ros2")]
)
def test_dialect_of_a_path(path: str, dialect: str) -> None:
    assert dialect_of(path, BridgeProfile()) == dialect


def test_dialect_of_the_profile_is_for_who_does_not_say() -> None:
    profile = BridgeProfile(dialect="ros1")
    assert [dialect_of(path, profile) for path in ("/", "/ros1", "/ros2")] == ["ros1", "ros1", "ros2"]


ACCESS = Access({"v" * 16: Role.VIEW, "c" * 16: Role.CONTROL}, Role.NONE)


@pytest.mark.parametrize(
    ("path", "header", "role"),
    [
        ("/", None, Role.NONE),
        ("/", "Basic abc", Role.NONE),
        ("/", "Bearer " + "c" * 16, Role.CONTROL),
        ("/ros1?token=" + "v" * 16, None, Role.VIEW),
        ("/?token=" + "v" * 16, "bearer " + "c" * 16, Role.CONTROL),
    ],
)
def test_role_from_the_first_request_on(path: str, header: str | None, role: Role) -> None:
    request = HandshakeRequest(path, ["localhost"], [], [] if header is None else [header])
    admission = admit(request, BridgeProfile(), ACCESS, Places())
    assert isinstance(admission, Admission)
    assert admission.role is role
    assert admission.has_token is bool(tokens_at(path, header))


@pytest.mark.parametrize(("path", "header"), [("/?token=x", None), ("/", "Bearer x"), ("/", "Bearer ")])
def test_wrong_token_is_refused_at_the_handshake(path: str, header: str | None) -> None:
    request = HandshakeRequest(path, ["localhost"], [], [] if header is None else [header])
    refusal = admit(request, BridgeProfile(), ACCESS, Places())
    assert isinstance(refusal, Refusal)
    assert refusal.status == 401
    assert "not a token" in refusal.reason


@pytest.mark.parametrize(
    ("given", "room", "is_let_in"),
    [
        ({"path": "/"}, Places(is_full=True), True),
        ({"path": "/"}, Places(is_full_without_token=True), False),
        ({}, Places(is_full=True), False),
        ({}, Places(is_full_without_token=True), True),
    ],
)
def test_who_shows_no_token_has_places_of_its_own(given: dict[str, Any], room: Places, is_let_in: bool) -> None:
    decision = admit(REQUEST._replace(**given), BridgeProfile(), ACCESS, room)
    assert isinstance(decision, Admission) is is_let_in


def test_where_no_tokens_are_asked_for_all_places_are_alike() -> None:
    asked = REQUEST._replace(path="/")
    assert isinstance(admit(asked, BridgeProfile(), OPEN, Places(is_full_without_token=True)), Admission)
    assert isinstance(admit(asked, BridgeProfile(), OPEN, Places(is_full=True)), Refusal)


def test_places_are_counted_by_who_has_shown_a_token() -> None:
    clients = [ClientSession(number, "peer", 1000, lambda: None) for number in range(5)]
    for stranger in clients[:3]:
        stranger.has_token = False
    limits = BridgeLimits(clients=3, tokenless_clients=3)
    assert places(clients, limits) == Places(is_full=False, is_full_without_token=True)
    clients[0].has_token = True
    assert places(clients, limits) == Places(is_full=True, is_full_without_token=False)


def test_request_is_read_from_headers_of_any_library() -> None:
    headers = {"Host": ["a", "b"], "Origin": ["c"], "Authorization": ["d"], DRIVE_HEADER: ["e"], "Upgrade": ["f"]}
    request = handshake_request("/ros2", headers.__getitem__)
    assert request == HandshakeRequest("/ros2", ["a", "b"], ["c"], ["d"], ["e"], ["f"])


REQUEST = HandshakeRequest("/ros1?token=" + "c" * 16, ["localhost:9090"], [], [])


@pytest.mark.parametrize(
    ("given", "is_full", "status"),
    [
        ({"hosts": []}, False, 403),
        ({"hosts": ["localhost", "localhost"]}, False, 403),
        ({"hosts": ["evil.example"]}, False, 403),
        ({"origins": ["http://evil.example"]}, False, 403),
        ({"authorizations": ["Bearer wrong"]}, False, 401),
        ({"path": "/?token=%ff"}, False, 401),
        ({"path": "/?token=\udcff"}, False, 401),
        ({}, True, 503),
        ({"hosts": ["evil.example"]}, True, 403),
    ],
)
def test_first_requests_that_are_refused(given: dict[str, Any], is_full: bool, status: int) -> None:
    decision = admit(REQUEST._replace(**given), BridgeProfile(), ACCESS, Places(is_full))
    assert isinstance(decision, Refusal)
    assert decision.status == status
    assert decision.body == f"{decision.reason}\n"


@pytest.mark.parametrize(
    ("given", "admission"),
    [
        ({}, Admission(Role.CONTROL, "ros1", True)),
        ({"path": "/", "authorizations": ["Bearer " + "v" * 16, "Bearer wrong"]}, Admission(Role.VIEW, "ros2", True)),
        ({"path": "/", "origins": ["http://localhost:3000"]}, Admission(Role.NONE, "ros2")),
    ],
)
def test_first_requests_that_come_in(given: dict[str, Any], admission: Admission) -> None:
    assert admit(REQUEST._replace(**given), BridgeProfile(), ACCESS, Places()) == admission


@pytest.mark.parametrize(
    ("profile", "complaint"),
    [
        ({"host": "0.0.0.0"}, "set tokens and certificate"),
        ({"host": "::", "tokens": "t"}, "set certificate"),
        ({"host": "car.example", "certificate": "c", "certificate_key": "k"}, "set tokens"),
        ({"certificate": "c"}, "belong together"),
    ],
)
def test_server_that_others_can_reach_needs_token_and_tls(profile: dict[str, Any], complaint: str) -> None:
    with pytest.raises(ProfileError, match=complaint):
        check_exposure(BridgeProfile(**profile))


@pytest.mark.parametrize(
    "profile",
    [
        {},
        {"host": "localhost"},
        {"host": "::1"},
        {"host": "127.8.8.8"},
        {"host": "0.0.0.0", "trust_network": True},
        {"host": "0.0.0.0", "tokens": "t", "certificate": "c", "certificate_key": "k"},
    ],
)
def test_exposure_that_is_fine(profile: dict[str, Any]) -> None:
    check_exposure(BridgeProfile(**profile))


NONCE, OTHER = "a" * 32, "b" * 32


@pytest.mark.parametrize(
    ("shown", "drive", "enters"),
    [
        ([], NONCE, True),  # a client from outside
        ([], None, True),
        ([NONCE], NONCE, True),
        ([OTHER], NONCE, False),
        ([NONCE], None, False),
        ([""], None, False),
        ([""], NONCE, False),
        ([NONCE, OTHER], NONCE, False),
        (["\udc80"], NONCE, False),
    ],
)
def test_a_program_of_another_drive_is_refused(shown: list[str], drive: str | None, enters: bool) -> None:
    found = admit(REQUEST._replace(drives=shown), BridgeProfile(), ACCESS, Places(), drive)
    if enters:
        assert isinstance(found, Admission)
    else:
        assert isinstance(found, Refusal)
        assert found.status == 403
        assert "another drive" in found.reason


def test_the_nonce_grants_nothing() -> None:
    request = REQUEST._replace(path="/", drives=[NONCE])
    found = admit(request, BridgeProfile(), ACCESS, Places(), NONCE)
    assert isinstance(found, Admission)
    assert found.role is ACCESS.anonymous


@pytest.mark.parametrize("upgrades", [[], ["h2c"]])
def test_plain_http_is_answered_plainly(upgrades: list[str]) -> None:
    asked = HandshakeRequest("/", ["localhost"], [], [], upgrades=upgrades)
    answer = admit(asked, BridgeProfile(), ACCESS, Places())
    assert isinstance(answer, Refusal)
    assert answer.status == 426
    assert "rosbridge" in answer.body
    assert answer.headers["Upgrade"] == "websocket"


def test_version_is_told_in_plain_http() -> None:
    asked = HandshakeRequest("/version?x=1", ["localhost"], [], [], upgrades=[])
    answer = admit(asked, BridgeProfile(), ACCESS, Places())
    assert isinstance(answer, Refusal)
    assert (answer.status, answer.content_type) == (200, "application/json")
    assert json.loads(answer.body) == {"name": "simconsole", "version": __version__, "protocol": "rosbridge v2.0"}


def test_plain_http_under_another_name_is_not_answered() -> None:
    asked = HandshakeRequest("/version", ["evil.example"], [], [], upgrades=[])
    assert admit(asked, BridgeProfile(), ACCESS, Places()).status == 403  # type: ignore[union-attr]
