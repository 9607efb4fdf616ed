"""Tokens and certificates of a server, from the files that its profile names."""

import ssl
import time
from pathlib import Path

from simconsole.bridge.protocol.access import OPEN, Access, Role, read_tokens
from simconsole.bridge.protocol.handshake import check_exposure
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import ProfileError


def load_access(profile: BridgeProfile) -> Access:
    """Return the roles by token on a server of `profile`.

    Raises:
        ProfileError: the file of tokens cannot be used, or the server would be open to other machines.
    """
    check_exposure(profile)
    if profile.tokens is None:
        return OPEN
    return Access(_tokens(profile.tokens), Role[profile.anonymous.upper()], time.time)


def control_token(profile: BridgeProfile) -> str | None:
    """Return a token of role control, for a program of the console's own; None where no tokens are used.

    Raises:
        ProfileError: the file of tokens cannot be used, or has none of role control.
    """
    if profile.tokens is None:
        return None
    for token, role in _tokens(profile.tokens).items():
        if role is Role.CONTROL:
            return token
    raise ProfileError(
        f"outputs.bridge.tokens: {profile.tokens}: no token of role control, as features.autopilot needs"
    )


def _tokens(name: str) -> dict[str, Role]:
    try:
        text = Path(name).read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ProfileError(f"outputs.bridge.tokens: {name}: {error}") from None
    return read_tokens(text, name)


def load_tls(profile: BridgeProfile) -> ssl.SSLContext | None:
    """Return what a server of `profile` encrypts with, None without a certificate.

    Raises:
        ProfileError: the certificate or its key cannot be used.
    """
    if profile.certificate is None or profile.certificate_key is None:
        return None
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    try:
        context.load_cert_chain(profile.certificate, profile.certificate_key)
    except (OSError, ssl.SSLError) as error:
        raise ProfileError(f"outputs.bridge.certificate: {profile.certificate}: {error}") from None
    return context
