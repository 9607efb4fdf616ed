"""Tokens and certificates from their files: whose token it is, and one line about what cannot be used."""

from pathlib import Path

import pytest

from simconsole.bridge.protocol.access import OPEN, Role
from simconsole.bridge.transport.credentials import control_token, load_access, load_tls
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import ProfileError

VIEW, CONTROL = "v" * 20, "c" * 20


def profile(path: Path, text: str | bytes) -> BridgeProfile:
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return BridgeProfile(tokens=str(path))


def test_without_a_file_everybody_on_this_machine_may_do_everything() -> None:
    assert load_access(BridgeProfile()) is OPEN
    assert control_token(BridgeProfile()) is None
    assert load_tls(BridgeProfile()) is None


def test_a_token_has_its_role_and_the_console_takes_one_that_controls(tmp_path: Path) -> None:
    found = profile(tmp_path / "tokens", f"# ours\nview {VIEW}\ncontrol {CONTROL}  # rig\n")
    access = load_access(found)
    assert (access.role_of(VIEW), access.role_of(CONTROL)) == (Role.VIEW, Role.CONTROL)
    assert control_token(found) == CONTROL


def test_tokens_without_control_cannot_serve_the_consoles_own_program(tmp_path: Path) -> None:
    found = profile(tmp_path / "tokens", f"view {VIEW}\n")
    with pytest.raises(ProfileError, match=r"outputs\.bridge\.tokens: .*tokens: no token of role control"):
        control_token(found)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"\xff\xfe", "tokens: 'utf-8' codec"),
        (b"", "no token in it"),
        (b"driver abcdefghijklmnopqrst", "line 1: expected a role"),
        (b"view short", "line 1: a token has at least"),
        (f"view {VIEW}\ncontrol {VIEW}".encode(), "line 2: .* stands once"),
    ],
)
def test_file_that_cannot_be_used_is_named_and_its_tokens_are_not(tmp_path: Path, content: bytes, message: str) -> None:
    with pytest.raises(ProfileError, match=message) as caught:
        load_access(profile(tmp_path / "tokens", content))
    assert str(tmp_path / "tokens") in str(caught.value)
    assert VIEW not in str(caught.value)


def test_missing_files_are_named() -> None:
    with pytest.raises(ProfileError, match=r"outputs\.bridge\.tokens: /nowhere/tokens: .*No such file"):
        load_access(BridgeProfile(tokens="/nowhere/tokens"))
    with pytest.raises(ProfileError, match=r"outputs\.bridge\.certificate: /nowhere/b.pem: .*No such file"):
        load_tls(BridgeProfile(certificate="/nowhere/b.pem", certificate_key="/nowhere/b.key"))
