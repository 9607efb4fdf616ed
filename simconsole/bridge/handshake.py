"""Who may open a connection: the Origin of web pages and the Host a server is addressed by (N15, N16)."""

import re
from collections.abc import Sequence
from typing import Final

from simconsole.bridge.forms import Dialect
from simconsole.profiles.bridge import BridgeProfile

_LOCAL: Final = ("localhost", "127.0.0.1", "[::1]")
_LOCAL_PAGE: Final = re.compile(r"https?://(?:localhost|127\.0\.0\.1|\[::1\])(?::\d{1,5})?")
_PORT: Final = re.compile(r":\d{1,5}$")

FORBIDDEN: Final = "this server does not answer to that Host"
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


def dialect_of(path: str) -> Dialect:
    """Return how times and headers are spelled for a client: by ROS 1 if the path of its URL is /ros1."""
    return "ros1" if path.partition("?")[0].rstrip("/") == "/ros1" else "ros2"
