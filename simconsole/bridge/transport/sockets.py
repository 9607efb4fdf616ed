"""What the servers share: listening sockets, tokens and certificates from files, TCP state, the log of refusals."""

import logging
import socket
import ssl
import struct
from pathlib import Path
from typing import Any, Final

from simconsole.bridge.protocol.access import OPEN, Access, Role, read_tokens
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.handshake import check_exposure
from simconsole.bridge.protocol.server_protocol import Outcome
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import BridgeError, ProfileError

RECEIVE_BYTES: Final = 65_536
HANDSHAKE_S: Final = 5.0
"""How long a client may take until its connection is a WebSocket (N12)."""
CLOSE_S: Final = 1.0
"""How long a client may take to answer a close frame."""
_BACKLOG: Final = 64
_UNACKNOWLEDGED_AT: Final = 24
_LAST_ACKNOWLEDGED_AT: Final = 56
"""Offsets of tcpi_unacked and tcpi_last_ack_recv (ms) in Linux' struct tcp_info."""
_LOGGED_REFUSALS: Final = 10
_LOGGED_EVERY: Final = 1000

logger: Final = logging.getLogger("simconsole.bridge.transport.server")


def is_unacknowledged(sock: socket.socket, patience_ms: int = 1000) -> bool:
    """Return whether something was sent and the other machine has acknowledged nothing for `patience_ms`.

    That tells a machine that is gone from a program that is slow, whose system still acknowledges (within 200 ms).
    Where the system does not say (Linux does), nobody who is silent is trusted.
    """
    option = getattr(socket, "TCP_INFO", None)
    if option is None:
        return True
    try:
        state = sock.getsockopt(socket.IPPROTO_TCP, option, _LAST_ACKNOWLEDGED_AT + 4)
    except OSError:
        return True
    (count,) = struct.unpack_from("=I", state, _UNACKNOWLEDGED_AT)
    (since_ms,) = struct.unpack_from("=I", state, _LAST_ACKNOWLEDGED_AT)
    return bool(count) and since_ms >= patience_ms


def listen(host: str, port: int) -> socket.socket:
    """Return a non-blocking listening socket; port 0 lets the system choose.

    Raises:
        BridgeError: the address cannot be listened on.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        listener = socket.create_server((host, port), family=family, backlog=_BACKLOG)
    except OSError as error:
        raise BridgeError(f"outputs.bridge: cannot listen on {host} port {port}: {error}") from None
    listener.setblocking(False)
    return listener


def address_url(host: str, port: int, secure: bool = False) -> str:
    """Return the ws:// or wss:// address of a server."""
    scheme = "wss" if secure else "ws"
    return f"{scheme}://[{host}]:{port}" if ":" in host else f"{scheme}://{host}:{port}"


def tls_options(tls: ssl.SSLContext | None) -> dict[str, Any]:
    """Return what asyncio's servers take for TLS: nothing without."""
    return {} if tls is None else {"ssl": tls, "ssl_handshake_timeout": HANDSHAKE_S}


def load_access(profile: BridgeProfile) -> Access:
    """Return the roles by token on a server of `profile`.

    Raises:
        ProfileError: the file of tokens cannot be used, or the server would be open to other machines.
    """
    check_exposure(profile)
    if profile.tokens is None:
        return OPEN
    return Access(_tokens(profile.tokens), Role[profile.anonymous.upper()])


def control_token(profile: BridgeProfile) -> str | None:
    """Return a token that may command, for a program of the console's own; None where no token is asked for.

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


def log_outcome(logger: logging.Logger, session: ClientSession, outcome: Outcome) -> None:
    """Log what was refused, the first of a client each and later ones now and then: a flood must not fill the disk."""
    if outcome.kind == "refused":
        if session.refused <= _LOGGED_REFUSALS or session.refused % _LOGGED_EVERY == 0:
            logger.warning("%s: refused (%d): %s %s", session.peer, session.refused, outcome.topic, outcome.text)
    elif outcome.kind == "remark":
        logger.info("%s: says %s", session.peer, outcome.text)
