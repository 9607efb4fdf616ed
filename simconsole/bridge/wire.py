"""What servers and client share: whole texts out of WebSocket frames, listening, and lines in the log."""

import logging
import socket
from typing import Final

from websockets.frames import Frame, Opcode

from simconsole.bridge.protocol import Outcome
from simconsole.bridge.session import Session
from simconsole.errors import BridgeError, RemoteProtocolError

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


def address_url(host: str, port: int) -> str:
    """Return the ws:// address of a server."""
    return f"ws://[{host}]:{port}" if ":" in host else f"ws://{host}:{port}"


def log_outcome(logger: logging.Logger, session: Session, outcome: Outcome) -> None:
    """Log what was refused, the first of a client each and later ones now and then: a flood must not fill the disk."""
    if outcome.kind == "refused":
        if session.refused <= _LOGGED_REFUSALS or session.refused % _LOGGED_EVERY == 0:
            logger.warning("%s: refused (%d): %s %s", session.peer, session.refused, outcome.topic, outcome.text)
    elif outcome.kind == "remark":
        logger.info("%s: says %s", session.peer, outcome.text)
