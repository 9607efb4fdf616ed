"""Admission of clients: Origin of web pages, Host header (N15, N16), the drive's nonce, tokens, number of clients.

Every transport decides by `admit`, so that they cannot differ.
"""

import hmac
import ipaddress
import re
from collections.abc import Callable, Iterable, Sequence
from http import HTTPStatus
from typing import Final, NamedTuple
from urllib.parse import parse_qs, urlsplit

import orjson

from simconsole.bridge.protocol.access import Access, Role
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.message_encoding import Dialect
from simconsole.profiles.bridge import BridgeLimits, BridgeProfile
from simconsole.values.errors import ProfileError, RemoteProtocolError
from simconsole.values.version import __version__

_LOCAL: Final = ("localhost", "127.0.0.1", "[::1]")
_LOCAL_PAGE: Final = re.compile(r"https?://(?:localhost|127\.0\.0\.1|\[::1\])(?::\d{1,5})?")
_PORT: Final = re.compile(r":\d{1,5}$")

WEBSOCKET_VERSION: Final = "13"
VERSION_PATH: Final = "/version"
"""Answered to plain HTTP: what serves here, in JSON."""
DRIVE_HEADER: Final = "X-Simconsole-Drive"
"""Header with the drive's nonce, sent only by programs that the drive has started."""


class HandshakeRequest(NamedTuple):
    """A client's first request: its target, and every value it gives for the headers that matter."""

    path: str
    hosts: Sequence[str]
    origins: Sequence[str]
    authorizations: Sequence[str]
    drives: Sequence[str] = ()
    upgrades: Sequence[str] = ("websocket",)


class Admission(NamedTuple):
    """An admitted client: its role, and how times and headers are spelled for it."""

    role: Role
    dialect: Dialect
    has_token: bool = False


class Places(NamedTuple):
    """Whether a server has room for one client more: one that shows a token, or needs none, and one that does not."""

    is_full: bool = False
    is_full_without_token: bool = False


def places(clients: Iterable[ClientSession], limits: BridgeLimits) -> Places:
    """Return what room a server has beside its clients."""
    have = [client.has_token for client in clients]
    tokens = sum(have)
    return Places(tokens >= limits.clients, len(have) - tokens >= limits.tokenless_clients)


class Refusal(NamedTuple):
    """The HTTP answer to a client that is not admitted."""

    status: HTTPStatus
    reason: str
    content_type: str = "text/plain; charset=utf-8"

    @property
    def body(self) -> str:
        """The text that the client gets."""
        return f"{self.reason}\n"

    @property
    def headers(self) -> dict[str, str]:
        """The headers that the client gets beside those of every answer."""
        protocol = {"Upgrade": "websocket", "Sec-WebSocket-Version": WEBSOCKET_VERSION}
        upgrade = protocol if self.status == HTTPStatus.UPGRADE_REQUIRED else {}
        return {"Content-Type": self.content_type, **upgrade}


def handshake_request(path: str, values_of: Callable[[str], Sequence[str]]) -> HandshakeRequest:
    """Return what matters of a first request; `values_of` returns every value given for a header."""
    return HandshakeRequest(
        path=path,
        hosts=values_of("Host"),
        origins=values_of("Origin"),
        authorizations=values_of("Authorization"),
        drives=values_of(DRIVE_HEADER),
        upgrades=values_of("Upgrade"),
    )


def admit(
    request: HandshakeRequest, profile: BridgeProfile, access: Access, places: Places, drive: str | None = None
) -> Admission | Refusal:
    """Decide on a first request to the server of a `drive` (its nonce), or of none."""
    if len(request.hosts) != 1 or not is_host_allowed(request.hosts[0], profile):
        return Refusal(HTTPStatus.FORBIDDEN, "this server does not answer to that Host")
    if not is_origin_allowed(request.origins, profile):
        named = ", ".join(origin[:80] for origin in request.origins)
        reason = f"this server does not answer to pages of Origin {named!r}, which allowed_origins does not name"
        return Refusal(HTTPStatus.FORBIDDEN, reason)
    if not is_of_drive(request.drives, drive):
        return Refusal(HTTPStatus.FORBIDDEN, "this server belongs to another drive than the one that started you")
    if not any("websocket" in value.lower() for value in request.upgrades):
        return _plain_answer(request.path)
    tokens = tokens_at(request.path, request.authorizations[0] if request.authorizations else None)
    try:
        role = max(map(access.role_of, tokens), default=access.anonymous)
    except RemoteProtocolError as error:
        return Refusal(HTTPStatus.UNAUTHORIZED, f"no admission: {error}")
    has_token = bool(tokens) or not access.has_tokens
    if places.is_full if has_token else places.is_full_without_token:
        return Refusal(HTTPStatus.SERVICE_UNAVAILABLE, "too many clients" + ("" if has_token else " without a token"))
    return Admission(role, dialect_of(request.path, profile), has_token)


def _plain_answer(path: str) -> Refusal:
    """Return the answer to a browser or another program that asks in plain HTTP."""
    if path.partition("?")[0] == VERSION_PATH:
        versions = {"name": "simconsole", "version": __version__, "protocol": "rosbridge v2.0"}
        return Refusal(HTTPStatus.OK, orjson.dumps(versions).decode(), "application/json")
    return Refusal(
        HTTPStatus.UPGRADE_REQUIRED,
        "this is a rosbridge server: connect a rosbridge client (roslibpy, roslib, Foxglove) by WebSocket",
    )


def is_origin_allowed(origins: Sequence[str], profile: BridgeProfile) -> bool:
    """Return whether the Origin headers are: none (a program), a page of this machine, or one the profile names."""
    if not origins:
        return True
    return len(origins) == 1 and (
        _LOCAL_PAGE.fullmatch(origins[0]) is not None or origins[0] in profile.allowed_origins
    )


def is_of_drive(shown: Sequence[str], drive: str | None) -> bool:
    """Return whether a client belongs to `drive`: it shows that drive's nonce, or none (it comes from outside)."""
    known = (drive or "").encode()
    return all(bool(known) and hmac.compare_digest(one.encode("utf-8", "replace"), known) for one in shown)


def is_host_allowed(host: str, profile: BridgeProfile) -> bool:
    """Return whether a Host header names this server; a page elsewhere can make a browser send any other name here."""
    name = _PORT.sub("", host).lower()
    bind = f"[{profile.host}]" if ":" in profile.host else profile.host
    return name in {*_LOCAL, bind.lower(), *(allowed.lower() for allowed in profile.allowed_hosts)}


def dialect_of(path: str, profile: BridgeProfile) -> Dialect:
    """Return how times and headers are spelled for a client: by its URL's path, /ros1 or /ros2, else the profile's."""
    name = path.partition("?")[0].strip("/")
    if name == "ros1":
        return "ros1"
    return "ros2" if name == "ros2" else profile.dialect


def tokens_at(path: str, authorization: str | None) -> list[str]:
    """Return the tokens that a first request shows: by header `Authorization: Bearer`, or by ?token=."""
    kind, _, token = (authorization or "").partition(" ")
    tokens = parse_qs(urlsplit(path).query).get("token", [])
    if kind.lower() == "bearer":
        tokens = [token.strip(), *tokens]
    return tokens


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
