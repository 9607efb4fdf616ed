import re

import pytest

from simconsole.bridge.handshake import dialect_of, is_host_allowed, origins
from simconsole.profiles.bridge import BridgeProfile


def accepted(origin: str | None, profile: BridgeProfile) -> bool:
    """As websockets reads the list."""
    return any(
        allowed == origin or (isinstance(allowed, re.Pattern) and origin is not None and allowed.fullmatch(origin))
        for allowed in origins(profile)
    )


@pytest.mark.parametrize("origin", [None, "http://localhost:8080", "https://127.0.0.1", "http://[::1]:1"])
def test_programs_and_pages_of_this_machine_may_connect(origin: str | None) -> None:
    assert accepted(origin, BridgeProfile())


@pytest.mark.parametrize(
    "origin", ["null", "", "http://evil.example", "http://localhost.evil.example", "file://", "http://localhost:80/x"]
)
def test_other_pages_may_not(origin: str) -> None:
    assert not accepted(origin, BridgeProfile())


def test_page_that_the_profile_names_may() -> None:
    profile = BridgeProfile(allowed_origins=("https://lab.example",))
    assert accepted("https://lab.example", profile)
    assert not accepted("https://lab.example.evil", profile)


@pytest.mark.parametrize(
    "host", ["127.0.0.1:9090", "localhost", "LOCALHOST:1", "[::1]:9090", "10.0.0.5:80", "rig:9090"]
)
def test_own_names_are_answered(host: str) -> None:
    assert is_host_allowed(host, BridgeProfile(host="10.0.0.5", allowed_hosts=("rig",)))


@pytest.mark.parametrize(
    "host", [None, "", "evil.example", "evil.example:9090", "127.0.0.1.evil.example", "localhost:x"]
)
def test_other_names_are_not(host: str | None) -> None:
    assert not is_host_allowed(host, BridgeProfile())


def test_address_of_version_6_is_written_in_brackets() -> None:
    assert is_host_allowed("[fe80::1]:9090", BridgeProfile(host="fe80::1"))


@pytest.mark.parametrize(
    ("path", "dialect"), [("/", "ros2"), ("/ros1", "ros1"), ("/ros1/?x=1", "ros1"), ("/ros12", "ros2"), ("", "ros2")]
)
def test_dialect_of_a_path(path: str, dialect: str) -> None:
    assert dialect_of(path) == dialect
