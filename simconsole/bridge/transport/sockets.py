"""What the servers share of sockets: listening, addresses, TLS options, time limits, TCP state."""

import os
import platform
import socket
import ssl
import struct
from typing import Any, Final

from simconsole.values.errors import BridgeError

RECEIVE_BYTES: Final = 65_536
HANDSHAKE_S: Final = 5.0
"""How long a client may take until its connection is a WebSocket (N12)."""
CLOSE_S: Final = 1.0
"""How long a client may take to answer a close frame."""
PATIENCE_MS: Final = 2000
"""Who is pinged once a second is gone only if it has not acknowledged the ping before the last one either: the last may
be under way, or lost once."""
_BACKLOG: Final = 64
_UNACKNOWLEDGED_AT: Final = 24
_LAST_ACKNOWLEDGED_AT: Final = 56
"""Offsets of tcpi_unacked and tcpi_last_ack_recv (ms) in Linux' struct tcp_info."""


def is_unacknowledged(sock: socket.socket, patience_ms: int = PATIENCE_MS) -> bool:
    """Return whether something was sent and the other machine has acknowledged nothing for `patience_ms`.

    That tells a machine that is gone from a program that is slow, whose system still acknowledges (within 200 ms).
    Where the system does not say (Linux does), nobody who is silent is trusted.
    """
    option = getattr(socket, "TCP_INFO", None) if platform.system() == "Linux" else None
    if option is None:
        return True
    try:
        state = sock.getsockopt(socket.IPPROTO_TCP, option, _LAST_ACKNOWLEDGED_AT + 4)
    except OSError:
        return True
    (count,) = struct.unpack_from("=I", state, _UNACKNOWLEDGED_AT)
    (since_ms,) = struct.unpack_from("=I", state, _LAST_ACKNOWLEDGED_AT)
    return bool(count) and since_ms >= patience_ms


def bind(host: str, port: int) -> socket.socket:
    """Return a socket that has an address and does not listen yet: nobody can connect; port 0 lets the system choose.

    Raises:
        BridgeError: the address cannot be had.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    sock = socket.socket(family)
    try:
        if os.name == "posix":  # as `socket.create_server`: elsewhere it would let two programs have one port
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if family == socket.AF_INET6:
            sock.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)
        sock.bind((host, port))
    except OSError as error:
        sock.close()
        raise BridgeError(f"outputs.bridge: cannot listen on {host} port {port}: {error}") from None
    return sock


def listen(host: str, port: int) -> socket.socket:
    """Return a non-blocking listening socket; port 0 lets the system choose.

    Raises:
        BridgeError: the address cannot be listened on.
    """
    listener = bind(host, port)
    try:
        listener.listen(_BACKLOG)
    except OSError as error:
        listener.close()
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
