"""What servers and client share: whole texts out of WebSocket frames, listening, and lines in the log."""

import logging
import socket
import ssl
from pathlib import Path
from typing import Final

from websockets.frames import Frame, Opcode

from simconsole.bridge.access import OPEN, Access, Role, read_tokens
from simconsole.bridge.handshake import check_exposure
from simconsole.bridge.protocol import Outcome
from simconsole.bridge.session import Session
from simconsole.errors import BridgeError, ProfileError, RemoteProtocolError
from simconsole.profiles.bridge import BridgeProfile

RECEIVE_BYTES: Final = 65_536
_BACKLOG: Final = 64
_LOGGED_REFUSALS: Final = 10
_LOGGED_EVERY: Final = 1000


class TextAssembler:
    """Joins the fragments of text messages. The protocol object has checked their order and total size."""

    def __init__(self, max_fragments: int) -> None:
        """Allow messages of at most `max_fragments` frames."""
        self._max_fragments = max_fragments
        self._parts: list[bytes] = []
        self._binary = False

    def add(self, frame: Frame) -> bytes | None:
        """Take one data frame; return the message when it is complete.

        Raises:
            RemoteProtocolError: a binary message, or more fragments than allowed (N13).
        """
        if frame.opcode is Opcode.CONT:
            self._parts.append(bytes(frame.data))
        elif frame.fin and frame.opcode is Opcode.TEXT:
            return bytes(frame.data)
        else:
            self._binary = frame.opcode is Opcode.BINARY
            self._parts = [bytes(frame.data)]
        if not frame.fin:
            if len(self._parts) >= self._max_fragments:
                raise RemoteProtocolError(f"message is in more than {self._max_fragments} fragments")
            return None
        parts, self._parts = self._parts, []
        if self._binary:
            self._binary = False
            raise RemoteProtocolError("binary messages are not supported here")
        return b"".join(parts)


def is_data(frame: Frame) -> bool:
    """Return whether a frame carries part of a message, and is not ping, pong or close."""
    return frame.opcode is Opcode.TEXT or frame.opcode is Opcode.CONT or frame.opcode is Opcode.BINARY


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


def load_access(profile: BridgeProfile) -> Access:
    """Return who may do what on a server of `profile`.

    Raises:
        ProfileError: the file of tokens cannot be used, or the server would be open to other machines.
    """
    check_exposure(profile)
    if profile.tokens is None:
        return OPEN
    try:
        text = Path(profile.tokens).read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ProfileError(f"outputs.bridge.tokens: {profile.tokens}: {error}") from None
    return Access(read_tokens(text, profile.tokens), Role[profile.anonymous.upper()])


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


def log_outcome(logger: logging.Logger, session: Session, outcome: Outcome) -> None:
    """Log what was refused, the first of a client each and later ones now and then: a flood must not fill the disk."""
    if outcome.kind == "refused":
        if session.refused <= _LOGGED_REFUSALS or session.refused % _LOGGED_EVERY == 0:
            logger.warning("%s: refused (%d): %s %s", session.peer, session.refused, outcome.topic, outcome.text)
    elif outcome.kind == "remark":
        logger.info("%s: says %s", session.peer, outcome.text)
