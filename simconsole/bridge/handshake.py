"""Who may open a connection: the Origin of web pages and the Host a server is addressed by (N15, N16)."""

import ipaddress
import re
from collections.abc import Sequence
from typing import Final
from urllib.parse import parse_qs, urlsplit

from simconsole.bridge.access import Access, Role
from simconsole.bridge.forms import Dialect
from simconsole.errors import ProfileError
from simconsole.profiles.bridge import BridgeProfile

_LOCAL: Final = ("localhost", "127.0.0.1", "[::1]")
_LOCAL_PAGE: Final = re.compile(r"https?://(?:localhost|127\.0\.0\.1|\[::1\])(?::\d{1,5})?")
_PORT: Final = re.compile(r":\d{1,5}$")

FORBIDDEN: Final = "this server does not answer to that Host"
UNKNOWN: Final = "this server does not know that token"
FULL: Final = "too many clients"


def origins(profile: BridgeProfile) -> Sequence[re.Pattern[str] | str | None]:
    """Return what the Origin header may be: nothing (a program), a page of this machine, one the profile names."""
    return (None, _LOCAL_PAGE, *profile.allowed_origins)


def is_host_allowed(host: str | None, profile: BridgeProfile) -> bool:
    """Return whether a Host header names this server; a page elsewhere can make a browser send any other name here."""
    if host is None:
        return False
    name = _PORT.sub("", host).lower()
    bind = f"[{profile.host}]" if ":" in profile.host else profile.host
    return name in {*_LOCAL, bind.lower(), *(allowed.lower() for allowed in profile.allowed_hosts)}


def dialect_of(path: str, profile: BridgeProfile) -> Dialect:
    """Return how times and headers are spelled for a client: as its URL's path, /ros1 or /ros2, says if it does."""
    name = path.partition("?")[0].strip("/")
    if name == "ros1":
        return "ros1"
    return "ros2" if name == "ros2" else profile.dialect


def role_at(path: str, authorization: str | None, access: Access) -> Role:
    """Return the role a client has from its first request on: by header `Authorization: Bearer`, or by ?token=.

    Raises:
        RemoteProtocolError: it gives a token that this server does not know.
    """
    kind, _, token = (authorization or "").partition(" ")
    tokens = parse_qs(urlsplit(path).query).get("token", [])
    if kind.lower() == "bearer":
        tokens = [token.strip(), *tokens]
    return max((access.role_of(token) for token in tokens), default=access.anonymous)


def is_loopback(host: str) -> bool:
    """Return whether a server on `host` can only be reached from this machine."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def check_exposure(profile: BridgeProfile) -> None:
    """Refuse to be reachable from other machines without a token and TLS, unless the network is said to be trusted.

    Raises:
        ProfileError: naming what is missing.
    """
    if (profile.certificate is None) is not (profile.certificate_key is None):
        raise ProfileError("outputs.bridge.certificate: certificate and certificate_key belong together")
    if is_loopback(profile.host) or profile.trust_network:
        return
    lacks = [name for name in ("tokens", "certificate") if getattr(profile, name) is None]
    if lacks:
        raise ProfileError(
            f"outputs.bridge.host: {profile.host} can be reached from other machines: set {' and '.join(lacks)} "
            "(simconsole bridge cert), or trust_network if everyone on it may drive"
        )
